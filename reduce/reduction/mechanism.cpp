#include "reduce/reduction/mechanism.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fem/beam_element.h"
#include "reduce/matrices/matrix_body.h"
#include "reduce/modes/rounding_error.h"
#include "reduce/reduction/held_rounding.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr double kMostOfTheEnergy = 0.9;
constexpr double kMeasuredBelow = 1e-2;  // estimated errors up to which shapes are good enough to measure by

// How the second end of an element moves relative to its first end, which carries it along rigidly.
Eigen::Vector3d calc_relative_motion(const fem::Mesh& mesh, const fem::Mesh::Element& element,
                                     const Eigen::VectorXd& shape) {
  const Eigen::Vector2d along =
      mesh.node_positions.col(element.second) - mesh.node_positions.col(element.first);
  const Eigen::Vector3d first = shape.segment<3>(3 * element.first),
                        second = shape.segment<3>(3 * element.second);
  return second - first - first(2) * Eigen::Vector3d(-along.y(), along.x(), 0.0);
}

// Twice the strain energy of each element. What its ends do rigidly is taken out before its stiffness
// multiplies them, so that rounding does not grow with the cube of the number of elements.
Eigen::VectorXd calc_energies(const fem::BeamModel& model, const Eigen::VectorXd& shape) {
  Eigen::VectorXd energies(model.mesh.num_elements());
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const Eigen::Vector3d relative =
        calc_relative_motion(model.mesh, model.mesh.elements[static_cast<std::size_t>(e)], shape);
    const fem::Matrix6 stiffness = fem::calc_stiffness(fem::make_element(model, e));
    energies(e) = relative.dot(stiffness.bottomRightCorner<3, 3>() * relative);
  }
  return energies;
}

// Squares of what the ends of each element do that is no rigid motion, as displacements.
Eigen::VectorXd calc_deformations(const fem::Mesh& mesh, const Eigen::VectorXd& shape) {
  Eigen::VectorXd deformations(mesh.num_elements());
  for (int e = 0; e < mesh.num_elements(); ++e) {
    const fem::Mesh::Element& element = mesh.elements[static_cast<std::size_t>(e)];
    const Eigen::Vector3d relative = calc_relative_motion(mesh, element, shape);
    const double length =
        (mesh.node_positions.col(element.second) - mesh.node_positions.col(element.first)).norm();
    deformations(e) = relative.head<2>().squaredNorm() + std::pow(relative(2) * length, 2);
  }
  return deformations;
}

// The motion that nothing holds: by inverse iteration on K + τ diag(K), scaled to a largest entry of 1. Empty
// where even that has no factors, or something holds all motions.
Eigen::VectorXd find_loose_motion(const Eigen::SparseMatrix<double>& stiffness) {
  constexpr double kShift = 1e-10;
  constexpr int kIterations = 12;
  constexpr double kHeld = 1e-9;  // of the stiffness without the parts of opposite sign
  const Eigen::VectorXd diagonal = stiffness.diagonal().cwiseAbs();
  const Eigen::VectorXd scale = (diagonal.array() > 0.0).select(diagonal, diagonal.maxCoeff());
  Eigen::SparseMatrix<double> shifted = stiffness;
  shifted.diagonal() += kShift * scale;
  const auto factor = make_sparse_factor(shifted, true);
  if (factor == nullptr) return {};
  Eigen::VectorXd motion(scale.size());
  for (Eigen::Index i = 0; i < motion.size(); ++i) motion(i) = 1.0 + 0.5 * std::sin(static_cast<double>(i));
  for (int i = 0; i < kIterations; ++i) {
    motion = factor->solve(scale.cwiseProduct(motion)).col(0).eval();
    const double largest = motion.lpNorm<Eigen::Infinity>();
    if (!(largest > 0.0) || !std::isfinite(largest)) return {};
    motion /= largest;
  }
  if (motion.dot(stiffness * motion) > kHeld * motion.dot(scale.cwiseProduct(motion))) return {};
  return motion;
}

// The node that moves most, and how: where only rotations move, in rotation.
std::string describe_motion(const Design& design, const Eigen::VectorXd& shape) {
  constexpr double kNoDisplacement = 1e-6;
  const fem::Mesh& mesh = design.model.mesh;
  Eigen::Index largest[3], freedom = 0;
  double amplitude[3];
  for (Eigen::Index f = 0; f < 3; ++f)
    amplitude[f] = shape(Eigen::seqN(f, mesh.num_nodes(), 3)).cwiseAbs().maxCoeff(&largest[f]);
  freedom = amplitude[1] >= amplitude[0] ? 1 : 0;
  if (amplitude[freedom] <= kNoDisplacement * amplitude[2] * fem::calc_extent(mesh)) freedom = 2;
  const Eigen::VectorXd others = shape.tail(shape.size() - 3 * mesh.num_nodes());
  if (others.size() > 0 && others.cwiseAbs().maxCoeff() > std::max(amplitude[freedom], amplitude[2])) {
    Eigen::Index row = 0;
    others.cwiseAbs().maxCoeff(&row);
    return describe_freedom(*design.matrices, 3 * mesh.num_nodes() + row);
  }
  return fmt::format("{} {}", fem::describe_node(mesh, static_cast<int>(largest[freedom])),
                     freedom == 2   ? "in rotation"
                     : freedom == 1 ? "along y"
                                    : "along x");
}

}  // namespace

