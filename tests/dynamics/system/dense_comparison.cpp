#include "tests/dynamics/system/dense_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "dynamics/system/energy.h"
#include "dynamics/system/partitioned_equations.h"
#include "tests/dynamics/dense_evaluator.h"

namespace sprung::test {

using dynamics::PartitionedEquations;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

// Largest difference of each kind of coordinate over the largest value of that kind.
double relative_difference(const dynamics::Model& model, const VectorXd& found, const VectorXd& expected) {
  std::array<double, 3> difference{}, size{};
  for (const dynamics::Body& body : model.bodies) {
    for (Index k = 0; k < body.num_coordinates(); ++k) {
      const std::size_t kind = k < 2 ? 0 : k == 2 ? 1 : 2;
      const Index i = body.first_coordinate + k;
      difference[kind] = std::max(difference[kind], std::abs(found[i] - expected[i]));
      size[kind] = std::max(size[kind], std::abs(expected[i]));
    }
  }
  double largest = 0.0;
  for (std::size_t kind = 0; kind < 3; ++kind) {
    if (size[kind] > 0.0) largest = std::max(largest, difference[kind] / size[kind]);
  }
  return largest;
}

std::vector<double> pick(const VectorXd& all, const std::vector<int>& indices) {
  std::vector<double> picked;
  for (const int i : indices) picked.push_back(all[i]);
  return picked;
}

}  // namespace

double EvaluatorDifference::largest() const {
  return std::max({position, velocity, acceleration, multiplier, kinetic_energy});
}

EvaluatorDifference compare_evaluators(const dynamics::Model& model, const VectorXd& assembled,
                                       const VectorXd& q, const VectorXd& v, dynamics::State& evaluated) {
  PartitionedEquations fast(model);
  fast.choose_partition_at(0.0, assembled);
  const dynamics::Partition partition = fast.partition();
  const std::vector<double> q_i = pick(q, partition.independent), v_i = pick(v, partition.independent);
  if (fast.update_positions(0.0, q_i) != PartitionedEquations::Outcome::kGood) {
    throw std::runtime_error("compare_evaluators: the fast evaluator cannot close the joints");
  }
  fast.update_velocities(v_i);
  std::vector<int> branches(static_cast<std::size_t>(model.num_branches));
  fast.terms().choose_branches(branches);
  fast.update_accelerations(branches);
  evaluated = {.time = 0.0, .q = fast.q(), .v = fast.v(), .branches = branches};

  DenseEvaluator plain(model);
  VectorXd plain_q = assembled, plain_v = v;
  for (const int i : partition.independent) plain_q[i] = q[i];
  if (!plain.solve_positions(partition.dependent, plain_q)) {
    throw std::runtime_error("compare_evaluators: the plain evaluator cannot close the joints");
  }
  plain.solve_velocities(partition.dependent, plain_q, plain_v);
  plain.solve_accelerations(plain_q, plain_v);

  EvaluatorDifference difference;
  difference.position = relative_difference(model, fast.q(), plain_q);
  difference.velocity = relative_difference(model, fast.v(), plain_v);
  difference.acceleration = relative_difference(model, fast.v_dot(), plain.v_dot());
  if (model.num_constraints > 0) {
    difference.multiplier = (fast.multipliers() - plain.multipliers()).cwiseAbs().maxCoeff() /
                            plain.multipliers().cwiseAbs().maxCoeff();
  }
  const double kinetic = calc_energy(fast.terms(), branches).kinetic;
  difference.kinetic_energy = std::abs(kinetic - plain.kinetic_energy()) / plain.kinetic_energy();
  return difference;
}

}  // namespace sprung::test
