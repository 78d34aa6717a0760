// Switch functions that become negative and positive again within a step, between its points.
#include "dynamics/integration/hidden_switches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "dynamics/simulation/transient.h"
#include "tests/catch.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::SwitchCourse;

namespace {

SwitchCourse make_course(const std::function<double(double)>& function) {
  dynamics::lobatto::NodeWeights values;
  for (int j = 0; j < dynamics::lobatto::kNumNodes; ++j) values[j] = function(dynamics::lobatto::node(j));
  return SwitchCourse(values);
}

// A swing of frequency 1 from rest at x = 1 that a stop of another rate turns at x = -depth, in closed form.
class StoppedSwing {
 public:
  StoppedSwing(double depth, double rate) : omega_(std::sqrt(rate)), at_contact_(std::acos(-depth)) {
    centre_ = -depth + depth / rate;  // of the motion in contact
    const double speed = std::sin(at_contact_);
    reach_ = std::hypot(depth / rate, speed / omega_);
    phase_ = std::atan2(speed / omega_, depth / rate);
    in_contact_ = 2.0 * phase_ / omega_;
  }
  long num_switches(double end) const {
    const double last = std::fmod(end, period());
    return 2 * static_cast<long>(end / period()) + (last > at_contact_ ? 1 : 0) +
           (last > at_contact_ + in_contact_ ? 1 : 0);
  }
  double period() const { return 2.0 * at_contact_ + in_contact_; }
  double position(double time) const {
    time = std::fmod(time, period());
    if (time < at_contact_) return std::cos(time);
    time -= at_contact_;
    if (time > in_contact_) return std::cos(at_contact_ + in_contact_ - time);
    return centre_ - reach_ * std::cos(omega_ * (time - 0.5 * in_contact_));
  }

 private:
  double omega_, at_contact_, centre_ = 0.0, reach_ = 0.0, phase_ = 0.0, in_contact_ = 0.0;
};

}  // namespace

TEST_CASE("A dip between the points of a step is found, without false alarms", "[analysis]") {
  const auto dip_of = [](const std::function<double(double)>& function) {
    return make_course(function).dip();
  };
  const auto parabola = [](double least) {
    return [least](double x) { return (x - 0.48) * (x - 0.48) + least; };
  };
  CHECK(dip_of(parabola(-0.01)) == Approx(0.48));
  CHECK(std::isnan(dip_of(parabola(0.01))));
  CHECK(std::isnan(dip_of([](double x) { return 0.3 - x; })));
  CHECK(std::isnan(dip_of([](double x) { return x * x; })));
  CHECK(std::isnan(dip_of([](double) { return 0.0; })));
  // Least at 0.89, between points of which one before is negative.
  CHECK(std::isnan(dip_of([](double x) { return 0.2 - x + 0.56 * x * x; })));
  CHECK(dip_of([](double x) { return (x - 0.85) * (x - 0.9) * (x + 1.0); }) == Approx(0.8753).epsilon(1e-3));
}

TEST_CASE("An oscillation that the points do not resolve may hide a switch", "[analysis]") {
  const auto may_hide = [](double omega, double level) {
    const auto swing = [=](double x) { return level - std::cos(omega * x + 1.0); };
    const SwitchCourse course = make_course(swing);
    return course.may_hide(0.2, swing(0.2)) || course.may_hide(0.6, swing(0.6));
  };
  CHECK(may_hide(20.0, 1.2));
  CHECK(may_hide(200.0, 1.2));
  CHECK_FALSE(may_hide(20.0, 90.0));  // far from zero
  CHECK_FALSE(may_hide(1.0, 1.2));    // resolved
  CHECK_FALSE(may_hide(2.0, 1.2));
}

