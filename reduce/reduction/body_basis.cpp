#include "reduce/reduction/body_basis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fem/assembly.h"
#include "reduce/basis/fixed_interface_basis.h"
#include "reduce/basis/free_basis.h"
#include "reduce/certificate/certify.h"
#include "reduce/matrices/ground.h"
#include "reduce/matrices/matrix_moments.h"
#include "reduce/modes/canonical_basis.h"
#include "reduce/modes/clusters.h"
#include "reduce/modes/held_node.h"
#include "reduce/modes/rounding_error.h"
#include "reduce/reduction/distance_weighted_mass.h"
#include "reduce/reduction/held_rounding.h"
#include "reduce/reduction/mechanism.h"
#include "reduce/reduction/superelement_checks.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"
#include "tools/support/processes/large_heap.h"

namespace sprung::reduce {

namespace {

constexpr double kResidualTolerance = 1e-6;
// The band of a clamped basis that names none: up to this mode's frequency, by the margin of free modes.
constexpr Eigen::Index kBandMode = 20;

constexpr std::size_t kLargeFrame = 20'000;         // freedoms
constexpr std::size_t kMemoryPerFreedom = 8 << 10;  // bytes, by measured builds

// Rigid motions of the nodes that have freedoms of their own.
RigidMotions make_leaders_motions(const Design& design, RigidMotions rigid) {
  for (const fem::Coupling& coupling : design.model.couplings)
    rigid.shapes.middleRows<3>(3 * coupling.node).setZero();
  return rigid;
}

// Vectors of the held frame, in the canonical basis of their clusters.
struct CanonicalVectors {
  Eigen::MatrixXd vectors;    // (3N−3)×n
  Eigen::MatrixXd stiffness;  // n×n
};

CanonicalVectors make_canonical(const Design& design, const BodyMatrices& matrices, const EigenPairs& pairs,
                                const Eigen::VectorXi& cluster, const std::vector<int>& columns,
                                const Eigen::MatrixXd& shapes) {
  const auto make_weighted_mass = [&]() -> Eigen::SparseMatrix<double> {
    const Eigen::Vector2d origin = design.model.mesh.node_positions.col(design.reference_node);
    return design.matrices ? calc_distance_weighted_mass(*design.matrices, origin)
                           : calc_distance_weighted_mass(design.model, origin);
  };
  const Eigen::MatrixXd rotation = calc_canonical_rotation(
      shapes, cluster, make_basis_frame(matrices.rigid, matrices.node_positions, make_weighted_mass));
  const Eigen::MatrixXd chosen = rotation(Eigen::all, columns);
  const Eigen::MatrixXd stiffness = chosen.transpose() * pairs.omega_squared.asDiagonal() * chosen;
  return {.vectors = pairs.vectors * chosen, .stiffness = 0.5 * (stiffness + stiffness.transpose())};
}

// The largest ‖φ − K⁻¹(M Φ S)‖ in the norm of strain energy, relative: it weighs what a mode holds of lower
// and of higher modes alike.
double calc_residual(const ModalProblem& problem, const StiffnessFactor& factor,
                     const Eigen::MatrixXd& vectors, const Eigen::MatrixXd& stiffness) {
  double largest = 0.0;
  if (vectors.cols() == 0) return largest;
  const Eigen::MatrixXd error = vectors - factor.solve(problem.times_mass(vectors * stiffness));
  for (Eigen::Index i = 0; i < error.cols(); ++i) {
    const double energy = std::abs(error.col(i).dot(problem.stiffness * error.col(i)));
    largest = std::max(largest, std::sqrt(energy / stiffness(i, i)));
  }
  return largest;
}

// Where the reference node is soft, the residual is what rounding leaves of its hold.
std::vector<CheckResult> make_model_checks(int num_missing, double rounding, const HeldRounding& held,
                                           double residual) {
  return {
      {.name = "modes missing below the highest one", .value = std::abs(num_missing) * 1.0, .tolerance = 0.0},
      {.name = kRoundingCheck, .value = rounding, .tolerance = kMaxRoundingError},
      {.name = kHeldRoundingCheck, .value = held.error, .tolerance = kMaxHeldRounding},
      {.name = kResidualCheck,
       .value = residual,
       .tolerance = kResidualTolerance + std::min(held.error, kMaxRoundingError)}};
}

// A band that the modes stored can be judged by.
double choose_band(const Design& design, const EigenPairs& stored) {
  if (design.reduction.highest_hz) return *design.reduction.highest_hz;
  const Eigen::Index last = std::min(stored.omega_squared.size(), kBandMode) - 1;
  return calc_frequency_hz(stored.omega_squared(last)) / kBandMargin;
}

BasisRequest make_request(const Design& design, const BodyMatrices& matrices, double highest_hz) {
  BasisRequest request{.interface = design.reduction.interface,
                       .loads = {},
                       .frame_loads = {},
                       .highest_hz = highest_hz,
                       .tolerance = design.reduction.tolerance,
                       .all_residual = design.reduction.all_residual,
                       .where = design.reduction.where};
  const auto num_nodes = static_cast<int>(matrices.full.stiffness.rows() / 3);
  request.loads = balance_loads(
      matrices.rigid,
      fem::move_loads_to_leaders(design.model.couplings, make_interface_loads(num_nodes, request.interface)));
  request.frame_loads = make_frame_loads(design, matrices.rigid);
  return request;
}

// The matrices of another program may hold the body.
void require_free(const Design& design, double lowest_omega_squared) {
  if (design.matrices) require_no_ground(*design.matrices, calc_frequency_hz(lowest_omega_squared));
}

Certificate certify_clamped(const Design& design, const BodyMatrices& matrices, const StiffnessFactor& factor,
                            const EigenPairs& stored, double rounding, const ClampedModeOptions& options) {
  const BasisRequest request = make_request(design, matrices, choose_band(design, stored));
  const ModesBelow free = calc_modes_below(matrices.free, kBandMargin * request.highest_hz, options);
  require_free(design,
               free.pairs.omega_squared.size() > 0 ? free.pairs.omega_squared(0) : free.next_omega_squared);
  InterfaceResidual residual(matrices.free, factor, {}, request.loads);
  const bool is_complete = stored.vectors.cols() == matrices.free.size();
  if (!is_complete) residual.add(stored.vectors);
  return calc_certificate(residual, {.interface = request.interface,
                                     .frame_loads = request.frame_loads,
                                     .highest_hz = request.highest_hz,
                                     .free_modes = free.pairs,
                                     .next_omega_squared = free.next_omega_squared,
                                     .is_complete = is_complete,
                                     .rounding = rounding});
}

// A reference without mass moves against the body without inertia: the held body has more modes than the free
// one has elastic motions, and enough of them leave frame and modes together a motion without mass.
void require_motions_with_mass(const Design& design, const BodyMatrices& matrices,
                               const Eigen::MatrixXd& vectors) {
  constexpr double kNoMass = 1e-9;  // of modes whose mass is 1 where the reference is held
  const Eigen::VectorXd mass = matrices.full.mass.diagonal();
  if (mass.segment<3>(3 * design.reference_node).minCoeff() > 0.0) return;
  const Eigen::MatrixXd of_free = vectors.transpose() * matrices.free.times_mass(vectors);
  const auto pairs = support::solve_symmetric(of_free);
  const Eigen::Index num = pairs ? (pairs->values.array() > kNoMass).count() : vectors.cols();
  if (num == vectors.cols()) return;
  throw support::InputError(
      design.modes.where,
      fmt::format(
          "asks for {} clamped modes, but they have only {} elastic motion{} with mass, because the "
          "reference, {}, has no mass of its own in some direction; take fewer modes, a reference with "
          "mass and moment of inertia, or the basis \"free\"",
          vectors.cols(), num, num == 1 ? "" : "s",
          fem::describe_node(design.model.mesh, design.reference_node)));
}

// The first three motions with mass are rigid ones.
void require_elastic_motion(const Design& design, const BodyMatrices& matrices) {
  if (matrices.free.num_modes() > 0) return;
  const Eigen::Index num = matrices.full.mass.rows() - matrices.free.num_massless;
  const std::string text = fmt::format(
      "only {} freedom{} of the body {} mass: with three rigid motions it has no elastic mode; give more of "
      "its "
      "points mass, or make it a rigid body of the vehicle",
      num, num == 1 ? "" : "s", num == 1 ? "has" : "have");
  if (design.matrices) throw support::InputError({.path = design.matrices->mass_path}, text);
  throw support::NumericalError(text);
}

BodyBasis make_clamped_basis(const Design& design, const BodyMatrices& matrices,
                             const StiffnessFactor& factor, const HeldRounding& held,
                             const ClampedModeOptions& options) {
  const ModalProblem problem = matrices.make_held();
  const int num_needed = calc_num_modes_needed(design.modes, problem, options);
  const ClampedModes modes = calc_clamped_modes(problem, num_needed, options);
  const double rounding = check_rounding(design, problem.stiffness, modes.pairs);
  const std::vector<int> columns = select_modes(design.modes, modes, num_needed);
  const CanonicalVectors canonical = make_canonical(design, matrices, modes.pairs, modes.cluster, columns,
                                                    make_shapes(design, modes.pairs.vectors));
  require_motions_with_mass(design, matrices, canonical.vectors);
  BodyBasis basis;
  basis.shapes = make_shapes(design, canonical.vectors);
  basis.cluster = modes.cluster(columns);
  basis.stiffness = canonical.stiffness;
  basis.kind.assign(columns.size(), kClampedVector);
  basis.checks = make_model_checks(modes.num_below - static_cast<int>(modes.cluster.size()), rounding, held,
                                   calc_residual(problem, factor, canonical.vectors, canonical.stiffness));
  try {
    basis.certificate = certify_clamped(
        design, matrices, factor,
        {.omega_squared = canonical.stiffness.diagonal(), .vectors = canonical.vectors}, rounding, options);
  } catch (const support::NumericalError&) {
    if (!held.is_of_soft_reference()) throw;
    throw support::NumericalError(
        fmt::format("{}, or the basis \"free\"", describe_soft_reference(design, matrices)));
  }
  return basis;
}

BodyBasis make_interface_basis(const Design& design, const BodyMatrices& matrices,
                               const StiffnessFactor& factor, const HeldRounding& held,
                               const ClampedModeOptions& options) {
  BasisRequest request = make_request(design, matrices, *design.reduction.highest_hz);
  request.progress = options.progress;
  const ModesBelow modes = calc_modes_below(matrices.free, kBandMargin * request.highest_hz, options);
  const ModesBelow& lowest =
      modes.cluster.size() > 0
          ? modes
          : calc_modes_below(matrices.free, 1.01 * calc_frequency_hz(modes.next_omega_squared), options);
  if (lowest.pairs.vectors.cols() == 0)
    throw support::NumericalError("no elastic mode of the free body was found, though the count has one");
  require_free(design, lowest.pairs.omega_squared(0));
  request.rounding = check_rounding(design, matrices.free.stiffness, lowest.pairs);
  const bool is_free = design.reduction.basis == BasisKind::kFree;
  const FreeBodyBasis found = is_free
                                  ? make_free_basis(matrices.free, factor, modes, request)
                                  : make_fixed_interface_basis(matrices.free, factor, modes, request,
                                                               make_leaders_motions(design, matrices.rigid),
                                                               matrices.full.stiffness, matrices.full.mass);
  BodyBasis basis;
  basis.cluster = find_clusters(found.vectors.omega_squared);
  std::vector<int> columns(found.kind.size());
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i] = static_cast<int>(i);
  const CanonicalVectors canonical =
      make_canonical(design, matrices, found.vectors, basis.cluster, columns,
                     remove_momentum(matrices.rigid, make_shapes(design, found.vectors.vectors)));
  basis.shapes = make_shapes(design, canonical.vectors);
  basis.stiffness = canonical.stiffness;
  basis.kind = found.kind;
  basis.certificate = found.certificate;
  const Eigen::Index k = is_free ? modes.cluster.size() : 0;
  basis.checks = make_model_checks(modes.num_missing, request.rounding, held,
                                   calc_residual(matrices.free, factor, canonical.vectors.leftCols(k),
                                                 canonical.stiffness.topLeftCorner(k, k)));
  if (is_free) {
    basis.checks.push_back({.name = "certified error of the interface flexibility",
                            .value = basis.certificate.largest_error(),
                            .tolerance = basis.certificate.tolerance});
  }
  return basis;
}

}  // namespace

