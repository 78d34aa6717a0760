#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "dynamics/adaptivity/full_small_motion.h"
#include "tools/support/dense/dense_solvers.h"

namespace sprung::dynamics {

/// How a run starts beside the full model.
struct MissingStart {
  /// Whether the modes left out begin in balance with the forces on them. Else they begin where they are
  /// held.
  bool is_balanced = true;
  Eigen::VectorXd rates = {};  ///< with which the full model would start, nq; empty: those of the run
};

/// What the modes left out would add to the motion of a run, together and to first order: small motion of the
/// full model under the forces that the run leaves unbalanced on its modes (adaptivity, eq. 7), in the
/// eigenvectors of its first-order form. So damping of any size and internal states count. Checked by
/// tests/verification/left_out_test.py and left_out_changes_test.py
class MissingMotion {
 public:
  /// @param motion  of the full model about the start of the run; only read here
  MissingMotion(const FullSmallMotion& motion, const MissingStart& start);

  /// Continues through a step in which the forces change smoothly, or to the same instant where they have
  /// jumped.
  /// @param step    at least 0; the first call is at the start [s]
  /// @param forces  unbalanced ones on each mode [N/√kg]
  /// @param v       rates of the run in coordinates of the full model; read at the start
  void update(double step, const Eigen::VectorXd& forces, const Eigen::VectorXd& v);
  /// The rates of the run jump at the last update, as where modes are stopped; those of the full model do
  /// not. An `update` at the same time has to follow.
  /// @param change  rates before less those after, in coordinates of the full model, nq
  void add_rates(const Eigen::VectorXd& change);
  /// Added acceleration of each point asked for, along x and y in turn, in the axes of the start [m/s²].
  const Eigen::VectorXd& accelerations() const { return accelerations_; }
  /// Of the fastest growing part of the small motion, 0 where none grows [1/s].
  double growth() const { return growth_; }

  /// The term of one eigenvector.
  struct Term {
    std::complex<double> place = {}, force = {};  ///< ζ, and g at the last update
    std::complex<double> chord = {}, slope = {};  ///< mean rate of g in the last step, and at its end
  };
  /// All that an update changes.
  struct State {
    bool has_begun = false;
    double last_step = 0.0;  ///< 0 where the slopes are not known
    std::vector<Term> terms;
  };
  const State& state() const { return state_; }
  /// Goes back to an earlier instant.
  void set_state(const State& state) { state_ = state; }

  template <class Bytes, class Motion>
  static void transfer(Bytes& bytes, Motion& motion) {
    bytes.transfer(motion.state_.has_begun);
    bytes.transfer(motion.state_.last_step);
    bytes.transfer_items(motion.state_.terms, [&](auto& one) {
      for (auto* value : {&one.place, &one.force, &one.chord, &one.slope}) {
        double real = value->real(), imaginary = value->imag();
        bytes.transfer(real);
        bytes.transfer(imaginary);
        transfer_back(real, imaginary, *value);
      }
    });
  }
  bool has_consistent_states() const { return state_.terms.size() == parts_.size(); }

 private:
  // The share of one eigenvalue μ, of a pair or real: ζ̇ = μζ + g.
  struct Part {
    std::complex<double> rate;  // μ [1/s]
    Eigen::Index column = 0;    // among the eigenvectors
    bool is_pair = false;
    std::array<std::complex<double>, 5> weights = {};  // for steps of the length below
  };
  static void transfer_back(double, double, const std::complex<double>&) {}
  static void transfer_back(double real, double imaginary, std::complex<double>& value) {
    value = {real, imaginary};
  }
  // @return false where the eigenvectors are not found
  bool take(const SmallMotion& small, const Eigen::MatrixXd& rounding, const Eigen::MatrixXd& of_modes,
            const Eigen::MatrixXd& of_points);
  void take_lone_modes(const FullSmallMotion& motion);
  void begin(const Eigen::VectorXd& forces, const Eigen::VectorXd& v);
  std::complex<double> select(const Eigen::VectorXd& values, const Part& part) const;

  MissingStart start_;
  std::vector<int> coordinates_;  // independent ones
  std::vector<Part> parts_;
  State state_;
  // The states z = Xζ follow ż = A z + forcing·r; accelerations of the points = to_accelerations·(ζ, r).
  Eigen::MatrixXd forcing_, to_accelerations_;  // by eigenvector and mode, by point and eigenvector or mode
  support::LuFactors vectors_{.lu = {}};        // X
  Eigen::MatrixXd static_states_;               // of a force on each mode
  Eigen::MatrixXd rate_states_;                 // of the rates of the independent coordinates
  double weighted_step_ = 0.0, growth_ = 0.0;
  Eigen::VectorXd driving_, places_and_forces_, accelerations_;
};

}  // namespace sprung::dynamics
