#include "dynamics/adaptivity/full_small_motion.h"

#include <algorithm>
#include <numeric>

#include "dynamics/system/partitioned_equations.h"
#include "tools/support/dense/dense_solvers.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kLeastPivot = 1e-6;  // of the largest entry

// A T, with T the identity but for one row.
void multiply_by_row(Eigen::MatrixXd& A, Eigen::Index place, const Eigen::RowVectorXd& row) {
  const Eigen::VectorXd column = A.col(place);
  A.col(place).setZero();
  A.noalias() += column * row;
}

// Tᵀ A T.
void multiply_on_both_sides(Eigen::MatrixXd& A, Eigen::Index place, const Eigen::RowVectorXd& row) {
  multiply_by_row(A, place, row);
  const Eigen::RowVectorXd of_place = A.row(place);
  A.row(place).setZero();
  A.noalias() += row.transpose() * of_place;
}

}  // namespace

FullSmallMotion::FullSmallMotion(const Model& full, double time, const Eigen::VectorXd& q,
                                 const std::vector<int>& points, const LinearisedSystem* linearised)
    : full_(&full) {
  for (const Body& body : full.bodies) {
    for (int k = 0; k < body.num_modes(); ++k) modal_.push_back(body.first_coordinate + 3 + k);
  }
  Eigen::MatrixXd directions;
  try {
    std::optional<LinearisedSystem> found;
    if (!linearised) {
      PartitionedEquations equations(full);
      linearised = &found.emplace(linearise(equations, time, q));
    }
    if (!support::is_positive_definite(linearised->mass))
      throw support::NumericalError("the mass of small motion is singular");
    independent_ = linearised->partition.independent;
    motion_ = {linearised->mass, linearised->damping, linearised->stiffness};
    stiffness_rounding_ = linearised->stiffness_rounding;
    known_ = {independent_, motion_};
    directions = linearised->directions;
    for (const int coordinate : modal_) make_independent(coordinate, directions);
    sort_coordinates(directions);
    modal_motion_ = directions(modal_, Eigen::all);
  } catch (const support::NumericalError&) {
    // Near a singular position, or with masses that rounding makes singular: no small motion.
  }

  SystemTerms terms(full);
  terms.update_positions(time, q);
  for (const int i : points) {
    const Marker& marker = full.markers[static_cast<std::size_t>(i)];
    Eigen::Matrix2Xd motion = Eigen::Matrix2Xd::Zero(2, full.num_coordinates);
    if (marker.body != kGround) {
      const Body& body = full.bodies[static_cast<std::size_t>(marker.body)];
      const MarkerState& state = terms.markers()[static_cast<std::size_t>(i)];
      motion.block<2, 2>(0, body.first_coordinate).setIdentity();
      motion.col(body.first_coordinate + 2) = state.r_theta;
      motion.middleCols(body.first_coordinate + 3, body.num_modes()) = state.r_eta();
    }
    point_motion_.push_back(motion);
    reduced_motion_.emplace_back(2, directions.cols());
    if (!independent_.empty()) reduced_motion_.back() = motion * directions;
  }
}

bool FullSmallMotion::is_modal(int coordinate) const {
  return std::binary_search(modal_.begin(), modal_.end(), coordinate);
}

// Exchanges a dependent coordinate with the independent one, no mode, that moves it most for its mass;
// nothing where there is none. With row = ∂(coordinate)/∂x of the present ones, x = T x': x_i = (x'_i − Σ_k≠i
// row_k x_k)/row_i.
void FullSmallMotion::make_independent(int coordinate, Eigen::MatrixXd& directions) {
  if (std::find(independent_.begin(), independent_.end(), coordinate) != independent_.end()) return;
  const Eigen::RowVectorXd row = directions.row(coordinate);
  const Eigen::RowVectorXd size =
      row.cwiseAbs().cwiseQuotient(motion_.mass.diagonal().cwiseSqrt().transpose());
  Eigen::Index pivot = -1;
  double largest = kLeastPivot * (size.size() > 0 ? size.maxCoeff() : 0.0);
  for (Eigen::Index i = 0; i < size.size(); ++i) {
    if (size[i] <= largest || is_modal(independent_[static_cast<std::size_t>(i)])) continue;
    largest = size[i];
    pivot = i;
  }
  if (pivot < 0) return;
  Eigen::RowVectorXd of_pivot = -row / row[pivot];
  of_pivot[pivot] = 1.0 / row[pivot];
  multiply_by_row(directions, pivot, of_pivot);
  for (Eigen::MatrixXd* matrix : {&motion_.mass, &motion_.damping, &motion_.stiffness})
    multiply_on_both_sides(*matrix, pivot, of_pivot);
  multiply_on_both_sides(stiffness_rounding_, pivot, of_pivot.cwiseAbs());
  independent_[static_cast<std::size_t>(pivot)] = coordinate;
}

void FullSmallMotion::sort_coordinates(Eigen::MatrixXd& directions) {
  std::vector<int> order(independent_.size());
  std::iota(order.begin(), order.end(), 0);
  const auto coordinate = [&](int i) { return independent_[static_cast<std::size_t>(i)]; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return coordinate(a) < coordinate(b); });
  directions = directions(Eigen::all, order).eval();
  for (Eigen::MatrixXd* matrix : {&motion_.mass, &motion_.damping, &motion_.stiffness, &stiffness_rounding_})
    *matrix = (*matrix)(order, order).eval();
  std::sort(independent_.begin(), independent_.end());
}

Eigen::Index FullSmallMotion::find_independent(int coordinate) const {
  const auto found = std::lower_bound(independent_.begin(), independent_.end(), coordinate);
  return found == independent_.end() || *found != coordinate ? -1 : found - independent_.begin();
}

std::vector<Eigen::Index> FullSmallMotion::find_free(const std::vector<bool>& is_active) const {
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < independent_.size(); ++i) {
    const auto found = std::lower_bound(modal_.begin(), modal_.end(), independent_[i]);
    if (!is_modal(independent_[i]) || is_active[static_cast<std::size_t>(found - modal_.begin())])
      free.push_back(static_cast<Eigen::Index>(i));
  }
  return free;
}

std::optional<KnownMotion> FullSmallMotion::calc_held_motion(const HeldModes& held) const {
  KnownMotion known;
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < known_.independent.size(); ++i) {
    const int coordinate = known_.independent[i];
    const auto place = std::lower_bound(held.coordinates.begin(), held.coordinates.end(), coordinate);
    if (place == held.coordinates.end() || *place != coordinate) continue;
    free.push_back(static_cast<Eigen::Index>(i));
    known.independent.push_back(static_cast<int>(place - held.coordinates.begin()));
  }
  const std::size_t num_held = static_cast<std::size_t>(full_->num_coordinates) - held.coordinates.size();
  if (free.empty() || known_.independent.size() - free.size() != num_held) return std::nullopt;
  const auto& [M, C, K] = known_.motion;
  known.motion = {M(free, free), C(free, free), K(free, free)};
  return known;
}

}  // namespace sprung::dynamics
