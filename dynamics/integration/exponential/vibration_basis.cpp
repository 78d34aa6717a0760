#include "dynamics/integration/exponential/vibration_basis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr Eigen::Index kMostCoupled = 200;  // modes; the effort grows with the cube: 1 s for 200
constexpr double kFree = 1e-6;  // frequency, of the highest, below which a mode counts as free motion
constexpr double kSlowlyDamped =
    10.0;  // 1/s; free modes that are damped more slowly are not coupled to others
constexpr double kIllConditioned = 1e6;

// Columns that span the invariant subspaces of two dimensions of a real matrix, and the blocks on them. Pair
// k has columns k and n/2 + k.
struct RealPairs {
  Eigen::MatrixXd vectors;
  PairBlocks blocks;
};

RealPairs pair_up(const Eigen::MatrixXd& matrix) {
  const auto eigen = support::solve_general(matrix);
  const Eigen::Index n = matrix.rows(), half = n / 2;
  RealPairs pairs{Eigen::MatrixXd::Zero(n, n), {}};
  if (!eigen) return pairs;
  const Eigen::VectorXcd& values = eigen->values;
  const Eigen::MatrixXd& parts =
      eigen->real_vectors;  // real and imaginary parts side by side, not normalised
  PairBlocks& B = pairs.blocks;
  B.b11 = B.b12 = B.b21 = B.b22 = Eigen::ArrayXd::Zero(half);
  Eigen::Index next = 0;
  std::vector<Eigen::Index> real;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (values[i].imag() == 0.0) {
      real.push_back(i);
    } else if (values[i].imag() > 0.0) {
      // A (x + iy) = (a + ib)(x + iy): A [x y] = [x y] (a b; −b a).
      const double length = parts.middleCols<2>(i).norm();
      pairs.vectors.col(next) = parts.col(i) / length;
      pairs.vectors.col(half + next) = parts.col(i + 1) / length;
      B.b11[next] = B.b22[next] = values[i].real();
      B.b12[next] = values[i].imag();
      B.b21[next] = -values[i].imag();
      ++next;
    }
  }
  for (std::size_t i = 0; i + 1 < real.size(); i += 2, ++next) {
    pairs.vectors.col(next) = parts.col(real[i]).normalized();
    pairs.vectors.col(half + next) = parts.col(real[i + 1]).normalized();
    B.b11[next] = values[real[i]].real();
    B.b22[next] = values[real[i + 1]].real();
  }
  return pairs;
}

// Turns the free modes among each other so that damping does not couple them.
// @param num_free  the first columns of Phi   @param damping  in these modes
// @return the number of those that are hardly damped; they then come first
Eigen::Index separate_free_modes(Eigen::Index num_free, Eigen::MatrixXd& Phi, Eigen::MatrixXd& damping) {
  const Eigen::MatrixXd among = damping.topLeftCorner(num_free, num_free);
  if (num_free == 0 || among.diagonal().maxCoeff() <= kSlowlyDamped) return num_free;
  const auto rates = support::solve_symmetric(0.5 * (among + among.transpose()));
  if (!rates) return num_free;
  const Eigen::MatrixXd& turn = rates->vectors;
  Phi.leftCols(num_free) = (Phi.leftCols(num_free) * turn).eval();
  damping.leftCols(num_free) = (damping.leftCols(num_free) * turn).eval();
  damping.topRows(num_free) = (turn.transpose() * damping.topRows(num_free)).eval();
  return (rates->values.array() <= kSlowlyDamped).count();
}

