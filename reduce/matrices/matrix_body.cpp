#include "reduce/matrices/matrix_body.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "reduce/matrices/follower_rotation.h"
#include "reduce/matrices/linear_motions.h"
#include "reduce/matrices/modal_freedoms.h"
#include "reduce/matrices/printed_digits.h"
#include "tools/support/errors/input_error.h"

namespace sprung::reduce {

namespace {

using support::InputError;

constexpr double kOnThePlane = 1e-6;  // of the structure's extent
constexpr double kNoCoupling = 1e-6;  // of the two diagonals' geometric mean

// A node of the plane: one node on it, or two that are each other's mirror image.
struct PlaneNode {
  int first = 0;    // row of the table of nodes, with the lower number
  int second = -1;  // −1: it lies on the plane
};

// The structure's axes: two in the plane, and the third.
struct Frame {
  Eigen::Matrix3d axes;  // columns: first, second, normal
  Eigen::Vector3d local(const Eigen::Vector3d& v) const { return axes.transpose() * v; }
};

Frame make_frame(const PlanarAxes& axes) {
  Frame frame;
  frame.axes << axes.first, axes.second, axes.first.cross(axes.second);
  return frame;
}

// Rows of the table of nodes that have freedoms.
std::vector<int> find_used_nodes(const MatrixSystem& system) {
  std::set<std::int64_t> ids;
  for (int row = 0; row < system.freedoms.size(); ++row) {
    if (!system.freedoms[row].is_modal()) ids.insert(system.freedoms[row].node);
  }
  std::vector<int> used;
  for (const std::int64_t id : ids) {
    const auto found = std::lower_bound(system.nodes.ids.begin(), system.nodes.ids.end(), id);
    if (found == system.nodes.ids.end() || *found != id) {
      throw InputError({.path = system.stiffness_path},
                       fmt::format("node {} of the matrices is not in the table of nodes", id));
    }
    used.push_back(static_cast<int>(found - system.nodes.ids.begin()));
  }
  return used;
}

// Pairs the nodes that are off the plane in the middle.
class NodePairs {
 public:
  NodePairs(const MatrixSystem& system, const Frame& frame, const std::vector<int>& used) : system_(system) {
    Eigen::Matrix3Xd local(3, static_cast<Eigen::Index>(used.size()));
    for (std::size_t i = 0; i < used.size(); ++i)
      local.col(static_cast<Eigen::Index>(i)) = frame.local(system.nodes.positions.col(used[i]));
    const Eigen::Vector3d smallest = local.rowwise().minCoeff(), largest = local.rowwise().maxCoeff();
    tolerance_ = kOnThePlane * (largest - smallest).norm();
    local.row(2).array() -= 0.5 * (smallest.z() + largest.z());
    pair(local, used);
  }
  const std::vector<PlaneNode>& nodes() const { return nodes_; }

 private:
  void pair(const Eigen::Matrix3Xd& local, const std::vector<int>& used) {
    // Candidates on the other side by their x, where they are at most a tolerance apart.
    std::multimap<double, int> by_x;
    for (Eigen::Index i = 0; i < local.cols(); ++i) {
      if (local(2, i) < -tolerance_) by_x.emplace(local(0, i), static_cast<int>(i));
    }
    for (Eigen::Index i = 0; i < local.cols(); ++i) {
      const int row = used[static_cast<std::size_t>(i)];
      if (std::abs(local(2, i)) <= tolerance_) nodes_.push_back({row, -1});
      if (local(2, i) <= tolerance_) continue;
      const Eigen::Vector3d image(local(0, i), local(1, i), -local(2, i));
      auto found = by_x.lower_bound(image.x() - tolerance_);
      while (found != by_x.end() && (local.col(found->second) - image).norm() > tolerance_) {
        ++found;
        if (found != by_x.end() && found->first > image.x() + tolerance_) found = by_x.end();
      }
      if (found == by_x.end()) throw no_image(row);
      const int other = used[static_cast<std::size_t>(found->second)];
      nodes_.push_back({std::min(row, other), std::max(row, other)});
      by_x.erase(found);
    }
    if (!by_x.empty()) throw no_image(used[static_cast<std::size_t>(by_x.begin()->second)]);
    std::sort(nodes_.begin(), nodes_.end(),
              [](const PlaneNode& a, const PlaneNode& b) { return a.first < b.first; });
  }
  InputError no_image(int row) const {
    const Eigen::Vector3d at = system_.nodes.positions.col(row);
    return InputError(
        {.path = system_.stiffness_path},
        fmt::format("node {} at ({:.6g}, {:.6g}, {:.6g}) lies off the plane in the middle and has "
                    "no mirror image; the body must be symmetric about the plane of 'axes'",
                    system_.nodes.ids[static_cast<std::size_t>(row)], at.x(), at.y(), at.z()));
  }

