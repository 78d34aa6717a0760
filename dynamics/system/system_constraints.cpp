#include "dynamics/system/system_constraints.h"

namespace sprung::dynamics {

SystemConstraints::SystemConstraints(const Model& model, std::span<const MarkerState> markers)
    : model_(&model), Phi_q_(model.num_constraints, model.num_coordinates) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) add_joint(j, markers);
}

void SystemConstraints::calc_residual(std::span<const MarkerState> markers, double time,
                                      Eigen::Ref<Eigen::VectorXd> phi) const {
  JointVector residual;
  for (const JointTerms& terms : joints_) {
    terms.joint->calc_residual(markers[terms.a.marker], markers[terms.b.marker], time, residual);
    for (int k = 0; k < terms.num_rows; ++k) phi[terms.row + k] = residual[k];
  }
}

void SystemConstraints::add_joint(std::size_t index, std::span<const MarkerState> markers) {
  const Joint& joint = *model_->joints[index];
  const bool is_constant = joint.has_constant_jacobian();
  JointTerms terms{.joint = &joint,
                   .row = model_->joint_rows[index],
                   .num_rows = joint.num_constraints(),
                   .is_constant = is_constant,
                   .drifts = !is_constant || !joint.time_functions().empty(),
                   .a = {static_cast<std::size_t>(joint.marker_a), {}, -1},
                   .b = {static_cast<std::size_t>(joint.marker_b), {}, -1}};
  if (is_constant)
    joint.calc_jacobian(markers[terms.a.marker], markers[terms.b.marker], terms.a.G, terms.b.G);
  add_block(terms, terms.a);
  add_block(terms, terms.b);
  if (is_constant)
    fill_constant_joint(terms, markers);
  else
    varying_joints_.push_back(joints_.size());
  joints_.push_back(terms);
}

void SystemConstraints::fill_constant_joint(const JointTerms& terms, std::span<const MarkerState> markers) {
  for (const JointSide* side : {&terms.a, &terms.b}) {
    if (side->block < 0) continue;
    fill_block(*side, markers[side->marker]);
    const BlockJacobian::Block& block = Phi_q_.blocks()[static_cast<std::size_t>(side->block)];
    for (int k = 0; k < block.num_rows; ++k) {
      turning_rows_.push_back({.value = block.offset + static_cast<std::size_t>(k * block.num_columns + 2),
                               .marker = side->marker,
                               .G = {side->G(k, 0), side->G(k, 1), side->G(k, 2)}});
    }
  }
}

void SystemConstraints::add_block(const JointTerms& terms, JointSide& side) {
  const int index = model_->markers[side.marker].body;
  if (index == kGround) return;
  const Body& body = model_->bodies[static_cast<std::size_t>(index)];
  const std::size_t block = Phi_q_.add_block({.row = terms.row,
                                              .num_rows = terms.num_rows,
                                              .column = body.first_coordinate,
                                              .num_columns = body.num_coordinates(),
                                              .body = index});
  side.block = static_cast<std::ptrdiff_t>(block);
  if (!terms.is_constant) return;
  for (int k = 0; k < terms.num_rows; ++k) {
    for (int j = 0; j < 2; ++j) {  // columns of the frame's x and y
      if (side.G(k, j) == 0.0) Phi_q_.mark_zero(block, k, j);
    }
  }
}

// The values of a row of the Jacobian that change with the state: the one of the angle, those of the modes.
inline void SystemConstraints::fill_turning(const MarkerRow& G, const MarkerState& state, double* values) {
  values[0] = G.by_theta(state);
  if (state.Phi.cols() > 0) fill_modal(G, state, values + 1);
}

void SystemConstraints::fill_modal(const MarkerRow& G, const MarkerState& state, double* values) {
  const MarkerRow in_body = G.in_body(state.rotation);
  const double* shape = state.Phi.data();
  for (Eigen::Index k = 0; k < state.Phi.cols(); ++k, shape += 3) values[k] = in_body.by_mode(shape);
}

void SystemConstraints::fill_block(const JointSide& side, const MarkerState& state) {
  if (side.block < 0) return;
  const Eigen::Index num_modes = state.Phi.cols();
  double* value = Phi_q_.values(static_cast<std::size_t>(side.block));
  for (Eigen::Index k = 0; k < side.G.rows(); ++k, value += 3 + num_modes) {
    value[0] = side.G(k, 0);
    value[1] = side.G(k, 1);
    fill_turning({side.G(k, 0), side.G(k, 1), side.G(k, 2)}, state, value + 2);
  }
}

void SystemConstraints::update_jacobian(std::span<const MarkerState> markers) {
  double* values = Phi_q_.data();
  for (const TurningRow& row : turning_rows_) {
    fill_turning(row.G, markers[row.marker], values + row.value);
  }
  for (const std::size_t joint : varying_joints_) {
    JointTerms& terms = joints_[joint];
    terms.joint->calc_jacobian(markers[terms.a.marker], markers[terms.b.marker], terms.a.G, terms.b.G);
    fill_block(terms.a, markers[terms.a.marker]);
    fill_block(terms.b, markers[terms.b.marker]);
  }
}

void SystemConstraints::calc_time_rate(std::span<const MarkerState> markers, double time,
                                       Eigen::Ref<Eigen::VectorXd> phi_t) const {
  if (!model_->has_moving_joints) {
    phi_t.setZero();
    return;
  }
  JointVector rate;
  for (const JointTerms& terms : joints_) {
    terms.joint->calc_time_rate(markers[terms.a.marker], markers[terms.b.marker], time, rate);
    for (int k = 0; k < terms.num_rows; ++k) phi_t[terms.row + k] = rate[k];
  }
}

void SystemConstraints::calc_gamma(std::span<const MarkerState> markers, double time,
                                   Eigen::Ref<Eigen::VectorXd> gamma) const {
  JointVector drift;
  for (const JointTerms& terms : joints_) {
    const MarkerState& a = markers[terms.a.marker];
    const MarkerState& b = markers[terms.b.marker];
    for (int k = 0; k < terms.num_rows; ++k) {
      gamma[terms.row + k] =
          -(terms.a.G(k, 0) * a.a_bias.x() + terms.a.G(k, 1) * a.a_bias.y() + terms.a.G(k, 2) * a.alpha_bias +
            terms.b.G(k, 0) * b.a_bias.x() + terms.b.G(k, 1) * b.a_bias.y() + terms.b.G(k, 2) * b.alpha_bias);
    }
    if (!terms.drifts) continue;
    terms.joint->calc_drift(a, b, time, drift);
    for (int k = 0; k < terms.num_rows; ++k) gamma[terms.row + k] -= drift[k];
  }
}

void SystemConstraints::add_joint_loads(const Eigen::VectorXd& lambda, std::span<Wrench> loads) const {
  for (const JointTerms& terms : joints_) {
    for (const JointSide* side : {&terms.a, &terms.b}) {
      Wrench& load = loads[side->marker];
      for (int k = 0; k < terms.num_rows; ++k) {
        const double multiplier = lambda[terms.row + k];
        load.force -= multiplier * side->G.row(k).head<2>().transpose();
        load.torque -= multiplier * side->G(k, 2);
      }
    }
  }
}

}  // namespace sprung::dynamics
