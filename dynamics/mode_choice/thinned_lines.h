#pragma once

#include <Eigen/Core>
#include <vector>

namespace sprung::dynamics {

/// Selected lines of m lines of a spectrum, each of which represents an interval of lines around it: all of
/// the lowest lines, then lines at distances proportional to their frequency. Smooth transfer functions are
/// summed over all lines by the power of the inputs in each interval. Checked by
/// tests/dynamics/response/harmonic_sweep_test.cpp
struct ThinnedLines {
  std::vector<Eigen::Index> lines;       ///< ascending, first 0, last m − 1
  std::vector<Eigen::Index> ends;        ///< first line after each interval
  std::vector<Eigen::MatrixXcd> powers;  ///< Σ a aᴴ of the inputs' amplitudes over each interval, i×i

  std::size_t size() const { return lines.size(); }
};

/// @param amplitudes  of i inputs, i×m, m > 0
/// @param spacing     distance of the lines, relative to their frequency, > 0
ThinnedLines thin_lines(const Eigen::MatrixXcd& amplitudes, double spacing);

/// Σ |y|² of outputs y = G a over the interval of a line.
/// @param gains  G, p×i
/// @param power  of the interval, i×i
/// @return p
Eigen::VectorXd calc_powers(const Eigen::MatrixXcd& gains, const Eigen::MatrixXcd& power);

}  // namespace sprung::dynamics
