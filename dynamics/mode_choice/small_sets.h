#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "dynamics/mode_choice/harmonic_inputs.h"
#include "dynamics/mode_choice/quantity_sizes.h"
#include "dynamics/mode_choice/thinned_lines.h"

namespace sprung::dynamics {

/// The effect of holding small sets of modes, for many sets at once. Responses are computed at thinned lines
/// only, whose distance is about the half-width of a resonance. For peaks, the transfer functions are
/// interpolated linearly between them. The error is a few hundredths of each change.
/// Checked by tests/dynamics/mode_choice/basis_choice_test.cpp
class SmallSets {
 public:
  struct Scene {
    const LinearVehicle& vehicle;
    const WatchedQuantities& watched;
    const HarmonicInputs& inputs;
    const Eigen::MatrixXcd& amplitudes;  ///< of the inputs, i×m
    const Eigen::VectorXd& omega;        ///< m
  };
  /// @param scene        its members must outlive this
  /// @param coordinates  the n modal coordinates, as positions in q
  SmallSets(const Scene& scene, const std::vector<int>& coordinates);

  /// Sizes of the changes when the modes of a set are held.
  /// @param sets        of positions among the n modes
  /// @param find_shown  given the r.m.s. changes of all quantities, selects those whose peaks are computed
  /// @return one for each set; peaks of other quantities are 0
  using FindShown = std::function<std::vector<std::size_t>(const Eigen::VectorXd& rms)>;
  std::vector<QuantitySizes> measure(const std::vector<std::vector<int>>& sets,
                                     const FindShown& find_shown) const;

 private:
  struct Node {
    RowsXcd states;                     // under unit modal forces, then unit inputs: s×(n+i)
    Eigen::MatrixXcd outputs_by_force;  // p×n
    Eigen::MatrixXcd amplitudes;        // of the modes under unit inputs, n×i
  };
  void calc_node(Eigen::Index line, Node& node) const;
  // Change of the outputs under each unit input, p×i.
  Eigen::MatrixXcd calc_change(const Node& node, const std::vector<int>& set) const;
  QuantitySizes calc_sizes(const std::vector<Eigen::MatrixXcd>& changes, const FindShown& find_shown) const;

  Scene scene_;
  Eigen::Index p_, n_;
  Eigen::MatrixXd direct_;  // p×n, direct effect of modal forces on the outputs
  ThinnedLines thinned_;
  HarmonicSweep sweep_;  // outputs: the watched ones, then the modal coordinates
  RowsXcd projected_;    // unit modal forces
};

}  // namespace sprung::dynamics
