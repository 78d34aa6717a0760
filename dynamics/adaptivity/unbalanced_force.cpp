#include "dynamics/adaptivity/unbalanced_force.h"

namespace sprung::dynamics {

UnbalancedForce::UnbalancedForce(const Model& full)
    : full_(&full),
      acting_(full.bodies.size()),
      loads_(full.markers.size()),
      force_(Eigen::VectorXd::Zero(full.num_coordinates)) {
  for (const int i : full.acting_markers) {
    const Marker& marker = full.markers[static_cast<std::size_t>(i)];
    if (marker.body != kGround && marker.Phi.cols() > 0)
      acting_[static_cast<std::size_t>(marker.body)].push_back(i);
  }
}

void UnbalancedForce::update(const SystemTerms& run, const Eigen::VectorXd& lambda, const Eigen::VectorXd& q,
                             const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot) {
  run.calc_loads(lambda, loads_);
  for (std::size_t b = 0; b < full_->bodies.size(); ++b) {
    const Body& body = full_->bodies[b];
    const Eigen::Index n = body.num_modes(), first = body.first_coordinate;
    if (n == 0) continue;
    const FrameRotation rotation = FrameRotation::from_angle(q[first + 2]);
    const Eigen::Vector2d pull = rotation.transposed_times(full_->gravity - v_dot.segment<2>(first));
    const double rate = v[first + 2], turning = v_dot[first + 2];
    const auto eta = q.segment(first + 3, n), eta_dot = v.segment(first + 3, n),
               eta_ddot = v_dot.segment(first + 3, n);
    auto r = force_.segment(first + 3, n);
    r.noalias() = body.P.transpose() * pull;
    r += rate * rate * body.d.transpose() - turning * body.c.transpose();
    for (Eigen::Index k = 0; k < n; ++k) {
      if (eta[k] == 0.0 && eta_dot[k] == 0.0 && eta_ddot[k] == 0.0) continue;  // most are held there
      // B is skew: −(ηᵀB)ᵀ = B η.
      const double spin = turning * eta[k] + 2.0 * rate * eta_dot[k];
      r += rate * rate * eta[k] * body.M_tt.col(k) + spin * body.B.col(k) - eta_ddot[k] * body.M_ff.col(k) -
           eta_dot[k] * body.damping.col(k) - eta[k] * body.stiffness.col(k);
    }
    for (const int i : acting_[b]) {
      const Marker& marker = full_->markers[static_cast<std::size_t>(i)];
      const Wrench& load = loads_[static_cast<std::size_t>(i)];
      const Eigen::Vector2d force = rotation.transposed_times(load.force);
      for (Eigen::Index k = 0; k < n; ++k) {
        r[k] += marker.Phi(0, k) * force.x() + marker.Phi(1, k) * force.y() + marker.Phi(2, k) * load.torque;
      }
    }
  }
}

}  // namespace sprung::dynamics