Eigen::MatrixXd make_frame_loads(const Design& design, const RigidMotions& rigid) {
  const fem::MassMoments moments =
      make_mass_moments(design, design.model.mesh.node_positions.col(design.reference_node));
  std::vector<InterfaceFreedom> reference;
  for (const int freedom : {0, 1, 2})
    reference.push_back({.node = design.reference_node, .freedom = freedom});
  Eigen::MatrixXd loads(moments.x_N_x.size(), 4);
  loads << make_interface_loads(static_cast<int>(loads.rows() / 3), reference), moments.x_N_x + moments.y_N_y;
  return balance_loads(rigid, loads);
}

Eigen::MatrixXd make_shapes(const Design& design, const Eigen::MatrixXd& vectors) {
  return fem::move_followers(design.model.couplings, insert_node(vectors, design.reference_node));
}

fem::AssembledMatrices make_full_matrices(const Design& design) {
  if (!design.matrices) return fem::assemble(design.model);
  return {.stiffness = design.matrices->stiffness, .mass = design.matrices->mass};
}

BodyMatrices make_body_matrices(const Design& design) {
  const auto num_freedoms = static_cast<std::size_t>(3 * design.model.mesh.num_nodes());
  if (num_freedoms > kLargeFrame) support::prepare_large_heap(kMemoryPerFreedom * num_freedoms);
  BodyMatrices matrices;
  fem::AssembledMatrices full = make_full_matrices(design);
  matrices.full.stiffness.swap(full.stiffness);  // where an assignment would copy
  matrices.full.mass.swap(full.mass);
  remove_node(matrices.full.stiffness, design.reference_node).swap(matrices.free.stiffness);
  remove_node(matrices.full.mass, design.reference_node).swap(matrices.free.mass);
  const Eigen::Matrix2Xd& positions = design.model.mesh.node_positions;
  matrices.node_positions = positions.colwise() - positions.col(design.reference_node).eval();
  matrices.rigid = calc_rigid_motions(matrices.node_positions, matrices.full.mass, design.reference_node);
  try {
    matrices.factor = std::make_unique<StiffnessFactor>(matrices.free.stiffness);
  } catch (const IndefiniteStiffness& error) {
    refuse_indefinite(design, matrices, error.what());
  }
  matrices.free.factor = matrices.factor.get();
  matrices.free.rigid_share = calc_rigid_share(matrices.rigid);
  matrices.free.num_massless = (matrices.full.mass.diagonal().array() == 0.0).count();
  return matrices;
}

