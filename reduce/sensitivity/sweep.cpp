#include "reduce/sensitivity/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reduce/modes/clusters.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/dense/orthogonal_factors.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr double kSureCorrelation = 0.9;
constexpr int kMostHalvings = 6;
constexpr double kPartOfCluster = 0.1;  // least singular value for modes that continue in a cluster
constexpr int kGuards = 6;              // modes beyond those followed, which may come down to them
constexpr double kSamePlace = 1e-12;    // relative
constexpr int kPreviewModes = 4;        // times the modes followed, of which a preview is made

// A body for one value, with its modes.
struct SweptBody {
  double value = 0.0;
  BodyMatrices matrices;
  BodyModes free, clamped;
};

SweptBody make_body(const SweepOptions& options, double value) {
  DesignSource source = options.design;
  source.varied = fmt::format("{}={:.17g}", options.key, value);
  const Design design = read_design(source);
  SweptBody body{.value = value, .matrices = make_body_matrices(design), .free = {}, .clamped = {}};
  const int computed = (options.is_preview ? kPreviewModes : 1) * options.num_modes + kGuards;
  body.free = calc_body_modes(design, body.matrices, true, computed);
  body.clamped = calc_body_modes(design, body.matrices, false, computed);
  return body;
}

// Modes in the space of given shapes, by the matrices of a changed body: without its rigid motions, which
// come first in the space.
BodyModes calc_ritz_modes(const fem::AssembledMatrices& full, const Eigen::MatrixXd& space,
                          Eigen::Index num_rigid) {
  const Eigen::MatrixXd mass = space.transpose() * (full.mass * space);
  const Eigen::MatrixXd stiffness = space.transpose() * (full.stiffness * space);
  const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt().cwiseInverse();
  const auto pairs = support::solve_undamped(scale.asDiagonal() * stiffness * scale.asDiagonal(),
                                             scale.asDiagonal() * mass * scale.asDiagonal());
  if (!pairs) throw support::NumericalError("sweep: the shapes of the first value have no modes together");
  const Eigen::Index n = space.cols() - num_rigid;
  BodyModes modes{.omega_squared = pairs->values.tail(n),
                  .shapes = space * (scale.asDiagonal() * pairs->vectors.rightCols(n)),
                  .cluster = {}};
  modes.cluster = find_clusters(modes.omega_squared);
  return modes;
}

// A body for another value, by the modes of the first one.
SweptBody preview_body(const SweepOptions& options, const SweptBody& first, double value) {
  DesignSource source = options.design;
  source.varied = fmt::format("{}={:.17g}", options.key, value);
  const Design design = read_design(source);
  SweptBody body{.value = value, .matrices = {}, .free = {}, .clamped = {}};
  body.matrices.full = make_full_matrices(design);
  if (body.matrices.full.mass.rows() != first.free.shapes.rows()) return body;  // refused by the caller
  const Eigen::Matrix2Xd& positions = design.model.mesh.node_positions;
  if (!design.model.couplings.empty()) {
    throw support::InputError({.path = options.design.path.string()},
                              "has points that follow others; leave out '--preview'");
  }
  body.matrices.node_positions = positions.colwise() - positions.col(design.reference_node).eval();
  if (!body.matrices.node_positions.isApprox(first.matrices.node_positions, kSamePlace)) {
    throw support::InputError({.path = options.design.path.string()},
                              fmt::format("'{}' = {:.6g} moves nodes, where the shapes of the first value do "
                                          "not fit; a preview is for sections, materials and masses",
                                          options.key, value));
  }
  body.matrices.rigid =
      calc_rigid_motions(body.matrices.node_positions, body.matrices.full.mass, design.reference_node);
  Eigen::MatrixXd space(first.free.shapes.rows(), 3 + first.free.shapes.cols());
  space << body.matrices.rigid.shapes, first.free.shapes;
  body.free = calc_ritz_modes(body.matrices.full, space, 3);
  body.clamped = calc_ritz_modes(body.matrices.full, first.clamped.shapes, 0);
  return body;
}

TrackedModes begin_modes(const BodyModes& modes, int num_modes) {
  const Eigen::Index n = std::min<Eigen::Index>(num_modes, modes.omega_squared.size());
  return {.hz = modes.calc_hz().head(n),
          .correlation = Eigen::VectorXd::Ones(n),
          .shapes = modes.shapes.leftCols(n)};
}

SweepPoint make_point(const SweptBody& body, TrackedModes free, TrackedModes clamped) {
  const Eigen::Matrix3d& mass = body.matrices.rigid.mass;
  const Eigen::Vector2d first = mass.block<2, 1>(0, 2);
  return {.value = body.value,
          .free = std::move(free),
          .clamped = std::move(clamped),
          .mass = mass(0, 0),
          .inertia = mass(2, 2) - first.squaredNorm() / mass(0, 0)};
}