  const MatrixSystem& system_;
  double tolerance_ = 0.0;
  std::vector<PlaneNode> nodes_;
};

// Symmetric motions T, and antisymmetric ones U (reduce/matrices, eq. 2), as columns.
struct Motions {
  Eigen::SparseMatrix<double> symmetric, antisymmetric;
  std::vector<bool> is_given;  // of the symmetric ones
  int num_pairs = 0;
  std::vector<std::int64_t> modal_ids;  // of the symmetric ones
};

class MotionMaker {
 public:
  MotionMaker(const MatrixSystem& system, const Frame& frame, const std::vector<PlaneNode>& nodes)
      : system_(system), frame_(frame), nodes_(nodes) {}

  Motions make() {
    const auto num_nodes = static_cast<int>(nodes_.size());
    int num_pairs = 0;
    for (int node = 0; node < num_nodes; ++node) {
      const PlaneNode& plane_node = nodes_[static_cast<std::size_t>(node)];
      const bool is_pair = plane_node.second >= 0;
      for (int axis = 0; axis < 3; ++axis) {
        const bool in_plane = axis < 2;
        add(plane_node, axis, false, in_plane, 3 * node + axis, 3 * (num_nodes + num_pairs));
        add(plane_node, axis, true, !in_plane, 3 * node + 2, 3 * (num_nodes + num_pairs) + 1 + axis);
      }
      if (is_pair) ++num_pairs;
    }
    Motions motions;
    int size = 3 * (num_nodes + num_pairs);
    fill(size, motions);
    add_modal(size, motions);
    if (!motions.modal_ids.empty()) fill(size, motions);
    motions.num_pairs = num_pairs;
    motions.is_given.assign(static_cast<std::size_t>(size), false);
    for (const Eigen::Triplet<double>& one : symmetric_)
      motions.is_given[static_cast<std::size_t>(one.col())] = true;
    return motions;
  }

 private:
  void fill(int size, Motions& motions) const {
    motions.symmetric.resize(system_.freedoms.size(), size);
    motions.symmetric.setFromTriplets(symmetric_.begin(), symmetric_.end());
    motions.antisymmetric.resize(system_.freedoms.size(), num_antisymmetric_);
    motions.antisymmetric.setFromTriplets(antisymmetric_.begin(), antisymmetric_.end());
  }
  // Modal freedoms behind the others, up to a multiple of 3.
  void add_modal(int& size, Motions& motions) {
    const ModalFreedoms modal = divide_modal_freedoms(system_, motions.symmetric, motions.antisymmetric);
    for (const ModalMotion& motion : modal.symmetric) {
      const int column = size + static_cast<int>(motions.modal_ids.size());
      for (const auto& [row, amplitude] : motion.parts) symmetric_.emplace_back(row, column, amplitude);
      motions.modal_ids.push_back(system_.freedoms[motion.row].node);
    }
    for (const ModalMotion& motion : modal.antisymmetric) {
      for (const auto& [row, amplitude] : motion.parts)
        antisymmetric_.emplace_back(row, num_antisymmetric_, amplitude);
      ++num_antisymmetric_;
    }
    size += 3 * ((static_cast<int>(motions.modal_ids.size()) + 2) / 3);
  }
  // A displacement along an axis of the plane's frame, or a rotation about it. `is_even`: mirrored nodes have
  // the same, so that it is a symmetric motion on the plane.
  void add(const PlaneNode& node, int axis, bool is_rotation, bool is_even, int even_column, int odd_column) {
    Eigen::Index direction = 0;
    frame_.axes.col(axis).cwiseAbs().maxCoeff(&direction);
    const double sign = frame_.axes(direction, axis);
    const int row = find_row(node.first, direction, is_rotation);
    if (node.second < 0) {
      if (row < 0) return;
      if (is_even) {
        symmetric_.emplace_back(row, even_column, sign);
      } else {
        antisymmetric_.emplace_back(row, num_antisymmetric_++, sign);
      }
      return;
    }
    const int other = find_row(node.second, direction, is_rotation);
    if ((row < 0) != (other < 0)) throw unlike_pair(node);
    if (row < 0) return;
    symmetric_.emplace_back(row, is_even ? even_column : odd_column, sign);
    symmetric_.emplace_back(other, is_even ? even_column : odd_column, is_even ? sign : -sign);
    antisymmetric_.emplace_back(row, num_antisymmetric_, sign);
    antisymmetric_.emplace_back(other, num_antisymmetric_++, is_even ? -sign : sign);
  }
  int find_row(int node, Eigen::Index direction, bool is_rotation) const {
    return system_.freedoms.find({id_of(node), static_cast<int>(direction) + (is_rotation ? 4 : 1)});
  }
  std::int64_t id_of(int node) const { return system_.nodes.ids[static_cast<std::size_t>(node)]; }
  InputError unlike_pair(const PlaneNode& node) const {
    return InputError({.path = system_.stiffness_path},
                      fmt::format("nodes {} and {} are each other's mirror image, but have other freedoms",
                                  id_of(node.first), id_of(node.second)));
  }

