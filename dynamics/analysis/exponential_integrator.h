#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "dynamics/analysis/integrator.h"

namespace sprung::dynamics {

/// Exponential collocation. Small motion about a state seen on the way is taken apart into uncoupled oscillators,
/// which are solved exactly whatever their frequency; what is left of the accelerations is a polynomial over the step
/// through its values at the four Lobatto points, found by iteration. So the step follows what excites the stiff
/// modes, and not their period. Order 6 at the ends of steps, 4 within. One step needs nothing from before: after a
/// switch it goes on with the step it had.
/// Source: variation of constants; [Hochbruck & Ostermann 2010] (dynamics/README.md, eqs. 41–45).
class ExponentialIntegrator final : public Integrator {
 public:
  ExponentialIntegrator(OdeSystem& system, double relative_tolerance);

  void start(double time, std::span<const double> y, double end_time) override;
  StepResult step(double longest_step) override;
  double time() const override { return time_; }
  std::span<const double> y() const override { return {y_.data(), static_cast<std::size_t>(y_.size())}; }
  void interpolate(double time, std::span<double> y) const override;
  Statistics statistics() const override { return statistics_; }

 private:
  static constexpr int kNodes = 4;
  using Vector = Eigen::VectorXd;
  using NodeValues = Eigen::Matrix<double, Eigen::Dynamic, kNodes>;

  // From the start of the step and the forces at the nodes to one instant of it; rows are oscillators.
  struct Propagator {
    Eigen::ArrayXd c, s, c_rate, s_rate;
    Eigen::Array<double, Eigen::Dynamic, kNodes> force, force_rate;
    Eigen::ArrayXd truncation, truncation_rate;  // from the part of the force of fourth degree
    std::array<double, kNodes> quadrature;       // of the plain integrals
    double quadrature_truncation;
  };

  // A step: the state at its start and the forces at its nodes tell all of it.
  struct Step {
    double start = 0.0, length = 0.0;  // [s]
    Vector x, x_dot, w;                // at the start
    NodeValues forces, rates;          // of the oscillators; of the quadratures
  };
  // What each oscillator does up to one instant of a step.
  struct Motion {
    Vector x, x_dot, w;
  };

  void linearise();
  bool begin();
  bool evaluate(double time, const Vector& y, const Vector& x, const Vector& x_dot, int node);
  void update_propagator(double theta, double length, Propagator& propagator) const;
  void propagate(const Propagator& propagator, const Step& step, Motion& motion) const;
  void to_physical(const Motion& motion, Vector& y) const;
  void predict_forces();
  bool iterate();
  double calc_truncation();
  double calc_norm(const Motion& motion);
  bool locate_switch();

  OdeSystem& system_;
  double tolerance_;
  Eigen::Index f_, num_quadratures_;
  int num_switches_;
  Statistics statistics_;

  // Oscillators: q = Φ x.
  int version_ = -1;
  Eigen::MatrixXd Phi_, inverse_;  // f×f
  Eigen::ArrayXd stiffness_, decay_;
  bool wants_linearisation_ = true;
  long last_linearisation_ = 0;

  double time_ = 0.0, end_time_ = 0.0, step_start_ = 0.0;
  double next_length_ = 0.0;
  Vector y_;
  Step now_, last_;           // being made; finished
  bool has_begun_ = false;    // now_ has its start
  bool has_history_ = false;  // last_ ended where now_ starts, and nothing switched
  std::array<Motion, kNodes> stages_;
  std::array<Propagator, kNodes> propagators_;  // 1…3 used
  double propagator_length_ = 0.0;
  double contraction_ = 0.3;
  int sweeps_ = 0;
  bool can_predict_ = false, quartic_valid_ = false;
  Vector quartic_force_, quartic_rate_, last_quartic_force_, last_quartic_rate_;
  double last_error_ = 0.0;
  Eigen::MatrixXd switches_;  // num_switches × kNodes
  Vector y_dot_, scales_, stage_y_, difference_;
  Motion end_, delta_;
  mutable Propagator output_propagator_;
  mutable Motion output_;
  mutable Vector output_y_;
};

}  // namespace sprung::dynamics
