#include "reduce/matrices/body_checks.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "reduce/matrices/linear_motions.h"

namespace sprung::reduce {

namespace {

using support::InputError;

constexpr std::size_t kMostListed = 6;  // freedoms in a message
// Of what the entries of a row would add up to if none cancelled. Files of eight columns have six digits.
constexpr double kRigidForce = 2e-5;
constexpr double kRounding = 1e-9;       // of entries, of those that their places in the matrix let expect
constexpr double kSmallestMass = 1e-9;   // of a mass matrix scaled to unit diagonal, to rounding of files
constexpr double kMassTolerance = 1e-5;  // of the mass, and of mass times the body's extent
constexpr double kLargestRadius = 3.0;   // of gyration about the middle, of the extent

std::string list_freedoms(const MatrixBody& body, const std::vector<Eigen::Index>& freedoms) {
  std::string text;
  for (std::size_t i = 0; i < std::min(freedoms.size(), kMostListed); ++i)
    text += (i == 0 ? "" : ", ") + describe_freedom(body, freedoms[i]);
  if (freedoms.size() > kMostListed) text += fmt::format(" and {} more", freedoms.size() - kMostListed);
  return text;
}

void require_stiffness(const MatrixBody& body) {
  std::vector<Eigen::Index> without;
  const Eigen::VectorXd diagonal = body.stiffness.diagonal();
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    if (!(diagonal(i) > 0.0)) without.push_back(i);
  }
  if (without.empty()) return;
  throw InputError({.path = body.stiffness_path},
                   fmt::format("no stiffness acts on {} freedom{}: {}", without.size(),
                               without.size() == 1 ? "" : "s", list_freedoms(body, without)));
}

// Nodes that the stiffness connects have one number.
std::vector<int> find_parts(const MatrixBody& body) {
  std::vector<int> part(static_cast<std::size_t>(body.num_nodes()));
  std::iota(part.begin(), part.end(), 0);
  const auto root = [&](int node) {
    while (part[static_cast<std::size_t>(node)] != node) {
      part[static_cast<std::size_t>(node)] =
          part[static_cast<std::size_t>(part[static_cast<std::size_t>(node)])];
      node = part[static_cast<std::size_t>(node)];
    }
    return node;
  };
  for (Eigen::Index column = 0; column < 3 * body.num_nodes(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(body.stiffness, column); entry; ++entry) {
      if (entry.row() >= 3 * body.num_nodes()) continue;
      part[static_cast<std::size_t>(root(static_cast<int>(entry.row() / 3)))] =
          root(static_cast<int>(column / 3));
    }
  }
  for (int node = 0; node < body.num_nodes(); ++node) part[static_cast<std::size_t>(node)] = root(node);
  return part;
}

void require_one_part(const MatrixBody& body) {
  const std::vector<int> part = find_parts(body);
  for (std::size_t node = 0; node < part.size(); ++node) {
    if (part[node] == part[0]) continue;
    throw InputError({.path = body.stiffness_path},
                     fmt::format("the body is in parts: nothing connects node {} with node {}",
                                 body.node_ids[node], body.node_ids[0]));
  }
}

// How large the entries of the stiffness are. What couples a modal freedom with others is zero but for
// rounding, and its size is that of the two diagonals. Where entries of both sides of the plane cancel, the
// rounding of the file is left.
Eigen::SparseMatrix<double> calc_entry_sizes(const MatrixBody& body) {
  Eigen::SparseMatrix<double> sizes = body.stiffness.cwiseAbs();
  const Eigen::VectorXd diagonal = body.stiffness.diagonal();
  const Eigen::Index first_modal = 3 * (body.num_nodes() + body.num_pairs);
  for (Eigen::Index column = 0; column < sizes.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(sizes, column); entry; ++entry) {
      const double of_diagonals = std::sqrt(diagonal(entry.row()) * diagonal(column));
      const bool is_modal = std::max(entry.row(), column) >= first_modal;
      entry.valueRef() =
          is_modal ? of_diagonals : std::max(entry.value(), kRounding / kRigidForce * of_diagonals);
    }
  }
  return sizes;
}

