#include "reduce/certificate/band_errors.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace sprung::reduce {

namespace {

constexpr double kSharpness = 1.02;  // bound over the largest value found
constexpr int kFirstParts = 8;
constexpr double kSmallestPart = 1e-5;  // of the band

class BandSearch {
 public:
  BandSearch(const InterfaceResidual& residual, double highest, double cutoff, double negligible)
      : residual_(residual), highest_(highest), cutoff_(cutoff) {
    const Eigen::Index b = residual.num_loads();
    errors_.error = Eigen::VectorXd::Zero(b);
    errors_.worst_omega_squared = Eigen::VectorXd::Zero(b);
    errors_.worst_part.resize(static_cast<std::size_t>(b));
    found_ = negligible * residual.static_flexibility();
  }

  BandErrors run() {
    for (int i = 0; i <= kFirstParts; ++i) sample(highest_ * i / kFirstParts);
    for (int i = 0; i < kFirstParts; ++i) {
      search({highest_ * i / kFirstParts, highest_ * (i + 1) / kFirstParts});
    }
    return errors_;
  }

 private:
  // A value that the bound takes at a frequency.
  void sample(double s) {
    const Eigen::VectorXd errors =
        residual_.calc_errors(s, residual_.calc_amplitudes(s)) / (1.0 - s / cutoff_);
    found_ = found_.cwiseMax(errors);
  }

  void search(const BandPart& part) {
    const double middle = 0.5 * (part.begin + part.end);
    const Eigen::MatrixXd y = residual_.calc_amplitudes(middle);
    const Eigen::VectorXd first = residual_.calc_errors(part.begin, y),
                          last = residual_.calc_errors(part.end, y);
    const Eigen::VectorXd bound = first.cwiseMax(last) / (1.0 - part.end / cutoff_);
    const bool sharp = (bound.array() <= kSharpness * found_.array()).all();
    if (!sharp && part.end - part.begin > kSmallestPart * highest_) {
      sample(middle);
      search({part.begin, middle});
      search({middle, part.end});
      return;
    }
    errors_.parts.push_back(part);
    for (Eigen::Index j = 0; j < bound.size(); ++j) {
      if (bound(j) <= errors_.error(j)) continue;
      errors_.error(j) = bound(j);
      errors_.worst_part[static_cast<std::size_t>(j)] = part;
      errors_.worst_omega_squared(j) = last(j) >= first(j) ? part.end : part.begin;
    }
  }

  const InterfaceResidual& residual_;
  double highest_, cutoff_;
  Eigen::VectorXd found_;
  BandErrors errors_;
};

}  // namespace

BandErrors calc_band_errors(const InterfaceResidual& residual, double highest, double cutoff,
                            double negligible) {
  if (!(cutoff > highest)) {
    throw std::invalid_argument(fmt::format(
        "calc_band_errors: cutoff is {} rad²/s², expected more than the band's end {}", cutoff, highest));
  }
  return BandSearch(residual, highest, cutoff, negligible).run();
}

}  // namespace sprung::reduce