// From a point to a value; by halves where a mode could be mistaken for another.
SweepPoint continue_to(const SweepOptions& options, const SweptBody& first, const SweepPoint& from,
                       double value, int halvings) {
  const SweptBody body = options.is_preview ? preview_body(options, first, value) : make_body(options, value);
  if (body.matrices.full.mass.rows() != from.free.shapes.rows()) {
    throw support::InputError({.path = options.design.path.string()},
                              fmt::format("'{}' = {:.6g} gives the frame another number of nodes, so that "
                                          "its modes cannot be followed",
                                          options.key, value));
  }
  TrackedModes free = continue_modes(from.free, body.free, body.matrices.full.mass);
  TrackedModes clamped = continue_modes(from.clamped, body.clamped, body.matrices.full.mass);
  const double least = std::min(free.correlation.minCoeff(), clamped.correlation.minCoeff());
  if (least >= kSureCorrelation || halvings == 0)
    return make_point(body, std::move(free), std::move(clamped));
  const SweepPoint middle = continue_to(options, first, from, 0.5 * (from.value + value), halvings - 1);
  return continue_to(options, first, middle, value, halvings - 1);
}

// The basis of a cluster that is nearest to the modes that continue in it most.
Eigen::MatrixXd rotate_cluster(const Eigen::MatrixXd& correlation) {
  const Eigen::Index k = correlation.cols();
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(correlation.rows()));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<Eigen::Index>(i);
  const Eigen::VectorXd norms = correlation.rowwise().norm();
  std::stable_sort(rows.begin(), rows.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return norms(a) > norms(b); });
  rows.resize(static_cast<std::size_t>(std::min(k, correlation.rows())));
  const Eigen::MatrixXd nearest = correlation(rows, Eigen::all);
  // A = U S Vᵀ: A V Uᵀ is symmetric and not negative. With fewer rows than k the rest of V completes the
  // basis.
  const support::SingularPairs right = support::calc_left_singular_pairs(nearest.transpose());
  if (right.values.minCoeff() < kPartOfCluster) return right.vectors;
  const Eigen::Index num_rows = nearest.rows();
  const Eigen::MatrixXd V = right.vectors.leftCols(num_rows);
  const Eigen::MatrixXd U = nearest * V * right.values.cwiseInverse().asDiagonal();
  Eigen::MatrixXd rotation = right.vectors;
  rotation.leftCols(num_rows) = V * U.transpose();
  return rotation;
}

}  // namespace

TrackedModes continue_modes(const TrackedModes& from, const BodyModes& modes,
                            const Eigen::SparseMatrix<double>& mass) {
  const Eigen::MatrixXd momenta = mass * from.shapes;
  Eigen::MatrixXd shapes = modes.shapes;
  Eigen::MatrixXd correlation = momenta.transpose() * shapes;
  for (ModeRange range; range.begin < shapes.cols(); range.begin = range.end) {
    range = find_cluster_of(modes.cluster, range.begin);
    if (range.size() == 1) continue;
    const Eigen::MatrixXd rotation = rotate_cluster(correlation.middleCols(range.begin, range.size()));
    shapes.middleCols(range.begin, range.size()) =
        (shapes.middleCols(range.begin, range.size()) * rotation).eval();
    correlation.middleCols(range.begin, range.size()) =
        (correlation.middleCols(range.begin, range.size()) * rotation).eval();
  }
  const Eigen::VectorXd hz = modes.calc_hz();
  const Eigen::Index n = from.hz.size();
  // The modes given are those of another mass, so that their norms differ from 1.
  const Eigen::VectorXd norms = from.shapes.cwiseProduct(momenta).colwise().sum().cwiseSqrt();
  Eigen::MatrixXd open = norms.cwiseInverse().asDiagonal() * correlation.cwiseAbs();
  std::vector<bool> is_followed(static_cast<std::size_t>(hz.size()), false);
  TrackedModes to{.hz = Eigen::VectorXd(n), .correlation = Eigen::VectorXd(n), .shapes = from.shapes};
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index mode = 0, found = 0;
    const double largest = open.maxCoeff(&mode, &found);
    to.hz(mode) = hz(found);
    to.correlation(mode) = largest;
    to.shapes.col(mode) = (correlation(mode, found) < 0.0 ? -1.0 : 1.0) * shapes.col(found);
    open.row(mode).setConstant(-1.0);
    open.col(found).setConstant(-1.0);
    is_followed[static_cast<std::size_t>(found)] = true;
  }
  constexpr double kLower = 1.0 - 1e-6;  // by more than the members of a cluster differ
  for (Eigen::Index j = 0; j < hz.size(); ++j)
    to.is_passed |= !is_followed[static_cast<std::size_t>(j)] && hz(j) < kLower * to.hz.maxCoeff();
  return to;
}

std::vector<SweepPoint> calc_sweep(const SweepOptions& options) {
  if (options.values.empty()) return {};
  const SweptBody first = make_body(options, options.values.front());
  std::vector<SweepPoint> points{make_point(first, begin_modes(first.free, options.num_modes),
                                            begin_modes(first.clamped, options.num_modes))};
  for (std::size_t i = 1; i < options.values.size(); ++i)
    points.push_back(continue_to(options, first, points.back(), options.values[i], kMostHalvings));
  return points;
}

}  // namespace sprung::reduce
