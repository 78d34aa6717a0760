// Pairs that follow a mass matrix: they stay coordinates of the same states, and their vibration moves the
// freedoms without stiffness as inertia demands.
#include "dynamics/integration/exponential/inertial_shear.h"

#include <Eigen/LU>
#include <random>

#include "tests/catch.h"

using namespace sprung;

namespace {

Eigen::MatrixXd random_mass(Eigen::Index n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd X = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
  return X * X.transpose() / static_cast<double>(n) + 0.1 * Eigen::MatrixXd::Identity(n, n);
}

}  // namespace

TEST_CASE("Shapes of vibration follow the mass matrix: the others keep no momentum", "[analysis]") {
  std::mt19937 random(14);
  // Freedoms 1, 2 and 5 deform bodies, stiffly; nothing holds the others.
  const std::vector<int> elastic{1, 2, 5}, others{0, 3, 4};
  dynamics::SmallMotion motion{random_mass(6, random), Eigen::MatrixXd::Zero(6, 6),
                               Eigen::MatrixXd::Zero(6, 6)};
  for (const int i : elastic) motion.stiffness(i, i) = 1e6 * (1.0 + i);
  const dynamics::VibrationBasis basis = dynamics::make_vibration_basis(motion);
  dynamics::InertialShear shear;
  const auto to_states = [&](const Eigen::MatrixXd& pairs) {
    Eigen::MatrixXd states = basis.T * pairs;
    for (auto state : states.colwise()) shear.add(state.data());
    return states;
  };
  std::normal_distribution<double> normal;
  shear.start(basis, elastic, motion.mass);
  REQUIRE(shear.is_useful());
  CHECK(shear.others() == others);

  for (int time = 0; time < 2; ++time) {  // the second mass matrix, then a third one
    const Eigen::MatrixXd mass = random_mass(6, random);
    Eigen::MatrixXd pairs = Eigen::MatrixXd::NullaryExpr(12, 3, [&] { return normal(random); });
    const Eigen::MatrixXd states = to_states(pairs);
    REQUIRE(shear.follow(mass(Eigen::all, others)));
    shear.convert(pairs);
    CHECK((to_states(pairs) - states).norm() < 1e-9 * states.norm());
    Eigen::VectorXd state = states.col(0);
    shear.remove(state.data());
    CHECK((basis.inverse * state - pairs.col(0)).norm() < 1e-9 * pairs.norm());

    const Eigen::MatrixXd T = to_states(Eigen::MatrixXd::Identity(12, 12));
    // Momenta of the others, along pairs that vibrate and along those that do not.
    const Eigen::MatrixXd momenta = mass(others, Eigen::all) * T.bottomRows(6);
    const double natural = momenta.cwiseAbs().maxCoeff();
    for (Eigen::Index m = 0; m < 6; ++m) {
      const bool vibrates = basis.blocks.determinant(m) > 1.0;
      const double largest = std::max(momenta.col(m).norm(), momenta.col(6 + m).norm());
      CHECK((largest < 1e-9 * natural) == vibrates);
    }
  }
}

TEST_CASE("Without elastic freedoms, or without others, there is nothing to follow", "[analysis]") {
  std::mt19937 random(15);
  const dynamics::SmallMotion motion{random_mass(2, random), Eigen::MatrixXd::Zero(2, 2),
                                     1e3 * Eigen::MatrixXd::Identity(2, 2)};
  const dynamics::VibrationBasis basis = dynamics::make_vibration_basis(motion);
  dynamics::InertialShear shear;
  shear.start(basis, {}, motion.mass);
  CHECK_FALSE(shear.is_useful());
  shear.start(basis, {0, 1}, motion.mass);
  CHECK_FALSE(shear.is_useful());
}
