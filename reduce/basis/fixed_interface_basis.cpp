#include "reduce/basis/fixed_interface_basis.h"

#include "reduce/modes/dense_eigen_solver.h"
#include "reduce/modes/held_node.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/dense/orthogonal_factors.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

using support::InputError;

constexpr double kSmallestHold = 1e-6;  // singular value of the rigid motions at an interface that holds
constexpr double kDependentVector =
    1e-10;  // eigenvalue of the Gram matrix below which a direction is dropped

// Freedoms of the frame: those of the interface, and the others.
struct Partition {
  std::vector<int> interface, inner;
  std::vector<int> place;  // of each freedom among its own
  std::vector<bool> is_interface;
};

Partition make_partition(Eigen::Index num_freedoms, const std::vector<InterfaceFreedom>& interface) {
  Partition partition;
  partition.is_interface.assign(static_cast<std::size_t>(num_freedoms), false);
  partition.place.resize(static_cast<std::size_t>(num_freedoms));
  for (const InterfaceFreedom& one : interface) {
    partition.is_interface[static_cast<std::size_t>(3 * one.node + one.freedom)] = true;
  }
  for (std::size_t i = 0; i < partition.is_interface.size(); ++i) {
    std::vector<int>& own = partition.is_interface[i] ? partition.interface : partition.inner;
    partition.place[i] = static_cast<int>(own.size());
    own.push_back(static_cast<int>(i));
  }
  return partition;
}

// Rows of the inner freedoms; columns of them, or of the interface.
Eigen::SparseMatrix<double> take_inner_rows(const Eigen::SparseMatrix<double>& matrix,
                                            const Partition& partition, bool interface_columns) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index column = 0; column < matrix.outerSize(); ++column) {
    if (partition.is_interface[static_cast<std::size_t>(column)] != interface_columns) continue;
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
      const auto row = static_cast<std::size_t>(entry.row());
      if (partition.is_interface[row]) continue;
      entries.emplace_back(partition.place[row], partition.place[static_cast<std::size_t>(column)],
                           entry.value());
    }
  }
  Eigen::SparseMatrix<double> result(
      static_cast<Eigen::Index>(partition.inner.size()),
      static_cast<Eigen::Index>((interface_columns ? partition.interface : partition.inner).size()));
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// Constraint modes, then the modes of the body held at its interface.
struct Components {
  Eigen::MatrixXd shapes;  // 3N×(b + q)
  Eigen::Index num_constraint = 0;
};

// Displacements of the interface, unit vectors, that complement its rigid motions. Rotation is measured by
// the body's radius.
Eigen::MatrixXd find_deformations(const Partition& partition, const RigidMotions& rigid,
                                  const support::SourceLocation& where) {
  Eigen::MatrixXd motion = rigid.shapes(partition.interface, Eigen::all);
  motion.col(2) /= rigid.shapes.col(2).cwiseAbs().maxCoeff();
  const support::SingularPairs pairs = support::calc_left_singular_pairs(motion);
  if (pairs.values.size() < 3 || !(pairs.values(2) > kSmallestHold * pairs.values(0))) {
    throw InputError(where,
                     "basis \"fixed-interface\": the interface freedoms do not hold the body, which still "
                     "moves as a whole; name more of them in [interface], or take the basis \"free\"");
  }
  return pairs.vectors.rightCols(pairs.vectors.cols() - 3);
}

Components make_components(const Eigen::SparseMatrix<double>& stiffness,
                           const Eigen::SparseMatrix<double>& mass, const Partition& partition,
                           const Eigen::MatrixXd& deformations, double highest_hz) {
  const Eigen::Index b = deformations.cols();
  Components components{.shapes = Eigen::MatrixXd::Zero(stiffness.rows(), b), .num_constraint = b};
  components.shapes(partition.interface, Eigen::all) = deformations;
  if (partition.inner.empty()) return components;
  ModalProblem held{.stiffness = take_inner_rows(stiffness, partition, false),
                    .mass = take_inner_rows(mass, partition, false)};
  const StiffnessFactor factor(held.stiffness);
  held.factor = &factor;
  held.num_massless = (held.mass.diagonal().array() == 0.0).count();
  const Eigen::MatrixXd loads = take_inner_rows(stiffness, partition, true) * deformations;
  if (b > 0) components.shapes(partition.inner, Eigen::all) = -factor.solve(loads);
  const ModesBelow modes = calc_modes_below(held, kBandMargin * highest_hz);
  const Eigen::Index q = modes.pairs.omega_squared.size();
  components.shapes.conservativeResize(Eigen::NoChange, b + q);
  components.shapes.rightCols(q).setZero();
  if (q > 0) components.shapes(partition.inner, Eigen::seqN(b, q)) = modes.pairs.vectors;
  return components;
}

