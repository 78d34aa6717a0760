#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/integration/exponential/vibration_basis.h"
#include "dynamics/integration/lobatto_points.h"

namespace sprung::dynamics {

/// The shear of the pairs over a step, ΔG: what G has become since they were made. It is linear in time.
class ShearCourse {
 public:
  ShearCourse() = default;
  /// No shear. @param others, elastic  numbers of freedoms
  ShearCourse(Eigen::Index others, Eigen::Index elastic)
      : rows_(Eigen::MatrixXd::Zero(2 * others, elastic)) {}

  auto start() const { return rows_.topRows(rows_.rows() / 2); }    ///< ΔG at the start, others × elastic
  auto rate() const { return rows_.bottomRows(rows_.rows() / 2); }  ///< of ΔG [1/s]
  const Eigen::MatrixXd& rows() const { return rows_; }             ///< both, one above the other
  void set_rate(const Eigen::MatrixXd& rate) { rows_.bottomRows(rows_.rows() / 2) = rate; }
  /// Starts t seconds later.
  void go_on(double t) { rows_.topRows(rows_.rows() / 2) += t * rate(); }

 private:
  Eigen::MatrixXd rows_;
};

/// Motion of the elastic freedoms at the nodes of a step, elastic × 4 each.
struct ElasticMotion {
  /// The motion at the start becomes that at a node of another step.
  void start_from(int node, const ElasticMotion& other) {
    positions.col(0) = other.positions.col(node);
    velocities.col(0) = other.velocities.col(node);
    accelerations.col(0) = other.accelerations.col(node);
  }

  Eigen::MatrixXd positions, velocities, accelerations;
};

/// How the freedoms that deform no body give way to fast vibration of the elastic ones, by inertia alone:
/// δq_o = G δq_e with the least kinetic energy. G changes as bodies turn, and what it has become since the
/// pairs were made is added to the motion that they describe (integration/exponential, eq. 6). Checked by
/// tests/dynamics/integration/exponential/inertial_shear_test.cpp
class InertialShear {
 public:
  /// Begins with pairs that were made for a mass matrix: they need no shear.
  /// @param elastic  freedoms, ascending, may be empty   @param mass  M̂, f×f
  void start(const VibrationBasis& basis, const std::vector<int>& elastic, const Eigen::MatrixXd& mass);
  /// Whether there are both elastic freedoms and others.
  bool is_useful() const { return !elastic_.empty() && !others_.empty(); }
  const std::vector<int>& others() const { return others_; }
  ShearCourse no_course() const { return {std::ssize(others_), std::ssize(elastic_)}; }
  ElasticMotion no_motion() const;

  /// Finds ΔG for another mass matrix. @param columns  those of M̂ that belong to the others
  /// @param[out] shear  others × elastic   @return false where the others have no inertia
  bool calc_shear(const Eigen::MatrixXd& columns, Eigen::MatrixXd& shear);

  /// From the state T u to that of the sheared pairs, t seconds after the start of a course, and back.
  /// @param[in,out] state  2f: positions, velocities
  void add(const ShearCourse& course, double t, double* state) const { shift(1.0, course, t, state); }
  void remove(const ShearCourse& course, double t, double* state) const { shift(-1.0, course, t, state); }
  /// The same for derivatives: those of a state of the sheared pairs become those of T u.
  /// @param state  2f   @param[in,out] derivatives  2f   @param[out] motion  its column for the node
  void remove_from_derivatives(const ShearCourse& course, double t, const double* state, double* derivatives,
                               int node, ElasticMotion& motion) const;
  /// The drive at a node is to hold for another rate of the shear. @param change  of the rate
  /// @param t  time of the node, from where both shears are the same [s]
  void change_rate(const Eigen::MatrixXd& change, const ElasticMotion& motion, int node, double t,
                   const PairBlocks& blocks, lobatto::NodeValues& drive);

 private:
  bool calc_ratio(const Eigen::MatrixXd& columns);
  void shift(double factor, const ShearCourse& course, double t, double* state) const;

  Eigen::Index f_ = 0;
  bool has_inertia_ = false;  // the others, where the pairs were made
  std::vector<int> elastic_, others_;
  Eigen::MatrixXd first_ratio_;       // −G of the pairs, others × elastic
  Eigen::MatrixXd factor_, inverse_;  // M̂_oo and its inverse
  Eigen::MatrixXd coupling_, ratio_;  // M̂_eo, M̂_oo⁻¹ M̂_oe
  Eigen::MatrixXd other_columns_;     // of T⁻¹: for positions and velocities of the others
  // Work space.
  mutable Eigen::VectorXd elastic_motion_, other_motion_;
  Eigen::MatrixXd moved_;             // others × 3
  Eigen::VectorXd loss_, loss_rate_;  // 2f
};

}  // namespace sprung::dynamics
