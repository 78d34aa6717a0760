// The parts of the exponential integrator, each against its definition.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "dynamics/functions/oscillator_response.h"
#include "dynamics/integration/exponential/lobatto_step.h"
#include "dynamics/integration/exponential/vibration_basis.h"
#include "tests/catch.h"

using namespace sprung;
using dynamics::OscillatorResponse;

namespace {

double factorial(int n) {
  return n < 2 ? 1.0 : n * factorial(n - 1);
}

// Matrix of (x, v) → (ẋ, v̇).
Eigen::MatrixXd first_order(const dynamics::SmallMotion& motion) {
  const Eigen::Index f = motion.mass.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * f, 2 * f);
  A.topRightCorner(f, f).setIdentity();
  A.bottomLeftCorner(f, f) = -motion.mass.inverse() * motion.stiffness;
  A.bottomRightCorner(f, f) = -motion.mass.inverse() * motion.damping;
  return A;
}

Eigen::MatrixXd block_matrix(const dynamics::PairBlocks& B) {
  const Eigen::Index f = B.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 * f, 2 * f);
  matrix.topLeftCorner(f, f).diagonal() = B.b11;
  matrix.topRightCorner(f, f).diagonal() = B.b12;
  matrix.bottomLeftCorner(f, f).diagonal() = B.b21;
  matrix.bottomRightCorner(f, f).diagonal() = B.b22;
  return matrix;
}

Eigen::MatrixXd random_positive(Eigen::Index n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd X = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
  return X * X.transpose() / static_cast<double>(n) + 0.1 * Eigen::MatrixXd::Identity(n, n);
}

OscillatorResponse calc_response(double stiffness, double decay, double time) {
  OscillatorResponse response;
  dynamics::calc_oscillator_responses({&stiffness, 1}, {&decay, 1}, time, OscillatorResponse::kMaxPower,
                                      {&response, 1});
  return response;
}

}  // namespace

TEST_CASE("An estimated error vibrates on without growth, with what a constant error of the drive adds",
          "[analysis]") {
  // Damped vibration, vibration that grows, a free motion with damping; as coordinate and velocity.
  dynamics::PairBlocks B;
  B.b11 = Eigen::Array3d::Zero();
  B.b12 = Eigen::Array3d::Ones();
  B.b21 = Eigen::Array3d(-900.0, -400.0, 0.0);
  B.b22 = Eigen::Array3d(-6.0, 2.0, -3.0);
  const double length = 0.35, share = 0.3;
  dynamics::LobattoPropagator propagator(3);
  propagator.update(1.0, length, B);
  Eigen::VectorXd u(6), g(6);
  u << 0.3, -0.7, 0.4, 11.0, 5.0, 2.0;
  g << 0.2, 0.5, -0.1, 31.0, -17.0, 9.0;
  Eigen::VectorXd found = u;
  propagator.carry_error(B, share, g, found);
  for (const Eigen::Index m : {0, 1}) {
    CAPTURE(m);
    // e^{Bt} = e^{−dt} (cos ωt I + sin ωt (B + d I)/ω);   ∫ e^{Bσ} dσ = B⁻¹ (e^{Bt} − I).
    const Eigen::Matrix2d block{{B.b11[m], B.b12[m]}, {B.b21[m], B.b22[m]}}, I = Eigen::Matrix2d::Identity();
    const double d = -0.5 * block.trace(), omega = std::sqrt(block.determinant() - d * d);
    const Eigen::Matrix2d free = std::exp(-d * length) * (std::cos(omega * length) * I +
                                                          std::sin(omega * length) / omega * (block + d * I));
    const Eigen::Matrix2d forced = block.inverse() * (free - I);
    const double growth = std::max(1.0, std::exp(-d * length)),
                 decay = std::min(1.0, std::exp(-0.5 * d * length));
    const Eigen::Vector2d expected = free * Eigen::Vector2d(u[m], u[3 + m]) / growth +
                                     share * decay * (forced * Eigen::Vector2d(g[m], g[3 + m]));
    CHECK((Eigen::Vector2d(found[m], found[3 + m]) - expected).norm() < 1e-11 * expected.norm());
  }
  CHECK(found[2] == 0.0);
  CHECK(found[5] == 0.0);
}

