#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dynamics/integration/error_scales.h"
#include "dynamics/integration/ode_system.h"
#include "dynamics/integration/smooth_piece.h"
#include "dynamics/system/partitioned_equations.h"

namespace sprung::dynamics {

/// The partitioned equations in first-order form, with the energy book as quadratures:
/// y = (q_i, v_i, dissipated energy, energy put in), 2f + 2 components (integration/partitioned, eq. 1).
class PartitionedOde final : public OdeSystem {
 public:
  /// @param model has to outlive this
  explicit PartitionedOde(const Model& model);

  /// Takes over a state that satisfies the constraints: chooses the partition and makes y from it.
  /// @param dissipated, input  energy so far [J]
  void set_state(const State& state, double dissipated, double input);
  std::span<const double> y() const { return y_; }

  /// Small motion that `calc_small_motion` gives when it is called first, if the partition is the same.
  void set_small_motion(KnownMotion known) { known_ = std::move(known); }
  /// Likewise, in any independent coordinates: it is transformed to those of the partition, at the motion
  /// evaluated last. One that does not fit the model is ignored.
  void continue_small_motion(const KnownMotion& known);

  /// Brings positions and velocities of `equations()` to y.
  /// @throws support::NumericalError if the constraints cannot be satisfied
  void close_joints(double time, std::span<const double> y);
  /// Likewise accelerations and multipliers.
  void calc_accelerations(double time, std::span<const double> y);
  /// The state that y stands for; all terms of `equations()` are evaluated there.
  /// @throws support::NumericalError if the constraints cannot be satisfied
  State make_state(double time, std::span<const double> y);

  PartitionedEquations& equations() { return equations_; }
  const PartitionedEquations& equations() const { return equations_; }
  SmoothPiece& piece() { return piece_; }
  const SmoothPiece& piece() const { return piece_; }
  double dissipated(std::span<const double> y) const { return y[y.size() - 2]; }
  double input(std::span<const double> y) const { return y[y.size() - 1]; }

  /// Whether the equations stand at that time, accelerations included.
  bool has_accelerations(double time) const {
    return equations_.constrained().has_accelerations() &&
           equations_.terms().time() == piece_.evaluation_time(time);
  }

  long num_derivatives() const { return num_derivatives_; }

  int size() const override { return 2 * equations_.num_freedoms() + 2; }
  int num_freedoms() const override { return equations_.num_freedoms(); }
  bool calc_small_motion(double time, std::span<const double> y, SmallMotion& motion) override;
  std::vector<int> elastic_freedoms() const override;
  bool calc_mass_columns(double time, std::span<const double> y, const std::vector<int>& freedoms,
                         Eigen::MatrixXd& columns) override;
  int coordinate_version() const override { return coordinate_version_; }
  bool calc_derivative(double time, std::span<const double> y, std::span<double> y_dot) override;
  int num_switches() const override { return piece_.num_switches(); }
  bool calc_switches(double time, std::span<const double> y, std::span<double> values) override;
  void calc_error_scales(std::span<const double> y, std::span<double> scales) const override;
  void limit_to_accelerations(std::span<const double> y, std::span<double> scales) const override;

 private:
  bool evaluate_motion(double time, std::span<const double> y);
  void hold_states(SmallMotion& motion) const;
  [[noreturn]] void throw_not_finite(double time) const;

  const Model* model_;
  PartitionedEquations equations_;
  SmoothPiece piece_;
  ErrorScales scales_;
  long num_derivatives_ = 0;
  std::vector<double> y_;
  int coordinate_version_ = 0;
  std::optional<KnownMotion> known_;
  std::vector<double> natural_sizes_;  // of the independents
  Eigen::MatrixXd directions_;         // work space
};

}  // namespace sprung::dynamics
