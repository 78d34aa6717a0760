#include "dynamics/mode_choice/thinned_lines.h"

#include <algorithm>

namespace sprung::dynamics {

ThinnedLines thin_lines(const Eigen::MatrixXcd& amplitudes, double spacing) {
  ThinnedLines thinned;
  const Eigen::Index m = amplitudes.cols();
  for (Eigen::Index line = 0; line < m;) {
    thinned.lines.push_back(line);
    if (line == m - 1) break;
    const auto stride = static_cast<Eigen::Index>(spacing * static_cast<double>(line + 1));
    line = std::min(line + std::max<Eigen::Index>(1, stride), m - 1);
  }
  Eigen::Index begin = 0;
  for (std::size_t k = 0; k < thinned.size(); ++k) {
    const Eigen::Index end = k + 1 < thinned.size() ? (thinned.lines[k] + thinned.lines[k + 1]) / 2 + 1 : m;
    const auto some = amplitudes.middleCols(begin, end - begin);
    thinned.ends.push_back(end);
    thinned.powers.emplace_back(some * some.adjoint());
    begin = end;
  }
  return thinned;
}

Eigen::VectorXd calc_powers(const Eigen::MatrixXcd& gains, const Eigen::MatrixXcd& power) {
  Eigen::VectorXd powers = Eigen::VectorXd::Zero(gains.rows());
  for (Eigen::Index i = 0; i < gains.cols(); ++i) {
    powers += power(i, i).real() * gains.col(i).cwiseAbs2();
    for (Eigen::Index k = 0; k < i; ++k) {
      const std::complex<double> cross = 2.0 * power(i, k);
      powers += (cross * gains.col(i).cwiseProduct(gains.col(k).conjugate())).real();
    }
  }
  return powers;
}

}  // namespace sprung::dynamics
