#include "dynamics/mode_choice/quantity_sizes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "dynamics/mode_choice/forcing_spectrum.h"

namespace sprung::dynamics {

namespace {

using Kind = WatchedQuantity::Kind;

constexpr double kLeastSize = 0.01;  // of the largest quantity of its kind
constexpr double kRounding = 1e-6;   // torque that counts as zero, of force times length

}  // namespace

double calc_factor(const WatchedQuantity& quantity, double omega) {
  return quantity.kind == Kind::kAcceleration ? -omega * omega : 1.0;
}

QuantitySizes calc_sizes(const WatchedQuantities& watched, const RowsXcd& lines,
                         const Eigen::VectorXd& omega) {
  std::vector<std::size_t> all(watched.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  QuantitySizes sizes{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(watched.size())),
                      calc_peaks(watched, lines, omega, all)};
  const Eigen::ArrayXd fourth = omega.array().square().square();
  for (std::size_t i = 0; i < watched.size(); ++i) {
    double squares = 0.0;
    for (const int row : watched.list[i].rows) {
      const Eigen::ArrayXd one = lines.row(row).transpose().cwiseAbs2();
      squares += watched.list[i].kind == Kind::kAcceleration ? (one * fourth).sum() : one.sum();
    }
    sizes.rms[static_cast<Eigen::Index>(i)] = std::sqrt(2.0 * squares);
  }
  return sizes;
}

Eigen::VectorXd calc_peaks(const WatchedQuantities& watched, const RowsXcd& lines,
                           const Eigen::VectorXd& omega, const std::vector<std::size_t>& quantities) {
  const auto num_times =
      static_cast<Eigen::Index>(std::bit_ceil(static_cast<std::size_t>(2 * lines.cols() + 1)));
  const auto count = static_cast<Eigen::Index>(quantities.size());
  // One transform gives the histories of two rows.
  std::vector<std::pair<Eigen::Index, int>> rows;  // index into `quantities`, row
  for (Eigen::Index i = 0; i < count; ++i) {
    for (const int row : watched.list[quantities[static_cast<std::size_t>(i)]].rows)
      rows.emplace_back(i, row);
  }
  const auto series = [&](std::size_t place) {
    Eigen::RowVectorXcd values = Eigen::RowVectorXcd::Zero(lines.cols());
    if (place >= rows.size()) return values;
    values = lines.row(rows[place].second);
    if (watched.list[quantities[static_cast<std::size_t>(rows[place].first)]].kind == Kind::kAcceleration) {
      values.array() *= -omega.transpose().array().square();
    }
    return values;
  };
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(num_times, count);
  for (std::size_t place = 0; place < rows.size(); place += 2) {
    const Eigen::VectorXcd histories = calc_histories(series(place), series(place + 1), num_times);
    squares.col(rows[place].first) += histories.real().cwiseAbs2();
    if (place + 1 < rows.size()) squares.col(rows[place + 1].first) += histories.imag().cwiseAbs2();
  }
  Eigen::VectorXd peaks(count);
  for (Eigen::Index i = 0; i < count; ++i) peaks[i] = std::sqrt(squares.col(i).maxCoeff());
  return peaks;
}

double calc_static_size(const WatchedQuantity& quantity, const Eigen::VectorXcd& outputs) {
  if (quantity.kind == Kind::kAcceleration) return 0.0;
  double sum = 0.0;
  for (const int row : quantity.rows) sum += std::norm(outputs[row]);
  return std::sqrt(sum);
}

Eigen::VectorXd apply_lower_bounds(const WatchedQuantities& watched, Eigen::VectorXd sizes, double length) {
  std::array<double, WatchedQuantity::kNumKinds> largest{};
  for (std::size_t i = 0; i < watched.size(); ++i) {
    double& one = largest[static_cast<std::size_t>(watched.list[i].kind)];
    one = std::max(one, sizes[static_cast<Eigen::Index>(i)]);
  }
  double& torque = largest[static_cast<std::size_t>(Kind::kTorque)];
  torque =
      std::max(torque, kRounding / kLeastSize * length * largest[static_cast<std::size_t>(Kind::kForce)]);
  for (std::size_t i = 0; i < watched.size(); ++i) {
    double& size = sizes[static_cast<Eigen::Index>(i)];
    size = std::max(size, kLeastSize * largest[static_cast<std::size_t>(watched.list[i].kind)]);
  }
  return sizes;
}

Eigen::VectorXd calc_shares(const Eigen::VectorXd& change, const Eigen::VectorXd& size) {
  return change.binaryExpr(size, [](double a, double b) { return b > 0.0 ? a / b : 0.0; });
}

}  // namespace sprung::dynamics