  const MatrixSystem& system_;
  const Frame& frame_;
  const std::vector<PlaneNode>& nodes_;
  std::vector<Eigen::Triplet<double>> symmetric_, antisymmetric_;
  int num_antisymmetric_ = 0;
};

// The freedom of space that a motion moves first.
Freedom find_freedom(const MatrixSystem& system, const Eigen::SparseMatrix<double>& motions,
                     Eigen::Index column) {
  const Eigen::SparseMatrix<double>::InnerIterator entry(motions, column);
  return system.freedoms[static_cast<int>(entry.row())];
}

void check_coupling(const MatrixSystem& system, const Motions& motions,
                    const Eigen::SparseMatrix<double>& matrix, const std::string& path) {
  const Eigen::SparseMatrix<double> of_even = motions.symmetric.transpose() * matrix * motions.symmetric;
  const Eigen::SparseMatrix<double> of_odd =
      motions.antisymmetric.transpose() * matrix * motions.antisymmetric;
  const Eigen::SparseMatrix<double> coupling = motions.symmetric.transpose() * matrix * motions.antisymmetric;
  const Eigen::VectorXd even = of_even.diagonal(), odd = of_odd.diagonal();
  for (Eigen::Index column = 0; column < coupling.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(coupling, column); entry; ++entry) {
      const double scale = std::sqrt(std::abs(even(entry.row()) * odd(column)));
      if (std::abs(entry.value()) <= kNoCoupling * scale) continue;
      throw InputError(
          {.path = path},
          fmt::format(
              "the body is not symmetric about the plane: the motion in it ({}) and the motion out of it "
              "({}) are coupled by {:.3g} of their diagonal entries",
              describe(find_freedom(system, motions.symmetric, entry.row())),
              describe(find_freedom(system, motions.antisymmetric, column)),
              std::abs(entry.value()) / scale));
    }
  }
}

// Matrices in SI units: energies agree, displacements are multiplied by the unit of length (reduce/matrices,
// eq. 3).
Eigen::SparseMatrix<double> project(const Motions& motions, const Eigen::SparseMatrix<double>& matrix,
                                    const Eigen::VectorXd& scale, double energy) {
  const Eigen::SparseMatrix<double> T = motions.symmetric * scale.asDiagonal();
  Eigen::SparseMatrix<double> projected = energy * (T.transpose() * matrix * T);
  projected =
      Eigen::SparseMatrix<double>(0.5 * (projected + Eigen::SparseMatrix<double>(projected.transpose())));
  projected.prune(0.0, 0.0);
  return projected;
}

// |T|ᵀ |K| |T| |R| by the rounding of the entries, and for rotations by that of the places.
Eigen::MatrixXd calc_rounding(const Motions& motions, const MatrixSystem& system, const MatrixBody& body,
                              const Eigen::VectorXd& scale, double energy) {
  const double of_entries = estimate_rounding(system.stiffness.coeffs());
  const double of_places = estimate_rounding(system.nodes.positions.reshaped());
  const LinearMotions about = make_linear_motions(body, calc_middle(body));
  Eigen::MatrixXd R(scale.size(), 3);
  R << of_entries * about.along_x, of_entries * about.along_y, of_entries * about.rotation.cwiseAbs();
  // The place along y moves x in rotation, and the place along x moves y.
  for (int node = 0; node < body.num_nodes(); ++node) {
    const Eigen::Vector2d place = body.node_positions.col(node).cwiseAbs();
    R.block<2, 1>(3 * node, 2) += of_places * Eigen::Vector2d(place.y(), place.x());
  }
  const Eigen::SparseMatrix<double> T = motions.symmetric.cwiseAbs();
  return energy * (scale.asDiagonal() *
                   (T.transpose() * (system.stiffness.cwiseAbs() * (T * (scale.asDiagonal() * R)))));
}

void require_displacements(const MatrixBody& body) {
  for (int node = 0; node < body.num_nodes(); ++node) {
    for (int axis = 0; axis < 2; ++axis) {
      if (body.is_given[static_cast<std::size_t>(3 * node + axis)]) continue;
      throw InputError({.path = body.stiffness_path},
                       fmt::format("{} is missing, as if a boundary condition held it; write the matrices of "
                                   "the free body",
                                   describe_freedom(body, 3 * node + axis)));
    }
  }
}

}  // namespace

