#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "dynamics/integration/partitioned/partitioned_ode.h"
#include "dynamics/integration/system_stepper.h"
#include "dynamics/system/change_point.h"

namespace sprung::dynamics {

/// Steps in independent coordinates, by any Integrator. It chooses other independent coordinates where the
/// dependent ones follow the present ones badly (system, "Equations of motion"), and passes change points, at
/// which all choices are bad, in a step of its own (ChangePointStep).
class PartitionedStepper final : public SystemStepper {
 public:
  PartitionedStepper(const Model& model, const Integrator::Options& options,
                     std::function<void(double time)> on_repartition);

  void set_small_motion(KnownMotion known) override { ode_.set_small_motion(std::move(known)); }
  void continue_small_motion(const KnownMotion& known) override { ode_.continue_small_motion(known); }
  std::optional<KnownMotion> small_motion() const override;
  void start(const State& state) override;
  void resume(double time, double end_time) override;
  Integrator::StepResult step(double longest_step) override;
  double time() const override { return is_running_ ? integrator_->time() : start_time_; }
  double calc_longest_step() const override {
    return ode_.piece().calc_longest_step(equations().terms(), time()) / integrator_->largest_gap();
  }
  void evaluate(double time, Level level) override;
  void evaluate_end_approximately(Level level) override;
  const ConstrainedEquations& equations() const override { return ode_.equations().constrained(); }
  const Eigen::VectorXd* estimate_acceleration_error() override;
  EnergyFlow energy_flow() const override { return {ode_.dissipated(y_), ode_.input(y_)}; }
  SmoothPiece& piece() override { return ode_.piece(); }
  Statistics statistics() const override;

 private:
  double calc_pivot_share();
  void choose_partition();
  bool pass_change_point(double longest_step);
  bool is_inside_passage(double time) const { return has_passed_ && change_point_->contains(time); }
  void evaluate_passage(double time);
  Integrator::StepResult end_passage();

  const Model* model_;
  PartitionedOde ode_;
  std::unique_ptr<Integrator> integrator_;
  std::function<void(double)> on_repartition_;
  std::vector<double> y_;        // evaluated last
  double evaluated_time_ = 0.0;  // likewise
  Eigen::VectorXd independent_error_, acceleration_error_;
  double start_time_ = 0.0, end_time_ = 0.0;
  bool is_running_ = false, is_at_start_ = false;
  double last_rescue_ = -std::numeric_limits<double>::infinity();
  long repartitions_ = 0;

  double last_pivot_ = 1.0, best_pivot_ = 0.0;   // smallest ones of the partitions chosen
  std::optional<double> usual_pivot_;            // found where a pivot is small
  std::optional<ChangePointStep> change_point_;  // made at the first
  bool may_improve_ = false;                     // the partition, chosen beside a change point
  bool has_passed_ = false;                      // the last step was one over a change point
  ChangePointStep::End inside_;
  Eigen::Vector2d flow_before_ = Eigen::Vector2d::Zero();  // dissipated and put in [J]
  double renewal_time_ = std::numeric_limits<double>::infinity();
};

}  // namespace sprung::dynamics