// Combinations of the columns that are not dependent, as amplitudes of the columns.
Eigen::MatrixXd find_independent(const Eigen::MatrixXd& energy) {
  const Eigen::VectorXd scale = energy.diagonal().cwiseSqrt().cwiseInverse();
  const auto pairs = support::solve_symmetric(scale.asDiagonal() * energy * scale.asDiagonal());
  if (!pairs)
    throw support::NumericalError("basis \"fixed-interface\": its strain energy has no eigenvalues");
  const Eigen::Index dropped = (pairs->values.array() < kDependentVector).count();
  return scale.asDiagonal() * pairs->vectors.rightCols(energy.rows() - dropped);
}

// What holds most of a vector's strain energy; the constraint modes and the others share none.
std::vector<std::string> find_kinds(const Eigen::MatrixXd& amplitudes, const Eigen::MatrixXd& energy,
                                    Eigen::Index num_constraint) {
  std::vector<std::string> kinds;
  for (Eigen::Index i = 0; i < amplitudes.cols(); ++i) {
    const Eigen::VectorXd part = amplitudes.col(i).head(num_constraint);
    const double constraint = part.dot(energy.topLeftCorner(num_constraint, num_constraint) * part);
    const double all = amplitudes.col(i).dot(energy * amplitudes.col(i));
    kinds.emplace_back(constraint > 0.5 * all ? kConstraintVector : kFixedInterfaceVector);
  }
  return kinds;
}

}  // namespace

FreeBodyBasis make_fixed_interface_basis(const ModalProblem& problem, const StiffnessFactor& factor,
                                         const ModesBelow& modes, const BasisRequest& request,
                                         const RigidMotions& rigid,
                                         const Eigen::SparseMatrix<double>& stiffness,
                                         const Eigen::SparseMatrix<double>& mass) {
  const Partition partition = make_partition(stiffness.rows(), request.interface);
  const Components components = make_components(
      stiffness, mass, partition, find_deformations(partition, rigid, request.where), request.highest_hz);
  if (components.shapes.cols() == 0) {
    throw InputError(request.where,
                     "basis \"fixed-interface\": the body held at its interface has no mode in the band, and "
                     "the interface only holds it; ask for a higher highest_frequency");
  }
  const Eigen::MatrixXd at_reference = components.shapes.middleRows(3 * rigid.reference_node, 3);
  const Eigen::MatrixXd shapes =
      remove_node(Eigen::MatrixXd(components.shapes - rigid.shapes * at_reference), rigid.reference_node);
  const Eigen::MatrixXd energy = shapes.transpose() * (problem.stiffness * shapes);
  const Eigen::MatrixXd independent = find_independent(energy);
  const Eigen::MatrixXd directions = shapes * independent;
  const Eigen::MatrixXd K = directions.transpose() * (problem.stiffness * directions);
  const Eigen::MatrixXd M = directions.transpose() * problem.times_mass(directions);
  const EigenPairs ritz = solve_dense(0.5 * (K + K.transpose()), 0.5 * (M + M.transpose()));
  FreeBodyBasis basis;
  basis.vectors = {.omega_squared = ritz.omega_squared, .vectors = directions * ritz.vectors};
  basis.kind = find_kinds(independent * ritz.vectors, energy, components.num_constraint);
  InterfaceResidual residual(problem, factor, {}, request.loads);
  residual.add(basis.vectors.vectors);
  basis.certificate =
      calc_certificate(residual, {.interface = request.interface,
                                  .frame_loads = request.frame_loads,
                                  .highest_hz = request.highest_hz,
                                  .free_modes = modes.pairs,
                                  .next_omega_squared = modes.next_omega_squared,
                                  .is_complete = basis.vectors.vectors.cols() == problem.size(),
                                  .rounding = request.rounding});
  return basis;
}

}  // namespace sprung::reduce