std::string describe_freedom(const MatrixBody& body, Eigen::Index freedom) {
  const Eigen::Index node = freedom / 3;
  const Eigen::Index first_modal = 3 * (body.num_nodes() + body.num_pairs);
  if (freedom >= first_modal) {
    const auto index = static_cast<std::size_t>(freedom - first_modal);
    return index < body.modal_ids.size() ? fmt::format("modal freedom {}", body.modal_ids[index])
                                         : std::string("a freedom without meaning");
  }
  if (node >= body.num_nodes()) {
    constexpr const char* kAcross[] = {"the motion across the plane", "the rotation about x",
                                       "the rotation about y"};
    return fmt::format("{} of mirrored pair {}", kAcross[freedom % 3], node - body.num_nodes() + 1);
  }
  constexpr const char* kInPlane[] = {"x", "y", "the rotation"};
  return fmt::format("{} of node {}", kInPlane[freedom % 3], body.node_ids[static_cast<std::size_t>(node)]);
}

MatrixBody make_matrix_body(const MatrixSystem& system, const PlanarAxes& axes, const MatrixUnits& units) {
  const Frame frame = make_frame(axes);
  const std::vector<PlaneNode> nodes = NodePairs(system, frame, find_used_nodes(system)).nodes();
  const Motions motions = MotionMaker(system, frame, nodes).make();
  check_coupling(system, motions, system.stiffness, system.stiffness_path);
  check_coupling(system, motions, system.mass, system.mass_path);

  MatrixBody body{.node_ids = {},
                  .node_positions = Eigen::Matrix2Xd(2, static_cast<Eigen::Index>(nodes.size())),
                  .stiffness = {},
                  .mass = {},
                  .is_given = motions.is_given,
                  .num_pairs = motions.num_pairs,
                  .modal_ids = motions.modal_ids,
                  .is_reduced = !motions.modal_ids.empty(),
                  .rounding = {},
                  .ground = {},
                  .stiffness_path = system.stiffness_path,
                  .mass_path = system.mass_path,
                  .remarks = {}};
  for (const PlaneNode& node : nodes) {
    body.node_positions.col(static_cast<Eigen::Index>(body.node_ids.size())) =
        units.length * frame.local(system.nodes.positions.col(node.first)).head<2>();
    body.node_ids.push_back(system.nodes.ids[static_cast<std::size_t>(node.first)]);
  }
  require_displacements(body);
  Eigen::VectorXd scale = Eigen::VectorXd::Constant(motions.symmetric.cols(), 1.0 / units.length);
  const Eigen::Index num_in_plane = 3 * body.num_nodes(), first_modal = num_in_plane + 3 * body.num_pairs;
  for (Eigen::Index i = 0; i < scale.size(); ++i) {
    const bool is_rotation = i < num_in_plane ? i % 3 == 2 : i % 3 != 0;
    if (is_rotation || i >= first_modal) scale(i) = 1.0;
  }
  const double energy = units.mass * units.length * units.length;
  body.stiffness = project(motions, system.stiffness, scale, energy);
  body.mass = project(motions, system.mass, scale, energy);
  body.rounding = calc_rounding(motions, system, body, scale, energy);
  hold_missing_freedoms(body);
  return body;
}

}  // namespace sprung::reduce