ModalProblem BodyMatrices::make_held() const {
  return {.stiffness = free.stiffness,
          .mass = free.mass,
          .factor = free.factor,
          .num_massless = free.size() - count_held_modes()};
}

fem::MassMoments make_mass_moments(const Design& design, const Eigen::Vector2d& origin) {
  return design.matrices ? calc_mass_moments(*design.matrices, origin)
                         : fem::calc_mass_moments(design.model, origin);
}

BodyBasis make_body_basis(const Design& design, const BodyMatrices& matrices,
                          const ClampedModeOptions& options) {
  require_elastic_motion(design, matrices);
  const StiffnessFactor& factor = *matrices.factor;
  const HeldRounding held = estimate_held_rounding(matrices);
  if (held.is_of_soft_reference() && held.error > kMaxHeldRounding)
    throw support::NumericalError(describe_soft_reference(design, matrices));
  try {
    return design.reduction.basis == BasisKind::kClamped
               ? make_clamped_basis(design, matrices, factor, held, options)
               : make_interface_basis(design, matrices, factor, held, options);
  } catch (const IndefiniteStiffness& error) {
    refuse_indefinite(design, matrices, error.what());
  }
}

Eigen::VectorXd calc_frequencies(const BodyBasis& basis) {
  Eigen::VectorXd frequency_hz(basis.cluster.size());
  for (ModeRange range; range.begin < frequency_hz.size(); range.begin = range.end) {
    range = find_cluster_of(basis.cluster, range.begin);
    const double mean = basis.stiffness.diagonal().segment(range.begin, range.size()).mean();
    frequency_hz.segment(range.begin, range.size()).setConstant(calc_frequency_hz(mean));
  }
  return frequency_hz;
}

}  // namespace sprung::reduce