// Motions along x, along y, and rotation.
void require_no_rigid_force(const MatrixBody& body) {
  constexpr const char* kMotions[] = {"displacement along x", "displacement along y", "rotation"};
  const LinearMotions motions = make_linear_motions(body, calc_middle(body));
  const Eigen::SparseMatrix<double> sizes = calc_entry_sizes(body);
  const Eigen::VectorXd shapes[] = {motions.along_x, motions.along_y, motions.rotation};
  for (int motion = 0; motion < 3; ++motion) {
    const Eigen::VectorXd force = (body.stiffness * shapes[motion]).cwiseAbs();
    const Eigen::VectorXd scale = sizes * shapes[motion].cwiseAbs();
    std::vector<Eigen::Index> wrong;
    for (Eigen::Index i = 0; i < force.size(); ++i) {
      if (force(i) > kRigidForce * scale(i)) wrong.push_back(i);
    }
    if (wrong.empty()) continue;
    std::stable_sort(wrong.begin(), wrong.end(), [&](Eigen::Index a, Eigen::Index b) {
      return force(a) * scale(b) > force(b) * scale(a);
    });
    const Eigen::Index worst = wrong.front();
    throw InputError(
        {.path = body.stiffness_path},
        fmt::format(
            "the stiffness resists a rigid {}: {} freedom{} get{} a force, by {:.2g} of the forces of "
            "single entries at most, at {}; boundary conditions, springs to the ground, other places of "
            "the nodes or other units are usual causes",
            kMotions[motion], wrong.size(), wrong.size() == 1 ? "" : "s", wrong.size() == 1 ? "s" : "",
            force(worst) / scale(worst), list_freedoms(body, wrong)));
  }
}

// Where a row has mass, its diagonal is the largest part of it.
void require_no_lone_coupling(const MatrixBody& body) {
  const Eigen::VectorXd diagonal = body.mass.diagonal();
  for (Eigen::Index column = 0; column < body.mass.outerSize(); ++column) {
    if (diagonal(column) != 0.0) continue;
    for (Eigen::SparseMatrix<double>::InnerIterator entry(body.mass, column); entry; ++entry) {
      if (std::abs(entry.value()) <= kRounding * diagonal(entry.row())) continue;
      throw InputError(
          {.path = body.mass_path},
          fmt::format("the mass couples {} with {} by {:.6g}, but {} itself has none: the matrix "
                      "is not positive definite; a part of the file may be missing",
                      describe_freedom(body, column), describe_freedom(body, entry.row()), entry.value(),
                      describe_freedom(body, column)));
    }
  }
}

// @return freedoms without mass
std::vector<Eigen::Index> require_definite_mass(const MatrixBody& body) {
  const Eigen::VectorXd diagonal = body.mass.diagonal();
  std::vector<Eigen::Index> without, negative;
  std::vector<Eigen::Triplet<double>> filled;
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    if (diagonal(i) < 0.0) negative.push_back(i);
    if (diagonal(i) == 0.0) without.push_back(i);
    if (diagonal(i) == 0.0) filled.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
  }
  if (!negative.empty()) {
    throw InputError({.path = body.mass_path},
                     fmt::format("the mass is negative at {}", list_freedoms(body, negative)));
  }
  require_no_lone_coupling(body);
  Eigen::SparseMatrix<double> mass(diagonal.size(), diagonal.size());
  mass.setFromTriplets(filled.begin(), filled.end());
  mass += body.mass;
  const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> scaled = scale.asDiagonal() * mass * scale.asDiagonal();
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor(scaled);
  if (factor.info() == Eigen::Success) return without;
  factor.setShift(kSmallestMass);
  factor.compute(scaled);
  if (factor.info() != Eigen::Success) {
    throw InputError({.path = body.mass_path}, "the mass matrix is not positive definite");
  }
  throw InputError({.path = body.mass_path},
                   "the mass matrix is singular: a motion of several freedoms has no mass, as where elements "
                   "have more shapes than points of integration; use other elements, or lumped masses");
}