TEST_CASE("An oscillator's response composes: two spans of time are one", "[analysis]") {
  // All regimes: free, slow, fast, critical, far beyond critical, unstable by damping or by stiffness.
  struct Case {
    double stiffness, decay;
  };
  for (const Case& c :
       {Case{0.0, 0.0}, Case{1e-8, 0.0}, Case{4.0, 0.1}, Case{1e4, 2.0}, Case{1e8, 50.0}, Case{1.0, 1.0},
        Case{1e4, 100.0}, Case{1e4, 100.0001}, Case{0.0, 30.0}, Case{1e-3, 1e3}, Case{4.0, 500.0},
        Case{1e6, 1e4}, Case{100.0, -0.5}, Case{4.0, -40.0}, Case{0.0, -20.0}, Case{-900.0, 0.0},
        Case{-4.0, 100.0}, Case{-1e-3, -20.0}}) {
    for (const double first : {1e-5, 3e-3, 0.2}) {
      for (const double second : {1e-4, 2e-2, 1.1}) {
        INFO("stiffness " << c.stiffness << ", decay " << c.decay << ", times " << first << " and "
                          << second);
        const OscillatorResponse a = calc_response(c.stiffness, c.decay, first);
        const OscillatorResponse b = calc_response(c.stiffness, c.decay, second);
        const OscillatorResponse whole = calc_response(c.stiffness, c.decay, first + second);
        const double size = std::abs(whole.c) + std::abs(whole.s_rate) + 1e-3;
        CHECK(b.c * a.c + b.s * a.c_rate == Approx(whole.c).margin(1e-11 * size));
        CHECK(b.c * a.s + b.s * a.s_rate == Approx(whole.s).epsilon(1e-10).margin(1e-14));
        CHECK(b.c_rate * a.s + b.s_rate * a.s_rate == Approx(whole.s_rate).margin(1e-10 * size));
        for (int k = 0; k <= OscillatorResponse::kMaxPower; ++k) {
          const auto i = static_cast<std::size_t>(k);
          // t^k/k! seen from `first` on is Σ first^j/j! · τ^(k−j)/(k−j)!
          double forced = b.c * a.forced[i] + b.s * a.forced_rate(k);
          for (int j = 0; j <= k; ++j) {
            forced += std::pow(first, j) / factorial(j) * b.forced[static_cast<std::size_t>(k - j)];
          }
          CHECK(forced == Approx(whole.forced[i]).epsilon(1e-9));
        }
      }
    }
  }
}

TEST_CASE("An oscillator's response under a constant force is the closed form", "[analysis]") {
  // x = (1 − cos ωt)/ω² from rest; with damping and no stiffness x = (t − (1 − e^(−2dt))/2d)/2d
  const OscillatorResponse free = calc_response(25.0, 0.0, 0.7);
  CHECK(free.forced[0] == Approx((1.0 - std::cos(3.5)) / 25.0).epsilon(1e-13));
  const OscillatorResponse damper = calc_response(0.0, 40.0, 0.7);
  CHECK(damper.forced[0] == Approx((0.7 - (1.0 - std::exp(-56.0)) / 80.0) / 80.0).epsilon(1e-13));
}

TEST_CASE("The vibration basis decouples small motion into pairs", "[analysis]") {
  std::mt19937 random(7);
  const Eigen::Index f = 6;
  dynamics::SmallMotion motion{random_positive(f, random), random_positive(f, random),
                               1e4 * random_positive(f, random)};
  SECTION("damping that couples the modes") {}
  SECTION("with a coordinate that moves freely") {
    motion.stiffness.row(2).setZero();
    motion.stiffness.col(2).setZero();
    motion.damping.row(2).setZero();
    motion.damping.col(2).setZero();
    motion.mass = Eigen::MatrixXd::Identity(f, f);
  }
  SECTION("far beyond critical damping") {
    motion.damping *= 1e4;
  }
  SECTION(
      "with two coordinates that only dampers hold, far stiffer ones than the springs, one between them") {
    for (const int free : {2, 4}) {
      motion.stiffness.row(free).setZero();
      motion.stiffness.col(free).setZero();
      motion.damping.row(free).setZero();
      motion.damping.col(free).setZero();
    }
    motion.damping(2, 2) = 1e8;
    motion.damping(4, 4) = 1e8;
    motion.damping(2, 4) = motion.damping(4, 2) = -1e8;
    motion.damping(1, 1) += 1e6;
    motion.damping(2, 2) += 1e6;
    motion.damping(1, 2) = motion.damping(2, 1) = -1e6;
  }
  SECTION("with damping that puts energy in") {
    motion.damping *= -1e3;
  }
  const dynamics::VibrationBasis basis = dynamics::make_vibration_basis(motion);
  const Eigen::MatrixXd A = first_order(motion);
  CHECK((basis.T * basis.inverse - Eigen::MatrixXd::Identity(2 * f, 2 * f)).norm() < 1e-8);
  CHECK((basis.T * block_matrix(basis.blocks) * basis.inverse - A).norm() < 1e-8 * A.norm());
}

