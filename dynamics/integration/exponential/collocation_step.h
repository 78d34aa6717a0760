#pragma once

#include <Eigen/Core>

#include "dynamics/integration/exponential/inertial_shear.h"
#include "dynamics/integration/exponential/lobatto_step.h"

namespace sprung::dynamics {

/// Motion at one instant in the pairs of a VibrationBasis; or its derivative.
struct PairedMotion {
  Eigen::VectorXd u;  ///< pairs, 2f
  Eigen::VectorXd w;  ///< quadratures
};

/// The part of the derivatives that the pairs do not explain, at the Lobatto points of a step.
struct Drive {
  lobatto::NodeValues pairs;  ///< 2f×4
  lobatto::NodeValues rates;  ///< of the quadratures, a column for each point

  void set(int node, const PairedMotion& value) { pairs.col(node) = value.u, rates.col(node) = value.w; }
};

/// A step of exponential collocation: its start and its drive give the motion at all its instants.
struct CollocationStep {
  CollocationStep() = default;
  CollocationStep(Eigen::Index num_pairs, Eigen::Index num_quadratures);

  /// Motion up to the instant of a propagator, from the cubic drive.
  void propagate(const LobattoPropagator& propagator, const PairBlocks& blocks, PairedMotion& motion) const;
  /// Adds the effect of the drive's part of fourth degree up to that instant, where this part is known.
  void add_quartic(const LobattoPropagator& propagator, const PairBlocks& blocks, PairedMotion& motion) const;
  /// The drive at θ.
  void calc_drive(double theta, PairedMotion& drive) const;
  /// The effect of the part of fourth degree alone up to that instant.
  void propagate_quartic(const LobattoPropagator& propagator, const PairBlocks& blocks,
                         PairedMotion& motion) const;

  double start = 0.0, length = 0.0;  ///< [s]
  ShearCourse shear;                 ///< of the pairs
  ElasticMotion elastic;             ///< at the nodes
  PairedMotion motion;               ///< at the start
  Drive drive;
  PairedMotion quartic;      ///< coefficients of node_polynomial, estimated
  bool has_quartic = false;  ///< found from a point of the step before; else it is a guess of its size only
};

/// From which earlier step a step can be predicted.
enum class Past {
  kNone,
  kSwitched,  ///< the last step was cut off where this one starts
  kSmooth,    ///< the last step ended where this one starts
};

/// Predicts the drive of a step, for the first sweep of its iteration (integration/exponential, eq. 7).
class DrivePrediction {
 public:
  DrivePrediction() = default;
  DrivePrediction(Eigen::Index num_pairs, Eigen::Index num_quadratures);

  /// Fills the drive at all points but the first by the polynomial of the last step. After a switch the
  /// polynomial is shifted so that it passes through the drive that holds there.
  void predict(const CollocationStep& last, Past past, CollocationStep& now);
  /// Corrects the prediction at the points after `node` by the drive found at that one: the difference from
  /// the expected drive continues in the shape that the error of the prediction has.
  void correct(int node, CollocationStep& now);

 private:
  Drive expected_;
  PairedMotion jump_, difference_, at_;  // work space
  Eigen::Matrix<double, lobatto::kNumNodes, lobatto::kNumNodes>
      weights_;  // at a point (row) from another (column)
};

}  // namespace sprung::dynamics
