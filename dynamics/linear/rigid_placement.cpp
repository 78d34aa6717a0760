#include "dynamics/linear/rigid_placement.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include "dynamics/system/system_terms.h"
#include "tools/support/dense/orthogonal_factors.h"

namespace sprung::dynamics {

namespace {

constexpr double kSmallestGap = 1e-9;  // of the length scale: a residual that counts as none

// Bodies that joints and force elements connect.
struct Group {
  std::vector<std::size_t> bodies;
  std::vector<std::size_t> joints;  // with the ground, prescribed motions among them
  bool is_tied = false;             // to the ground, by a force element
  bool has_tyres = false;
};

// The groups, by the smallest body of each.
class Groups {
 public:
  explicit Groups(const Model& model) : model_(&model), leader_(model.bodies.size()) {
    std::iota(leader_.begin(), leader_.end(), std::size_t{0});
    for (const auto& joint : model.joints) connect({joint->marker_a, joint->marker_b});
    for (const auto& force : model.forces) connect(force->markers());
  }

  std::vector<Group> list() {
    std::map<std::size_t, Group> groups;
    for (std::size_t b = 0; b < leader_.size(); ++b) groups[find(b)].bodies.push_back(b);
    for (std::size_t j = 0; j < model_->joints.size(); ++j) {
      const Joint& joint = *model_->joints[j];
      const int a = body_of(joint.marker_a), b = body_of(joint.marker_b);
      if ((a == kGround) != (b == kGround)) groups[find_of(std::max(a, b))].joints.push_back(j);
    }
    for (const auto& force : model_->forces) {
      const std::vector<int> markers = force->markers();
      const bool is_tied =
          std::any_of(markers.begin(), markers.end(), [&](int m) { return body_of(m) == kGround; });
      for (const int marker : markers) {
        if (body_of(marker) == kGround) continue;
        Group& group = groups[find_of(body_of(marker))];
        group.is_tied |= is_tied;
        group.has_tyres |= force->describe().on_road;
      }
    }
    std::vector<Group> listed;
    for (auto& [leader, group] : groups) listed.push_back(std::move(group));
    return listed;
  }

 private:
  int body_of(int marker) const { return model_->markers[static_cast<std::size_t>(marker)].body; }
  std::size_t find(std::size_t body) {
    while (leader_[body] != body) body = leader_[body] = leader_[leader_[body]];
    return body;
  }
  std::size_t find_of(int body) { return find(static_cast<std::size_t>(body)); }
  void connect(const std::vector<int>& markers) {
    int first = kGround;
    for (const int marker : markers) {
      const int body = body_of(marker);
      if (body == kGround) continue;
      if (first == kGround) first = body;
      const auto [low, high] = std::minmax({find_of(first), find_of(body)});
      leader_[high] = low;
    }
  }

  const Model* model_;
  std::vector<std::size_t> leader_;
};

class Placement {
 public:
  Placement(const Model& model, Eigen::VectorXd& q)
      : model_(&model), q_(&q), terms_(model), phi_(Eigen::VectorXd::Zero(model.num_constraints)) {
    update();
  }

  // Whether some prescribed motion begins elsewhere than it is drawn.
  bool has_gap() const {
    for (std::size_t j = 0; j < model_->joints.size(); ++j)
      if (model_->joints[j]->is_motion() && is_open(phi_[model_->joint_rows[j]])) return true;
    return false;
  }

  // @return how far the group is shifted
  double place(const Group& group) {
    std::vector<int> driven;
    bool is_open_somewhere = false;
    for (const std::size_t j : group.joints) {
      if (!model_->joints[j]->is_motion() || model_->joints[j]->is_angle(0)) continue;
      driven.push_back(model_->joint_rows[j]);
      is_open_somewhere |= is_open(phi_[driven.back()]);
    }
    if (!is_open_somewhere || group.is_tied) return 0.0;
    const Eigen::MatrixXd by_shift = calc_by_shift(group)(driven, Eigen::all);
    const Eigen::VectorXd shift = support::solve_least_squares(by_shift, -phi_(driven));
    const Eigen::VectorXd before = phi_;
    move(group, shift);
    if (is_closed(group, driven, before)) return shift.norm();
    move(group, -shift);
    return 0.0;
  }

 private:
  bool is_open(double residual) const { return std::abs(residual) > kSmallestGap * model_->length_scale; }

  void update() {
    terms_.update_positions(0.0, *q_);
    terms_.calc_residual(phi_);
  }

  // Residuals of the constraints by a shift along x, and along y where that is allowed.
  Eigen::MatrixXd calc_by_shift(const Group& group) {
    terms_.update_jacobian();
    Eigen::MatrixXd shifts = Eigen::MatrixXd::Zero(model_->num_coordinates, group.has_tyres ? 1 : 2);
    for (const std::size_t b : group.bodies) {
      for (Eigen::Index axis = 0; axis < shifts.cols(); ++axis)
        shifts(model_->bodies[b].first_coordinate + axis, axis) = 1.0;
    }
    return terms_.jacobian().sparse() * shifts;
  }

  void move(const Group& group, const Eigen::VectorXd& shift) {
    for (const std::size_t b : group.bodies)
      q_->segment(model_->bodies[b].first_coordinate, shift.size()) += shift;
    update();
  }

  // Whether the driven points are where they begin, and no joint with the ground is farther open than before.
  bool is_closed(const Group& group, const std::vector<int>& driven, const Eigen::VectorXd& before) const {
    if (std::any_of(driven.begin(), driven.end(), [&](int row) { return is_open(phi_[row]); })) return false;
    for (const std::size_t j : group.joints) {
      for (int k = 0; k < model_->joints[j]->num_constraints(); ++k) {
        const int row = model_->joint_rows[j] + k;
        if (is_open(std::max(std::abs(phi_[row]) - std::abs(before[row]), 0.0))) return false;
      }
    }
    return true;
  }

  const Model* model_;
  Eigen::VectorXd* q_;
  SystemTerms terms_;
  Eigen::VectorXd phi_;
};

}  // namespace

double place_driven_vehicles(const Model& model, Eigen::VectorXd& q) {
  Placement placement(model, q);
  if (!placement.has_gap()) return 0.0;
  double largest = 0.0;
  for (const Group& group : Groups(model).list()) largest = std::max(largest, placement.place(group));
  return largest;
}

}  // namespace sprung::dynamics
