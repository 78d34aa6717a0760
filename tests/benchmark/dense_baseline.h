#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>

#include "dynamics/integration/partitioned/partitioned_ode.h"
#include "tests/dynamics/dense_evaluator.h"

namespace sprung::benchmark {

/// The baseline of the benchmark: the plain dense evaluator under adaptive Dormand–Prince 5(4), with one
/// partition for the whole run and the same error scales. Switches are not located; the step-size control
/// finds kinks and jumps. Source: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential
/// Equations I, 2nd ed., Springer, 1993, §§II.4–6: DOPRI5 with its continuous extension
class DenseBaseline {
 public:
  /// A row of outputs: motion of all coordinates.
  using Output = std::function<void(double time, const Eigen::VectorXd& q, const Eigen::VectorXd& v_dot)>;
  struct Statistics {
    long steps = 0, rejected = 0, evaluations = 0;
  };

  /// @param model  outlives this; joints and forces that DenseEvaluator knows
  DenseBaseline(const dynamics::Model& model, const dynamics::State& start);

  /// @param tolerance     as of dynamics::Integrator
  /// @param largest_step  so that no obstacle is stepped over [s]
  /// @param output        at 0, output_step, … up to end_time; may be empty
  /// @throws support::NumericalError where the step becomes too short
  Statistics run(double end_time, double tolerance, double largest_step, double output_step,
                 const Output& output);

 private:
  using Vector = Eigen::VectorXd;
  bool evaluate(const Vector& y, Vector& y_dot);
  void write_outputs(double time, double step, const Vector& y, const Vector& y_new, double end_time,
                     double output_step, const Output& output);

  test::DenseEvaluator evaluator_;
  dynamics::PartitionedOde ode_;  // for its partition and its error scales
  dynamics::Partition partition_;
  Vector start_q_, start_v_, q_, v_, start_y_;
  std::array<Vector, 7> k_;
  long next_output_ = 0;
  Statistics statistics_;
};

}  // namespace sprung::benchmark