TEST_CASE("A stop that is just touched by a free oscillation is not stepped over", "[analysis]") {
  // A body of 1 kg on a spring of 1 N/m: without the stop one step of the exponential method could be any
  // length.
  using dynamics::PiecewisePolynomial;
  constexpr double kDepth = 0.99, kRate = 250.0, kEnd = 100.0;
  const StoppedSwing swing(kDepth, kRate);
  dynamics::Model model;
  const int body = test::add_body(model, dynamics::make_rigid_body("body", 1.0, 1.0));
  PiecewisePolynomial spring(std::vector<double>{0.0, 1.0});
  spring.continue_straight(kDepth, kRate, false);
  dynamics::SpringDamper::Parameters parameters{
      .marker_a = test::add_marker(model, dynamics::kGround, {0.0, -10.0}),
      .marker_b = test::add_marker(model, body, {0.0, 0.0}),
      .free_length = 10.0,
      .spring = spring,
      .damper = PiecewisePolynomial(std::vector<double>{0.0})};
  model.forces.push_back(std::make_unique<dynamics::SpringDamper>("spring", parameters));
  dynamics::number_model(model);
  for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
    INFO("tolerance " << tolerance);
    double worst = 0.0;
    dynamics::TransientOptions options;
    options.end_time = kEnd;
    options.output_step = 0.1;
    options.integrator.relative_tolerance = tolerance;
    options.on_output = [&](const dynamics::Snapshot& snapshot) {
      worst = std::max(worst, std::abs(snapshot.q[1] - swing.position(snapshot.time)));
    };
    const dynamics::State start =
        test::make_state(model, Eigen::Vector3d(0.0, 1.0, 0.0), Eigen::Vector3d::Zero());
    const dynamics::TransientStatistics statistics = dynamics::run_transient(model, start, options);
    CHECK(statistics.switches == swing.num_switches(kEnd));
    CHECK(worst < 5.0 * std::pow(tolerance, 0.75));
  }
}

TEST_CASE("A stop that a flying body touches for less than a step is found by each method", "[analysis]") {
  // Thrown up at √2g − it would come 1 m high − under a stop that begins 1 mm lower. The flight up to there,
  // the swing on the stop and the flight back are known in closed form.
  using dynamics::PiecewisePolynomial;
  constexpr double kGravity = 10.0, kClearance = 0.999, kRate = 1e4;
  const double start_speed = std::sqrt(2.0 * kGravity),
               speed = std::sqrt(2.0 * kGravity * (1.0 - kClearance));
  const double rise = (start_speed - speed) / kGravity, omega = std::sqrt(kRate);
  const double contact = 2.0 * std::atan2(speed, kGravity / omega) / omega;  // it falls off where it hit
  const double end = 2.0 * rise + contact;
  dynamics::Model model;
  model.gravity = {0.0, -kGravity};
  const int body = test::add_body(model, dynamics::make_rigid_body("body", 1.0, 1.0));
  PiecewisePolynomial spring(std::vector<double>{0.0});
  spring.continue_straight(kClearance, kRate, false);
  model.forces.push_back(std::make_unique<dynamics::SpringDamper>(
      "stop",
      dynamics::SpringDamper::Parameters{.marker_a = test::add_marker(model, dynamics::kGround, {0.0, 2.0}),
                                         .marker_b = test::add_marker(model, body, {0.0, 0.0}),
                                         .free_length = 2.0,
                                         .spring = spring,
                                         .damper = PiecewisePolynomial(std::vector<double>{0.0})}));
  dynamics::number_model(model);
  using Method = dynamics::SteppingMethod;
  for (const Method method :
       {Method::kExponential, Method::kAdams, Method::kBdf, Method::kGeneralizedAlpha}) {
    INFO("method " << static_cast<int>(method));
    dynamics::TransientOptions options;
    options.end_time = end;
    options.output_step = end;
    options.integrator.method = method;
    Eigen::Vector2d last;
    options.on_output = [&](const dynamics::Snapshot& now) { last = {now.q[1], now.v[1]}; };
    const dynamics::State start =
        test::make_state(model, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, start_speed, 0.0));
    CHECK(dynamics::run_transient(model, start, options).switches == 2);
    CHECK(std::abs(last[0]) < 1e-4);
    CHECK(std::abs(last[1] + start_speed) < 1e-4);
  }
}
