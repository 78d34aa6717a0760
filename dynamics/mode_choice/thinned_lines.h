#pragma once

#include <Eigen/Core>
#include <vector>

namespace sprung::dynamics {

/// Some of m lines of a spectrum that stand for those around them: each of the lowest, then ever fewer, at
/// distances in proportion to their frequency. What changes little between them is summed over all lines with
/// the power that the inputs have in each one's surroundings.
struct ThinnedLines {
  std::vector<Eigen::Index> lines;       ///< ascending, first 0, last m − 1
  std::vector<Eigen::Index> ends;        ///< behind each one's surroundings
  std::vector<Eigen::MatrixXcd> powers;  ///< Σ a aᴴ there of the inputs' amplitudes, i×i

  std::size_t size() const { return lines.size(); }
};

/// @param amplitudes  of i inputs, i×m, m > 0  @param spacing  of frequency, > 0
ThinnedLines thin_lines(const Eigen::MatrixXcd& amplitudes, double spacing);

/// Σ |y|² of outputs y = G a over the surroundings of a line.  @param gains  p×i  @param power  i×i  @return
/// p
Eigen::VectorXd calc_powers(const Eigen::MatrixXcd& gains, const Eigen::MatrixXcd& power);

}  // namespace sprung::dynamics
