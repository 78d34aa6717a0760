#include "reduce/reduction/held_rounding.h"

#include <fmt/format.h>

#include <cmath>

#include "reduce/design/design_couplings.h"
#include "reduce/modes/held_node.h"
#include "reduce/modes/rounding_error.h"

namespace sprung::reduce {

namespace {

constexpr double kSpoils = 1e-6;       // error from which a check may fail by it
constexpr double kNearlyRigid = 1e-3;  // a beam that bends under its own inertia has 3e-2

}  // namespace

bool HeldRounding::is_of_soft_reference() const {
  return error > kSpoils && bent_share < kNearlyRigid;
}

HeldRounding estimate_held_rounding(const BodyMatrices& matrices) {
  const Eigen::MatrixXd loads = remove_node(matrices.rigid.momenta, matrices.rigid.reference_node);
  const Eigen::MatrixXd held = matrices.factor->solve(loads);
  const Eigen::MatrixXd shapes = insert_node(held, matrices.rigid.reference_node);
  const Eigen::MatrixXd bent = remove_momentum(matrices.rigid, shapes);
  HeldRounding worst;
  for (Eigen::Index i = 0; i < loads.cols(); ++i) {
    const double work = loads.col(i).dot(held.col(i));
    if (!(work > 0.0)) continue;
    const double error = estimate_rounding_error(matrices.free.stiffness, held.col(i), work);
    if (error <= worst.error) continue;
    worst = {.error = error,
             .bent_share = std::abs(bent.col(i).dot(matrices.full.mass * bent.col(i))) /
                           shapes.col(i).dot(matrices.full.mass * shapes.col(i))};
  }
  return worst;
}

std::string describe_soft_reference(const Design& design, const BodyMatrices& matrices) {
  const Eigen::VectorXd stiffness = matrices.full.stiffness.diagonal();
  const auto stiffness_at = [&](int node) { return stiffness(3 * node) + stiffness(3 * node + 1); };
  const fem::Mesh& mesh = design.model.mesh;
  const fem::Mesh::NamedNode* stiffest = nullptr;
  for (const fem::Mesh::NamedNode& point : mesh.named_nodes) {
    if (follows(design.model, point.node)) continue;
    if (stiffest == nullptr || stiffness_at(point.node) > stiffness_at(stiffest->node)) stiffest = &point;
  }
  const bool is_stiffer =
      stiffest != nullptr && stiffness_at(stiffest->node) > stiffness_at(design.reference_node);
  return fmt::format(
      "the reference, {}, hangs on the body so softly that rounding spoils what it holds; take a point of a "
      "stiff part of the body as the reference{}",
      fem::describe_node(mesh, design.reference_node),
      is_stiffer ? fmt::format(", such as '{}', and keep the soft one as a point", stiffest->name) : "");
}

}  // namespace sprung::reduce
