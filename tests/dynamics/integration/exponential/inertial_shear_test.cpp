// Pairs that follow a mass matrix: they stay coordinates of the same states, and their vibration moves the
// freedoms without stiffness as inertia demands.
#include "dynamics/integration/exponential/inertial_shear.h"

#include <Eigen/LU>
#include <random>

#include "tests/catch.h"

using namespace sprung;

namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index cols, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random); });
}

Eigen::MatrixXd random_mass(Eigen::Index n, std::mt19937& random) {
  const Eigen::MatrixXd X = random_matrix(n, n, random);
  return X * X.transpose() / static_cast<double>(n) + 0.1 * Eigen::MatrixXd::Identity(n, n);
}

// Freedoms 1, 2 and 5 deform bodies, stiffly; nothing holds the others.
struct Sheared {
  explicit Sheared(unsigned seed) : random(seed) {
    motion.mass = random_mass(6, random);
    for (const int i : elastic) motion.stiffness(i, i) = 1e6 * (1.0 + i);
    basis = dynamics::make_vibration_basis(motion);
    shear.start(basis, elastic, motion.mass);
  }

  std::mt19937 random;
  const std::vector<int> elastic{1, 2, 5}, others{0, 3, 4};
  dynamics::SmallMotion motion{{}, Eigen::MatrixXd::Zero(6, 6), Eigen::MatrixXd::Zero(6, 6)};
  dynamics::VibrationBasis basis;
  dynamics::InertialShear shear;
};

}  // namespace

TEST_CASE("Shapes of vibration follow the mass matrix: the others keep no momentum", "[analysis]") {
  Sheared s(14);
  REQUIRE(s.shear.is_useful());
  CHECK(s.shear.others() == s.others);
  const double length = 0.3;
  dynamics::ShearCourse course = s.shear.no_course();
  for (int step = 0; step < 2; ++step) {  // to a second mass matrix, then to a third one
    const Eigen::MatrixXd mass = random_mass(6, s.random);
    Eigen::MatrixXd aim;
    REQUIRE(s.shear.calc_shear(mass(Eigen::all, s.others), aim));
    course.set_rate((aim - course.start()) / length);
    const Eigen::MatrixXd pairs = random_matrix(12, 1, s.random);
    Eigen::VectorXd state = s.basis.T * pairs;
    s.shear.add(course, 0.7 * length, state.data());
    s.shear.remove(course, 0.7 * length, state.data());
    CHECK((s.basis.inverse * state - pairs).norm() < 1e-9 * pairs.norm());

    Eigen::MatrixXd T = s.basis.T;
    for (auto column : T.colwise()) s.shear.add(course, length, column.data());
    // Momenta of the others, along pairs that vibrate and along those that do not.
    const Eigen::MatrixXd momenta = mass(s.others, Eigen::all) * T.bottomRows(6);
    const double natural = momenta.cwiseAbs().maxCoeff();
    for (Eigen::Index m = 0; m < 6; ++m) {
      const bool vibrates = s.basis.blocks.determinant(m) > 1.0;
      const double largest = std::max(momenta.col(m).norm(), momenta.col(6 + m).norm());
      CHECK((largest < 1e-9 * natural) == vibrates);
    }
    course.go_on(length);
    CHECK((course.start() - aim).norm() < 1e-12 * aim.norm());
  }
}

// Expected: the definition, u = (S T)⁻¹ y and g = u̇ − B u, with derivatives of S T as products.
TEST_CASE("The drive holds for the rate of the shear, and for another one after a change", "[analysis]") {
  Sheared s(16);
  const double t = 0.4;
  dynamics::ShearCourse course = s.shear.no_course();
  course.set_rate(random_matrix(3, 3, s.random));
  course.go_on(0.2);  // so that there is a shear at the start
  course.set_rate(random_matrix(3, 3, s.random));
  const Eigen::MatrixXd change = 1e6 * random_matrix(3, 3, s.random);
  // Positions, velocities and accelerations there, of any motion.
  const Eigen::VectorXd state = random_matrix(12, 1, s.random), acceleration = random_matrix(6, 1, s.random);
  Eigen::VectorXd derivatives(12);
  derivatives << state.tail(6), acceleration;

  const auto calc_drive = [&](const dynamics::ShearCourse& of) {
    Eigen::VectorXd plain = state;
    s.shear.remove(of, t, plain.data());  // T u
    Eigen::VectorXd rates = derivatives;  // of the state less what Ṡ T u adds
    for (const Eigen::Index half : {0, 6})
      rates.segment(half, 6)(s.others) -= of.rate() * plain.segment(half, 6)(s.elastic);
    s.shear.remove(of, t, rates.data());
    const Eigen::VectorXd u = s.basis.inverse * plain;
    Eigen::VectorXd drive = s.basis.inverse * rates;
    s.basis.blocks.subtract_product(u, drive);
    return drive;
  };
  const Eigen::VectorXd before = calc_drive(course);
  Eigen::VectorXd found = derivatives;
  dynamics::ElasticMotion motion = s.shear.no_motion();
  s.shear.remove_from_derivatives(course, t, state.data(), found.data(), 2, motion);
  Eigen::VectorXd plain = state;
  s.shear.remove(course, t, plain.data());
  dynamics::lobatto::NodeValues drive = dynamics::lobatto::NodeValues::Zero(12, 4);
  drive.col(2) = s.basis.inverse * found;
  s.basis.blocks.subtract_product((s.basis.inverse * plain).eval(), drive.col(2));
  CHECK((drive.col(2) - before).norm() < 1e-9 * before.norm());

  s.shear.change_rate(change, motion, 2, t, s.basis.blocks, drive);
  course.set_rate(course.rate() + change);
  const Eigen::VectorXd after = calc_drive(course);
  CHECK((after - before).norm() > 0.1 * before.norm());
  CHECK((drive.col(2) - after).norm() < 1e-9 * after.norm());
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