// Brings the damped motion of the modes from `first` on to pairs, (x, ẋ) = U u. Nothing changes where there
// are too many for it, or where the damped modes nearly coincide.
// @param num_free  lowest ones without a frequency   @param omega  f, ascending   @param blocks, U, inverse_U
// those of the undamped modes
void couple_by_damping(Eigen::Index first, Eigen::Index num_free, const Eigen::ArrayXd& omega,
                       const Eigen::MatrixXd& damping, PairBlocks& blocks, Eigen::MatrixXd& U,
                       Eigen::MatrixXd& inverse_U) {
  const Eigen::Index f = omega.size(), n = f - first;
  if (n == 0 || n > kMostCoupled) return;
  // With wx and ẋ as unknowns the entries that matter are of one size. w is the frequency; free modes take
  // part in slow motion with the lowest one, or have the rate of their damping.
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  const double lowest = num_free < f ? omega[num_free] : std::numeric_limits<double>::infinity();
  Eigen::ArrayXd w = omega.tail(n);
  for (Eigen::Index i = first; i < num_free; ++i) w[i - first] = std::min(lowest, damping(i, i));
  A.topRightCorner(n, n).diagonal() = w;
  A.bottomLeftCorner(n, n).diagonal() = -omega.tail(n);
  A.bottomRightCorner(n, n) = -damping.bottomRightCorner(n, n);
  const RealPairs pairs = pair_up(A);
  const Eigen::MatrixXd inverse = support::solve_lu(pairs.vectors, Eigen::MatrixXd::Identity(2 * n, 2 * n));
  if (!(inverse.allFinite() && inverse.norm() * pairs.vectors.norm() < kIllConditioned)) return;
  const auto scatter = [&](const Eigen::MatrixXd& from, Eigen::MatrixXd& to) {
    to.block(first, first, n, n) = from.topLeftCorner(n, n);
    to.block(first, f + first, n, n) = from.topRightCorner(n, n);
    to.block(f + first, first, n, n) = from.bottomLeftCorner(n, n);
    to.block(f + first, f + first, n, n) = from.bottomRightCorner(n, n);
  };
  Eigen::MatrixXd vectors = pairs.vectors, back = inverse;
  vectors.topRows(n) = w.inverse().matrix().asDiagonal() * vectors.topRows(n);
  back.leftCols(n) = back.leftCols(n) * w.matrix().asDiagonal();
  scatter(vectors, U);
  scatter(back, inverse_U);
  blocks.b11.tail(n) = pairs.blocks.b11;
  blocks.b12.tail(n) = pairs.blocks.b12;
  blocks.b21.tail(n) = pairs.blocks.b21;
  blocks.b22.tail(n) = pairs.blocks.b22;
}

}  // namespace

VibrationBasis make_vibration_basis(const SmallMotion& motion) {
  const Eigen::Index f = motion.mass.rows();
  const auto undamped = support::solve_undamped(motion.stiffness, motion.mass);
  if (!undamped) throw support::NumericalError("the modes of small motion were not found");
  Eigen::MatrixXd Phi = undamped->vectors;  // ascending frequencies
  Eigen::MatrixXd damping = Phi.transpose() * motion.damping * Phi;
  Eigen::ArrayXd omega = undamped->values.cwiseMax(0.0).cwiseSqrt();
  const Eigen::Index num_free = (omega <= kFree * omega[f - 1]).count();
  const Eigen::Index num_undamped = separate_free_modes(num_free, Phi, damping);
  if (num_undamped < num_free) omega.head(num_free) = 0.0;
  const Eigen::MatrixXd inverse_Phi = Phi.transpose() * motion.mass;

  VibrationBasis basis;
  PairBlocks& B = basis.blocks;
  B.b11 = Eigen::ArrayXd::Zero(f);
  B.b12 = Eigen::ArrayXd::Ones(f);
  B.b21 = -omega.square();
  B.b22 = -damping.diagonal().array().max(0.0);
  Eigen::MatrixXd U = Eigen::MatrixXd::Identity(2 * f, 2 * f);  // (x, ẋ) = U u
  Eigen::MatrixXd inverse_U = U;

  couple_by_damping(num_undamped, num_free, omega, damping, B, U, inverse_U);
  basis.T.resize(2 * f, 2 * f);
  basis.inverse.resize(2 * f, 2 * f);
  basis.T.topRows(f) = Phi * U.topRows(f);
  basis.T.bottomRows(f) = Phi * U.bottomRows(f);
  basis.inverse.leftCols(f) = inverse_U.leftCols(f) * inverse_Phi;
  basis.inverse.rightCols(f) = inverse_U.rightCols(f) * inverse_Phi;
  return basis;
}

}  // namespace sprung::dynamics