// A displacement of all nodes along x meets the same mass as one along y, and moments of it agree with the
// places of the nodes.
void require_mass_of_a_body(const MatrixBody& body) {
  const LinearMotions motions = make_linear_motions(body, calc_middle(body));
  const Eigen::VectorXd Mx = body.mass * motions.along_x, My = body.mass * motions.along_y;
  const double mass = Mx.dot(motions.along_x), along_y = My.dot(motions.along_y);
  const support::SourceLocation where{.path = body.mass_path};
  if (!(mass > 0.0)) throw InputError(where, fmt::format("the body's mass is {:.6g} kg, expected > 0", mass));
  if (std::abs(mass - along_y) > kMassTolerance * mass ||
      std::abs(Mx.dot(motions.along_y)) > kMassTolerance * mass) {
    throw InputError(where,
                     fmt::format("the body's mass is {:.9g} kg along x and {:.9g} kg along y (and couples "
                                 "them by {:.3g} kg); a body has one mass",
                                 mass, along_y, Mx.dot(motions.along_y)));
  }
  const double extent =
      (body.node_positions.rowwise().maxCoeff() - body.node_positions.rowwise().minCoeff()).norm();
  const double radius = std::sqrt(std::max(motions.rotation.dot(body.mass * motions.rotation), 0.0) / mass);
  if (radius > kLargestRadius * extent) {
    throw InputError(
        where,
        fmt::format("the body's mass is {:.6g} kg, and its radius of gyration {:.3g} m, though its nodes are "
                    "within {:.3g} m; masses and moments of inertia in different units, or in units "
                    "that are not those of the nodes, are usual causes",
                    mass, radius, extent));
  }
  if (body.is_reduced) return;
  const double by_rotation = My.dot(motions.rotation), by_places = Mx.dot(motions.places);
  const double y_by_rotation = -Mx.dot(motions.rotation), y_by_places = My.dot(motions.places);
  if (std::max(std::abs(by_rotation - by_places), std::abs(y_by_rotation - y_by_places)) >
      kMassTolerance * mass * extent) {
    throw InputError(
        where,
        fmt::format("mass and places of the nodes do not fit together: the first moments are "
                    "({:.6g}, {:.6g}) by rotation and ({:.6g}, {:.6g}) kg·m by displacement; matrices of a "
                    "condensed body need 'reduced = true'",
                    by_rotation, y_by_rotation, by_places, y_by_places));
  }
}

}  // namespace

std::vector<std::string> check_matrix_body(const MatrixBody& body) {
  require_stiffness(body);
  require_one_part(body);
  require_no_rigid_force(body);
  std::vector<Eigen::Index> without = require_definite_mass(body);
  require_mass_of_a_body(body);
  const auto is_added = [&](Eigen::Index i) { return !body.is_given[static_cast<std::size_t>(i)]; };
  without.erase(std::remove_if(without.begin(), without.end(), is_added), without.end());
  if (without.empty()) return {};
  return {fmt::format("{} freedom{} no mass: {}", without.size(), without.size() == 1 ? " has" : "s have",
                      list_freedoms(body, without))};
}

void check_expected_mass(const MatrixBody& body, const ExpectedMass& expected) {
  const LinearMotions motions = make_linear_motions(body, Eigen::Vector2d::Zero());
  const Eigen::VectorXd rotated = body.mass * motions.rotation;
  const double mass = motions.along_x.dot(body.mass * motions.along_x);
  const Eigen::Vector2d centre =
      Eigen::Vector2d(motions.along_y.dot(rotated), 0.0 - motions.along_x.dot(rotated)) / mass;
  const double inertia = motions.rotation.dot(rotated) - mass * centre.squaredNorm();
  const double radius = std::sqrt(std::max(inertia, 0.0) / mass);
  if (expected.mass && std::abs(mass / *expected.mass - 1.0) > expected.tolerance) {
    throw InputError(expected.where, fmt::format("the matrices have the mass {:.6g} kg, expected {:.6g} kg",
                                                 mass, *expected.mass));
  }
  if (expected.centre && (centre - *expected.centre).norm() > expected.tolerance * radius) {
    throw InputError(expected.where,
                     fmt::format("the matrices have the centre of mass ({:.6g}, {:.6g}) m, expected "
                                 "({:.6g}, {:.6g}) m",
                                 centre.x(), centre.y(), expected.centre->x(), expected.centre->y()));
  }
  if (expected.inertia && std::abs(inertia / *expected.inertia - 1.0) > expected.tolerance) {
    throw InputError(
        expected.where,
        fmt::format("the matrices have the moment of inertia {:.6g} kg·m² about the centre of mass, "
                    "expected {:.6g} kg·m²",
                    inertia, *expected.inertia));
  }
}

}  // namespace sprung::reduce
