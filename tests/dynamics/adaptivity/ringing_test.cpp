#include "dynamics/adaptivity/ringing.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "tests/catch.h"

using namespace sprung;
using Eigen::Matrix2Xd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kPi = std::numbers::pi;

// Acceleration of a point that moves along x with the first coordinate, after a force has faded out over T:
// the largest value in ten of the slowest periods, by small time steps from rest under the force.
double release(const dynamics::SmallMotion& motion, const VectorXd& force, double time, double slowest_hz) {
  const Eigen::LLT<MatrixXd> mass(motion.mass), stiffness(motion.stiffness);
  VectorXd q = stiffness.solve(force), v = VectorXd::Zero(force.size());
  const double step = 2e-6, end = time + 10.0 / slowest_hz;
  double largest = 0.0;
  const auto acceleration = [&](double t) {
    const double f = t >= time ? 0.0 : 0.5 * (1.0 + std::cos(kPi * t / time));
    return VectorXd(mass.solve(f * force - motion.stiffness * q));
  };
  for (double t = 0.0; t < end; t += step) {  // leap-frog
    const VectorXd a = acceleration(t);
    if (t >= time) largest = std::max(largest, std::abs(a[0]));
    v += step * a;
    q += step * v;
  }
  return largest;
}

// Two springs in series, the second far stiffer. The light mass between them moves mostly with the fast mode,
// but also with the slow one.
dynamics::SmallMotion make_chain() {
  MatrixXd M(2, 2), K(2, 2);
  M << 1.0, 0.9, 0.9, 1.0;
  K << 4e4, 0.0, 0.0, 1e6;
  return {M, MatrixXd::Zero(2, 2), K};
}

}  // namespace

TEST_CASE("An oscillator is released over the time that its closed form requires", "[adaptivity]") {
  const double m = 2.0, k = 800.0, F = 3.0, reference = 5.0;  // ω = 20 rad/s; at once: 0.3 of the reference
  const dynamics::Ringing ringing(
      {MatrixXd::Constant(1, 1, m), MatrixXd::Zero(1, 1), MatrixXd::Constant(1, 1, k)},
      {{Matrix2Xd::Identity(2, 1), reference}});
  const VectorXd force = VectorXd::Constant(1, F);
  CHECK(ringing.calc_share_of_release(force, 0.0) == Approx(F / m / reference).epsilon(1e-12));
  CHECK(ringing.calc_share_of_impulse(VectorXd::Constant(1, 0.1)) ==
        Approx(20.0 * 0.1 / m / reference).epsilon(1e-12));
  const double x = std::sqrt(1.0 + 0.3 / 0.01);  // x² − 1 = 0.3 / 0.01
  CHECK(ringing.calc_release_time(force, 0.01, 10.0) == Approx(x * kPi / 20.0).epsilon(0.011));
  CHECK(ringing.calc_release_time(force, 0.31, 10.0) == 0.0);
  CHECK(ringing.calc_release_time(force, 0.01, 0.5) == 0.5);
}

TEST_CASE("A mode that moves no point is released over the longest time allowed", "[adaptivity]") {
  const dynamics::Ringing ringing(make_chain(), {});
  CHECK(ringing.calc_release_time(Eigen::Vector2d(1.0, 0.0), 0.01, 0.05) == 0.05);
}

TEST_CASE("After a release no point rings by more than was allowed, also for frequencies that are far apart",
          "[adaptivity]") {
  const dynamics::SmallMotion chain = make_chain();
  const double slowest = 31.2;  // Hz; the other one is at 374 Hz
  const dynamics::Ringing ringing(chain, {{Matrix2Xd::Identity(2, 2), 1.0}});
  for (const Eigen::Vector2d& force :
       {Eigen::Vector2d(0.02, 0.0), Eigen::Vector2d(0.1, 0.1), Eigen::Vector2d(0.02, -0.3)}) {
    const double share = 0.05 * ringing.calc_share_of_release(force, 0.0);
    const double time = ringing.calc_release_time(force, share, 10.0);
    INFO("force " << force.transpose() << ", released over " << time << " s");
    CHECK(release(chain, force, time, slowest) < 1.42 * share);  // both vibrations at their largest at once
    // Without ringing the time could be as short as that: cos(ωT/2) may have any value.
    double worst = 0.0;
    for (const double less : {0.3, 0.35, 0.4, 0.45, 0.5}) {
      worst = std::max(worst, release(chain, force, less * time, slowest));
    }
    CHECK(worst > share);
  }
}
