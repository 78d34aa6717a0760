#include "dynamics/adaptivity/unbalanced_force.h"

#include "tools/support/dense/wide_product.h"

namespace sprung::dynamics {

namespace {

constexpr Eigen::Index kOfFrame = 4;  // coefficients of the frame's motion

}  // namespace

UnbalancedForce::UnbalancedForce(const Model& full)
    : full_(&full), loads_(full.markers.size()), force_(Eigen::VectorXd::Zero(full.num_coordinates)) {
  for (std::size_t b = 0; b < full.bodies.size(); ++b) {
    const Body& body = full.bodies[b];
    if (body.num_modes() == 0) continue;
    FlexibleBody flexible{.body = b, .markers = {}, .by_coefficient = {}, .coefficients = {}};
    for (const int i : full.acting_markers) {
      const Marker& marker = full.markers[static_cast<std::size_t>(i)];
      if (marker.body == static_cast<int>(b) && marker.Phi.cols() > 0)
        flexible.markers.push_back(static_cast<std::size_t>(i));
    }
    const Eigen::Index size = kOfFrame + 3 * static_cast<Eigen::Index>(flexible.markers.size());
    flexible.by_coefficient.resize(body.num_modes(), size);
    flexible.by_coefficient.leftCols<kOfFrame>() << body.P.transpose(), -body.c.transpose(),
        body.d.transpose();
    Eigen::Index column = kOfFrame;
    for (const std::size_t marker : flexible.markers) {
      flexible.by_coefficient.middleCols<3>(column) = full.markers[marker].Phi.transpose();
      column += 3;
    }
    flexible.coefficients.resize(size);
    bodies_.push_back(std::move(flexible));
  }
}

void UnbalancedForce::update(const SystemTerms& run, const Eigen::VectorXd& lambda, const Eigen::VectorXd& q,
                             const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot) {
  run.calc_loads(lambda, loads_);
  for (FlexibleBody& flexible : bodies_) {
    const Body& body = full_->bodies[flexible.body];
    const Eigen::Index n = body.num_modes(), first = body.first_coordinate;
    const FrameRotation rotation = FrameRotation::from_angle(q[first + 2]);
    const double rate = v[first + 2], turning = v_dot[first + 2];
    flexible.coefficients.head<2>() = rotation.transposed_times(full_->gravity - v_dot.segment<2>(first));
    flexible.coefficients[2] = turning;
    flexible.coefficients[3] = rate * rate;
    Eigen::Index next = kOfFrame;
    for (const std::size_t marker : flexible.markers) {
      flexible.coefficients.segment<2>(next) = rotation.transposed_times(loads_[marker].force);
      flexible.coefficients[next + 2] = loads_[marker].torque;
      next += 3;
    }
    support::multiply(flexible.by_coefficient, flexible.coefficients.data(), force_.data() + first + 3);
    auto r = force_.segment(first + 3, n);
    const auto eta = q.segment(first + 3, n), eta_dot = v.segment(first + 3, n),
               eta_ddot = v_dot.segment(first + 3, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      if (eta[k] == 0.0 && eta_dot[k] == 0.0 && eta_ddot[k] == 0.0) continue;  // most are held there
      // B is skew: −(ηᵀB)ᵀ = B η.
      const double spin = turning * eta[k] + 2.0 * rate * eta_dot[k];
      r += rate * rate * eta[k] * body.M_tt.col(k) + spin * body.B.col(k) - eta_ddot[k] * body.M_ff.col(k) -
           eta_dot[k] * body.damping.col(k) - eta[k] * body.stiffness.col(k);
    }
  }
}

}  // namespace sprung::dynamics
