#include "reduce/certificate/interface_residual.h"

#include <Eigen/Dense>
#include <cmath>

#include "tests/catch.h"
#include "tests/reduce/certificate/certified_frame.h"

namespace sprung::reduce {
namespace {

using testing::CertifiedFrame;

// The flexibility is solved from the full model; D is made from products of the basis.
void check_bounds(std::uint64_t seed) {
  const CertifiedFrame frame(seed, 3);
  for (int step = 1; step <= 25; ++step) {
    const double s = frame.highest * step / 25.0, factor = 1.0 / (1.0 - s / frame.cutoff);
    if (testing::is_resonance(frame.truth, s)) continue;  // both flexibilities are infinite
    INFO("seed " << seed << ", step " << step);
    const Eigen::VectorXd error = frame.calc_true_errors(s).real();
    const Eigen::VectorXd D = frame.residual->calc_errors(s, frame.residual->calc_amplitudes(s));
    const Eigen::VectorXd rounding = 1e-8 * frame.residual->static_flexibility();
    CHECK((error - D + rounding).minCoeff() >= 0.0);
    CHECK((factor * D - error + rounding).minCoeff() >= 0.0);
    const double loss_factor = 0.04;
    const Eigen::VectorXd damped = frame.calc_true_errors(s, loss_factor).cwiseAbs();
    const Eigen::VectorXd bound = factor * frame.residual->calc_damped_errors(s, loss_factor);
    CHECK((bound - damped + rounding).minCoeff() >= 0.0);
  }
}

TEST_CASE("the true error of 200 random frames lies between D and D/(1 − s/λ_c), damped below the bound") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) check_bounds(seed);
}

// Without damping both are the same sum; the amplitudes are Galerkin's in both.
TEST_CASE("without a loss factor the damped error is the undamped one") {
  const CertifiedFrame frame(8, 2);
  const double s = 0.7 * frame.highest;
  const Eigen::VectorXd D = frame.residual->calc_errors(s, frame.residual->calc_amplitudes(s));
  CHECK((frame.residual->calc_damped_errors(s, 0.0) - D).cwiseAbs().maxCoeff() <= 1e-12 * D.maxCoeff());
}

TEST_CASE("the static flexibility is that of the full model without rigid motion") {
  const CertifiedFrame frame(4, 0);
  const Eigen::VectorXd expected =
      frame.truth.calc_flexibility_at_rest(frame.design.reduction.interface).diagonal();
  const Eigen::VectorXd found = frame.residual->static_flexibility();
  CHECK((found.cwiseQuotient(expected).array() - 1.0).abs().maxCoeff() < 1e-9);
}

TEST_CASE("loads that are added later have the errors of loads given at the beginning") {
  const CertifiedFrame frame(3, 3);
  const Eigen::Index few = frame.loads.cols() - 2;
  InterfaceResidual later(frame.matrices.free, *frame.factor, frame.modes.pairs, frame.loads.leftCols(few));
  InterfaceResidual whole(frame.matrices.free, *frame.factor, frame.modes.pairs, frame.loads);
  for (InterfaceResidual* residual : {&later, &whole}) residual->add(frame.residual->ritz().vectors);
  later.add_loads(frame.loads.rightCols(2));
  const double s = 0.8 * frame.highest;
  const auto calc_error = [s](const InterfaceResidual& residual) -> Eigen::MatrixXd {
    return residual.calc_error_matrix(residual.calc_load_work(), s, residual.calc_amplitudes(s));
  };
  const Eigen::MatrixXd expected = calc_error(whole);
  REQUIRE(later.num_loads() == whole.num_loads());
  CHECK((calc_error(later) - expected).cwiseAbs().maxCoeff() < 1e-12 * expected.cwiseAbs().maxCoeff());
  CHECK(later.static_flexibility().isApprox(whole.static_flexibility(), 1e-12));
}

TEST_CASE("the diagonal of the error matrix is the error of each load, and the matrix is not negative") {
  const CertifiedFrame frame(2, 3);
  const double s = 0.9 * frame.highest;
  const Eigen::MatrixXd y = frame.residual->calc_amplitudes(0.5 * frame.highest);
  const Eigen::MatrixXd D = frame.residual->calc_error_matrix(frame.residual->calc_load_work(), s, y);
  const double scale = D.cwiseAbs().maxCoeff();
  CHECK((D.diagonal() - frame.residual->calc_errors(s, y)).cwiseAbs().maxCoeff() < 1e-12 * scale);
  CHECK(D.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() > -1e-12 * scale);
}

TEST_CASE("a vector made from the residual lessens the error of its load") {
  CertifiedFrame frame(6, 1);
  const double s = frame.highest;
  for (int i = 0; i < 4; ++i) {
    Eigen::Index worst = 0;
    const Eigen::VectorXd before = frame.residual->calc_errors(s, frame.residual->calc_amplitudes(s));
    before.maxCoeff(&worst);
    frame.residual->add(frame.residual->make_vector(worst, s));
    const Eigen::VectorXd after = frame.residual->calc_errors(s, frame.residual->calc_amplitudes(s));
    CHECK(after(worst) < 0.9 * before(worst));
  }
}

}  // namespace
}  // namespace sprung::reduce