TEST_CASE("Where complex modes are defective the undamped ones are taken, with their own damping",
          "[analysis]") {
  // Critical damping: a double eigenvalue with one eigenvector.
  const dynamics::SmallMotion motion{Eigen::MatrixXd::Identity(1, 1), 20.0 * Eigen::MatrixXd::Identity(1, 1),
                                     100.0 * Eigen::MatrixXd::Identity(1, 1)};
  const dynamics::VibrationBasis basis = dynamics::make_vibration_basis(motion);
  CHECK((basis.T * block_matrix(basis.blocks) * basis.inverse - first_order(motion)).norm() < 1e-6);
  CHECK(basis.T.allFinite());
  CHECK(basis.inverse.norm() < 1e4);
}

TEST_CASE("A Lobatto step is exact for forces of third degree, and its error estimate for a fourth is exact",
          "[analysis]") {
  const dynamics::SmallMotion motion{Eigen::MatrixXd::Identity(1, 1), 0.6 * Eigen::MatrixXd::Identity(1, 1),
                                     50.0 * Eigen::MatrixXd::Identity(1, 1)};
  const dynamics::VibrationBasis basis = dynamics::make_vibration_basis(motion);
  const double h = 0.3;
  // ẍ + 0.6 ẋ + 50 x = p(t) with x = 1 + t − 2t² + 3t³ (and + t⁴): what p has to be
  const auto drive = [&](double t, double fourth) {
    const double x = 1.0 + t - 2.0 * t * t + 3.0 * t * t * t + fourth * t * t * t * t;
    const double x1 = 1.0 - 4.0 * t + 9.0 * t * t + 4.0 * fourth * t * t * t;
    const double x2 = -4.0 + 18.0 * t + 12.0 * fourth * t * t;
    return x2 + 0.6 * x1 + 50.0 * x;
  };
  const Eigen::Vector2d start = basis.inverse * Eigen::Vector2d(1.0, 1.0);
  dynamics::LobattoPropagator propagator(1);
  for (const double theta : {0.25, 1.0}) {
    propagator.update(theta, h, basis.blocks);
    const double t = theta * h;
    dynamics::lobatto::NodeValues nodes(2, 4);
    Eigen::VectorXd u(2);
    for (int j = 0; j < 4; ++j) {
      nodes.col(j) = basis.inverse * Eigen::Vector2d(0.0, drive(dynamics::lobatto::node(j) * h, 0.0));
    }
    propagator.apply(basis.blocks, start, nodes, u);
    CHECK((basis.T * u)[0] == Approx(1.0 + t - 2.0 * t * t + 3.0 * t * t * t).epsilon(1e-13));
    CHECK((basis.T * u)[1] == Approx(1.0 - 4.0 * t + 9.0 * t * t).epsilon(1e-12));

    for (int j = 0; j < 4; ++j) {
      nodes.col(j) = basis.inverse * Eigen::Vector2d(0.0, drive(dynamics::lobatto::node(j) * h, 1.0));
    }
    propagator.apply(basis.blocks, start, nodes, u);
    // p has 50 t⁴ = 50 h⁴ θ⁴ beyond the cubics
    propagator.add_quartic(basis.blocks, basis.inverse * Eigen::Vector2d(0.0, 50.0 * std::pow(h, 4)), u);
    CHECK((basis.T * u)[0] == Approx(1.0 + t - 2.0 * t * t + 3.0 * t * t * t + t * t * t * t).epsilon(1e-13));
  }
}

TEST_CASE("Many modes that damping couples become pairs, too: nothing of the damping is left out",
          "[analysis]") {
  std::mt19937 random(96);
  const Eigen::Index f = 96;
  const dynamics::SmallMotion motion{random_positive(f, random), 0.1 * random_positive(f, random),
                                     100.0 * random_positive(f, random)};
  const dynamics::VibrationBasis basis = dynamics::make_vibration_basis(motion);
  const Eigen::MatrixXd A = first_order(motion);
  CHECK((A * basis.T - basis.T * block_matrix(basis.blocks)).norm() < 1e-9 * (A * basis.T).norm());
}
