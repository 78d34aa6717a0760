#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "dynamics/mode_choice/harmonic_inputs.h"
#include "dynamics/mode_choice/quantity_sizes.h"
#include "dynamics/mode_choice/thinned_lines.h"

namespace sprung::dynamics {

/// What holding small sets of modes still changes, many such sets at once. Outputs by modal forces and
/// receptance are looked at in thinned lines only, about as far apart as the half-width of a resonance; in
/// between the outputs by the inputs are taken as straight lines for histories. Good to a few hundredths of
/// each change.
class LoneModes {
 public:
  struct Scene {
    const LinearVehicle& vehicle;
    const WatchedQuantities& watched;
    const HarmonicInputs& inputs;
    const Eigen::MatrixXcd& amplitudes;  ///< of the inputs, i×m
    const Eigen::VectorXd& omega;        ///< m
  };
  /// @param coordinates  the n modal coordinates  @param scene  what it names has to outlive this
  LoneModes(const Scene& scene, const std::vector<int>& coordinates);

  /// @param sets  of positions among the modes
  /// @param find_shown  the quantities whose largest values are wanted, by the r.m.s. of the changes of all
  /// @return for each set; peaks of other quantities are 0
  using FindShown = std::function<std::vector<std::size_t>(const Eigen::VectorXd& rms)>;
  std::vector<QuantitySizes> measure(const std::vector<std::vector<int>>& sets,
                                     const FindShown& find_shown) const;

 private:
  struct Node {
    RowsXcd states;                     // under modal forces, then inputs: s×(n+i)
    Eigen::MatrixXcd outputs_by_force;  // p×n
    Eigen::MatrixXcd amplitudes;        // n×i
  };
  void calc_node(Eigen::Index line, Node& node) const;
  // Changes of the outputs by each input, p×i.
  Eigen::MatrixXcd calc_change(const Node& node, const std::vector<int>& set) const;
  QuantitySizes calc_sizes(const std::vector<Eigen::MatrixXcd>& changes, const FindShown& find_shown) const;

  Scene scene_;
  Eigen::Index p_, n_;
  Eigen::MatrixXd direct_;  // p×n, of modal forces on the outputs
  ThinnedLines thinned_;
  HarmonicSweep sweep_;  // outputs: the watched ones, then the modal coordinates
  RowsXcd projected_;    // modal forces
};

}  // namespace sprung::dynamics