double check_rounding(const Design& design, const Eigen::SparseMatrix<double>& stiffness,
                      const EigenPairs& modes) {
  double error = -1.0;
  Eigen::Index worst = 0;
  for (Eigen::Index i = 0; i < modes.omega_squared.size(); ++i) {
    double found = estimate_rounding_error(stiffness, modes.vectors.col(i), modes.omega_squared(i));
    if (found > kMaxRoundingError && found <= kMeasuredBelow && !design.matrices) {
      const double energy = calc_energies(design.model, make_shapes(design, modes.vectors.col(i))).sum();
      found = std::abs(energy / modes.omega_squared(i) - 1.0);
    }
    if (found <= error) continue;
    error = found;
    worst = i;
  }
  if (error <= kMaxRoundingError) return error;
  const double frequency_hz = calc_frequency_hz(modes.omega_squared(worst));
  const Eigen::VectorXd energies = calc_energies(design.model, make_shapes(design, modes.vectors.col(worst)));
  Eigen::Index softest = 0;
  const double largest = energies.size() > 0 ? energies.maxCoeff(&softest) : 0.0;
  if (design.model.mesh.num_elements() > 2 && largest > kMostOfTheEnergy * energies.sum()) {
    const fem::Mesh& mesh = design.model.mesh;
    const fem::Mesh::Element& element = mesh.elements[static_cast<std::size_t>(softest)];
    throw support::NumericalError(
        fmt::format("the body has an internal mechanism: it gives way at {:.3g} Hz in the element of "
                    "section '{}' from {} to {}, so softly that rounding spoils the mode (relative error "
                    "of ω² {:.2g}, accepted is {:.0e}); make it two bodies with a joint, or stiffen the "
                    "section",
                    frequency_hz, mesh.section_names[static_cast<std::size_t>(element.section)],
                    fem::describe_node(mesh, element.first), fem::describe_node(mesh, element.second), error,
                    kMaxRoundingError));
  }
  throw support::NumericalError(fmt::format(
      "rounding spoils {} ({:.6g} Hz): its relative error in ω² is about {:.2g}, accepted "
      "is {:.0e}; refine the mesh less{} (the error grows with the fourth power of the number of elements)",
      worst == 0 ? "the lowest mode" : fmt::format("mode {}", worst + 1), frequency_hz, error,
      kMaxRoundingError, worst == 0 ? "" : " where this mode bends"));
}

void refuse_indefinite(const Design& design, const BodyMatrices& matrices, const std::string& reason) {
  constexpr double kAllOfTheBody = 1e-3;
  const Eigen::VectorXd held = find_loose_motion(matrices.free.stiffness);
  if (held.size() == 0) throw support::NumericalError(reason);
  const Eigen::VectorXd shape = make_shapes(design, held), bent = remove_momentum(matrices.rigid, shape);
  if (bent.dot(matrices.full.mass * bent) < kAllOfTheBody * shape.dot(matrices.full.mass * shape))
    throw support::NumericalError(describe_soft_reference(design, matrices));
  const fem::Mesh& mesh = design.model.mesh;
  const std::string motion = describe_motion(design, shape);
  Eigen::Index loosest = 0;
  const Eigen::VectorXd deformations = calc_deformations(mesh, shape);
  if (deformations.size() > 2 && deformations.maxCoeff(&loosest) > kMostOfTheEnergy * deformations.sum()) {
    const fem::Mesh::Element& element = mesh.elements[static_cast<std::size_t>(loosest)];
    throw support::NumericalError(fmt::format(
        "the body has an internal mechanism: it gives way without force in the element of section "
        "'{}' from {} to {}, and moves most at {}; make it two bodies with a joint, or stiffen the "
        "section",
        mesh.section_names[static_cast<std::size_t>(element.section)],
        fem::describe_node(mesh, element.first), fem::describe_node(mesh, element.second), motion));
  }
  throw support::NumericalError(fmt::format("{}; what nothing holds moves most at {}", reason, motion));
}

}  // namespace sprung::reduce
