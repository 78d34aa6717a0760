#include "reduce/modes/canonical_basis.h"

#include <cmath>
#include <utility>

#include "reduce/modes/clusters.h"
#include "reduce/modes/largest_displacement.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/dense/orthogonal_factors.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr double kMomentGap = 1e-3;  // of the radius: nearer values of ∫x φᵀφ dm count as equal
constexpr double kEqualParticipation = 0.01;  // participations nearer than this share count as equal

// Directions fixed so far and an orthonormal basis of those still free, as columns over a cluster's members.
struct ClusterDirections {
  Eigen::MatrixXd fixed;
  Eigen::MatrixXd free;
};

void append_columns(Eigen::MatrixXd& matrix, const Eigen::MatrixXd& columns) {
  const Eigen::Index old = matrix.cols();
  matrix.conservativeResize(columns.rows(), old + columns.cols());
  matrix.rightCols(columns.cols()) = columns;
}

// Fixes the direction along which a linear functional of the modes acts, so that it vanishes on what stays
// free.
// @param row  the functional's values on the columns of directions.free
void fix_direction(ClusterDirections& directions, const Eigen::RowVectorXd& row) {
  const Eigen::MatrixXd rotation = support::make_rotation_onto(row.transpose());
  append_columns(directions.fixed, directions.free * rotation.leftCols(1));
  const Eigen::MatrixXd rest = directions.free * rotation.rightCols(rotation.cols() - 1);
  directions.free = rest;
}

// Rule 1. @param participation  3×m, divided by the scales
void fix_by_participation(ClusterDirections& directions, const Eigen::MatrixXd& participation) {
  for (Eigen::Index i = 0; i < 3 && directions.free.cols() > 0; ++i) {
    const Eigen::RowVectorXd row = participation.row(i) * directions.free;
    if (row.norm() >= kParticipationThreshold) fix_direction(directions, row);
  }
}

// Rule 3.
void fix_by_displacement(ClusterDirections& directions, const Eigen::MatrixXd& shapes,
                         const Eigen::Matrix2Xd& node_positions) {
  while (directions.free.cols() > 0) {
    const Eigen::MatrixXd rest = shapes * directions.free;
    fix_direction(directions, rest.row(find_largest_displacement(rest, node_positions)));
  }
}

// Rule 2, and rule 3 for each group that it leaves equal.
void fix_by_moment(ClusterDirections& directions, const Eigen::MatrixXd& shapes, const BasisFrame& frame) {
  const Eigen::MatrixXd rest = shapes * directions.free;
  const Eigen::MatrixXd moment = rest.transpose() * (frame.make_weighted_mass() * rest);
  const auto eigen = support::solve_symmetric(0.5 * (moment + moment.transpose()));
  if (!eigen) throw support::NumericalError("modes: a cluster's moments have no eigenvectors");
  const Eigen::VectorXd& values = eigen->values;
  const Eigen::MatrixXd ordered = directions.free * eigen->vectors;
  const double gap = kMomentGap * frame.node_positions.colwise().norm().maxCoeff();
  for (Eigen::Index begin = 0, end = 0; begin < values.size(); begin = end) {
    end = begin + 1;
    while (end < values.size() && values(end) - values(end - 1) < gap) ++end;
    ClusterDirections group{.fixed = {}, .free = ordered.middleCols(begin, end - begin)};
    fix_by_displacement(group, shapes, frame.node_positions);
    append_columns(directions.fixed, group.fixed);
  }
  directions.free.resize(directions.free.rows(), 0);
}

double calc_sign(const Eigen::VectorXd& participation, const Eigen::VectorXd& shape,
                 const Eigen::Matrix2Xd& node_positions) {
  const double largest = participation.cwiseAbs().maxCoeff();
  double decisive = 0.0;
  if (largest >= kParticipationThreshold) {
    Eigen::Index i = 0;
    while (std::abs(participation(i)) < (1.0 - kEqualParticipation) * largest) ++i;
    decisive = participation(i);
  } else {
    decisive = shape(find_largest_displacement(shape, node_positions));
  }
  return decisive < 0.0 ? -1.0 : 1.0;
}

}  // namespace

BasisFrame make_basis_frame(const RigidMotions& rigid, const Eigen::Matrix2Xd& node_positions,
                            std::function<Eigen::SparseMatrix<double>()> make_weighted_mass) {
  BasisFrame frame{.node_positions = node_positions,
                   .mass = rigid.mass(0, 0),
                   .second_moment = rigid.mass(2, 2),
                   .participation_rows = Eigen::MatrixXd(3, rigid.momenta.rows()),
                   .make_weighted_mass = std::move(make_weighted_mass)};
  frame.participation_rows << rigid.momenta.col(1).transpose(), rigid.momenta.col(0).transpose(),
      rigid.momenta.col(2).transpose();
  return frame;
}

Eigen::MatrixXd calc_canonical_rotation(const Eigen::MatrixXd& shapes, const Eigen::VectorXi& cluster,
                                        const BasisFrame& frame) {
  const Eigen::Vector3d scales(std::sqrt(frame.mass), std::sqrt(frame.mass), std::sqrt(frame.second_moment));
  const Eigen::MatrixXd participation =
      scales.cwiseInverse().asDiagonal() * (frame.participation_rows * shapes);
  const Eigen::Index n = shapes.cols();
  Eigen::MatrixXd rotation = Eigen::MatrixXd::Zero(n, n);
  for (ModeRange range; range.begin < n; range.begin = range.end) {
    range = find_cluster_of(cluster, range.begin);
    const Eigen::MatrixXd members = shapes.middleCols(range.begin, range.size());
    const Eigen::MatrixXd parts = participation.middleCols(range.begin, range.size());
    ClusterDirections directions{.fixed = {}, .free = Eigen::MatrixXd::Identity(range.size(), range.size())};
    if (range.size() == 1) {  // nothing to choose
      std::swap(directions.fixed, directions.free);
    } else {
      fix_by_participation(directions, parts);
      if (directions.free.cols() > 0) fix_by_moment(directions, members, frame);
    }
    for (Eigen::Index i = 0; i < range.size(); ++i) {
      const Eigen::VectorXd direction = directions.fixed.col(i);
      directions.fixed.col(i) *= calc_sign(parts * direction, members * direction, frame.node_positions);
    }
    rotation.block(range.begin, range.begin, range.size(), range.size()) = directions.fixed;
  }
  return rotation;
}

}  // namespace sprung::reduce
