#include "dynamics/bodies/body_mass.h"

#include <Eigen/Dense>
#include <cstdlib>
#include <vector>

#include "tests/catch.h"

using namespace sprung;

namespace {

enum class Kind { kDiagonal, kRankThree, kFull };

// A body of n modes with an M_ff of that kind, and a definite mass matrix.
dynamics::Body make_body(Eigen::Index n, Kind kind) {
  std::srand(7);
  dynamics::Body body;
  body.mass = 1000.0;
  body.first_moment = {120.0, -80.0};
  body.second_moment = 900.0;
  body.P = 3.0 * Eigen::Matrix2Xd::Random(2, n);
  body.c = 3.0 * Eigen::RowVectorXd::Random(n);
  body.d = Eigen::RowVectorXd::Random(n);
  body.M_ff = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd part = Eigen::MatrixXd::Random(n, kind == Kind::kRankThree ? 3 : n);
  if (kind != Kind::kDiagonal) body.M_ff += 2.0 * part * part.transpose();
  body.M_tt = Eigen::MatrixXd::Zero(n, n);
  body.B = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) body.mode_numbers.push_back(static_cast<int>(k) + 1);
  return body;
}

}  // namespace

// The dense factorisation of the same matrix is the expected solution.
TEST_CASE("the factorised mass matrix solves as the matrix itself, for every kind of M_ff") {
  for (const Kind kind : {Kind::kDiagonal, Kind::kRankThree, Kind::kFull}) {
    const dynamics::Body body = make_body(9, kind);
    dynamics::BodyMass mass(body);
    const Eigen::VectorXd eta = 1e-3 * Eigen::VectorXd::Random(9);
    mass.update(dynamics::FrameRotation::from_angle(0.4), eta);
    const Eigen::MatrixXd M = mass.matrix().selfadjointView<Eigen::Upper>();
    const Eigen::VectorXd load = Eigen::VectorXd::Random(12);
    Eigen::VectorXd x = load;
    mass.solve(x.data());
    const Eigen::VectorXd expected = M.ldlt().solve(load);
    CHECK((x - expected).norm() < 1e-11 * expected.norm());

    // U V^T of two rows G is G M^-1 G^T.
    const Eigen::Matrix2Xd G = Eigen::Matrix2Xd::Random(2, 12);
    const Eigen::RowVectorXd upper = G.row(0), lower = G.row(1);
    std::vector<Eigen::Vector2d> U(12), V(12);
    mass.reduce_rows(upper.data(), lower.data(), U.data(), V.data());
    Eigen::Matrix2d product = Eigen::Matrix2d::Zero();
    for (std::size_t k = 0; k < 12; ++k) product += U[k] * V[k].transpose();
    const Eigen::Matrix2d direct = G * M.ldlt().solve(G.transpose());
    CHECK((product - direct).norm() < 1e-11 * direct.norm());
  }
}
