#include "dynamics/linear/massless_motion.h"

#include "dynamics/system/partitioned_equations.h"
#include "tools/support/dense/eigenproblems.h"

namespace sprung::dynamics {

namespace {

// Smallest share of the mass in mass and stand-ins together. Above it, the accelerations are found in few
// iterations.
constexpr double kLeastShare = 0.1;
constexpr int kMostFreedoms = 1000;

}  // namespace

std::optional<int> find_massless_motion(const Model& model, const Eigen::VectorXd& q) {
  if (!model.has_massless_bodies || model.num_freedoms() == 0 || model.num_freedoms() > kMostFreedoms) {
    return std::nullopt;
  }
  PartitionedEquations equations(model);
  equations.choose_partition_at(0.0, q);
  const Eigen::MatrixXd D = equations.calc_directions();
  const Eigen::MatrixXd mass = equations.calc_reduced_mass(D);
  Eigen::VectorXd stand_in = Eigen::VectorXd::Zero(model.num_coordinates);
  for (const Body& body : model.bodies) {
    stand_in.segment<3>(body.first_coordinate) << body.stand_in_mass, body.stand_in_mass,
        body.stand_in_inertia;
  }
  const Eigen::MatrixXd all = mass + D.transpose() * stand_in.asDiagonal() * D;
  const auto pairs = support::solve_undamped(mass, all);
  if (pairs && pairs->values[0] >= kLeastShare) return std::nullopt;
  Eigen::VectorXd motion = stand_in;  // where even the eigenvalues cannot be found
  if (pairs) motion = (D * pairs->vectors.col(0)).array().square() * stand_in.array();
  Eigen::Index largest = 0;
  motion.maxCoeff(&largest);
  return static_cast<int>(largest);
}

}  // namespace sprung::dynamics
