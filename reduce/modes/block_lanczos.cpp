#include "reduce/modes/block_lanczos.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "reduce/modes/random_vectors.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
constexpr Index kWidth = 4;
constexpr double kRitzResidual = 1e-12;  // of a solution, relative
constexpr double kRoughResidual =
    1e-5;  // of those of which only the frequency counts: it has the square of this
constexpr double kDependent = 1e-14;  // the part of a vector outside the vectors before, beside the first one
constexpr double kMostVectors = 20.0;   // for each pair asked for
constexpr double kBetweenTests = 1.05;  // growth of the number of vectors from one test of convergence on

// A block and its product with the mass.
struct Block {
  MatrixXd vectors;  // n×b
  MatrixXd momenta;  // n×b
};

// Makes a block M-orthonormal and leaves out directions that hardly exist: V = W S, and gives R with W = V R.
MatrixXd orthonormalize(Block& block, double smallest) {
  if (block.vectors.cols() == 0) return MatrixXd(0, 0);
  const MatrixXd product = multiply_transposed(block.vectors, block.momenta);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(0.5 * (product + product.transpose()));
  const Eigen::VectorXd length = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const auto kept = static_cast<Index>((length.array() > smallest).count());
  const MatrixXd directions = eigen.eigenvectors().rightCols(kept);
  const MatrixXd scaled = directions * length.tail(kept).cwiseInverse().asDiagonal();
  block.vectors = (block.vectors * scaled).eval();
  block.momenta = (block.momenta * scaled).eval();
  return length.tail(kept).asDiagonal() * directions.transpose();
}

// The M-orthonormal vectors V, and the block-tridiagonal matrix T = Vᵀ M s K⁻¹ M V.
class Lanczos {
 public:
  Lanczos(const ModalProblem& problem, const StiffnessFactor& factor, Index num_pairs, std::uint64_t seed)
      : problem_(&problem), factor_(&factor), num_pairs_(num_pairs) {
    const Index n = problem.size();
    vectors_.resize(n, std::min(n, 6 * num_pairs + 32 * kWidth));  // memory is taken as they come
    MatrixXd start(n, kWidth);
    for (Index j = 0; j < kWidth; ++j)
      start.col(j) = make_random_vector(n, seed * kWidth + static_cast<std::uint64_t>(j));
    // One step with K⁻¹ M takes out what has no mass.
    next_.vectors = factor.solve(problem_->times_mass(start));
    next_.momenta = problem_->times_mass(next_.vectors);
    orthonormalize(next_, 0.0);
    const MatrixXd y = factor.solve(next_.momenta);
    scale_ = 1.0 / (y.transpose() * next_.momenta).trace() * static_cast<double>(kWidth);
    next_.momenta = problem_->times_mass(next_.vectors);
    orthonormalize(next_, 0.0);
  }

  Index size() const { return size_; }
  bool is_exhausted() const { return next_.vectors.cols() == 0; }

  // Takes the next block in and makes the one after it.
  void step() {
    const Index width = next_.vectors.cols(), begin = size_;
    append();
    Block block{.vectors = scale_ * factor_->solve(next_.momenta), .momenta = {}};
    if (coupling_.size() > 0)
      add_combinations(vectors_.middleCols(begin - coupling_.cols(), coupling_.cols()),
                       -coupling_.transpose(), block.vectors);
    const MatrixXd own = multiply_transposed(next_.momenta, block.vectors);
    add_combinations(next_.vectors, -own, block.vectors);
    projected_.block(begin, begin, width, width) = 0.5 * (own + own.transpose());
    block.momenta = problem_->times_mass(block.vectors);
    const MatrixXd first = orthonormalize(block, kDependent * largest_);
    const auto before = vectors_.leftCols(size_);
    add_combinations(before, -multiply_transposed(before, block.momenta), block.vectors);
    block.momenta = problem_->times_mass(block.vectors);
    const MatrixXd second = orthonormalize(block, 1e-3);
    coupling_ = second * first;
    next_ = std::move(block);
  }

  // The pairs wanted, once all have converged.
  std::optional<EigenPairs> find_converged(const WantedPairs& wanted) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(projected_);
    largest_ = eigen.eigenvalues()(size_ - 1);
    // No Ritz value is below the solution that it approaches, so that none is counted that is not there.
    const auto num_below = (scale_ * eigen.eigenvalues().array().inverse() < wanted.below).count();
    const Index num_exact = std::max<Index>(wanted.lowest, num_below);
    num_pairs_ = num_exact + wanted.beyond;
    if (size_ < num_pairs_) return std::nullopt;
    const MatrixXd ritz = eigen.eigenvectors().rightCols(num_pairs_).rowwise().reverse();
    const Eigen::VectorXd theta = eigen.eigenvalues().tail(num_pairs_).reverse();
    const MatrixXd residual = coupling_ * ritz.bottomRows(coupling_.cols());
    for (Index i = 0; i < num_pairs_; ++i) {
      if (residual.col(i).norm() > (i < num_exact ? kRitzResidual : kRoughResidual) * theta(i))
        return std::nullopt;
    }
    EigenPairs pairs{.omega_squared = scale_ * theta.cwiseInverse(),
                     .vectors = MatrixXd::Zero(vectors_.rows(), num_pairs_)};
    add_combinations(vectors_.leftCols(size_), ritz, pairs.vectors);
    return pairs;
  }

  // As far as is known: of all below a value those that were found.
  Index num_pairs() const { return num_pairs_; }

 private:
  void append() {
    const Index width = next_.vectors.cols(), end = size_ + width;
    if (end > vectors_.cols()) vectors_.conservativeResize(Eigen::NoChange, end + end / 2);
    vectors_.middleCols(size_, width) = next_.vectors;
    projected_.conservativeResize(end, end);
    projected_.rightCols(width).setZero();
    projected_.bottomRows(width).setZero();
    if (coupling_.size() > 0) {
      projected_.block(size_, size_ - coupling_.cols(), width, coupling_.cols()) = coupling_;
      projected_.block(size_ - coupling_.cols(), size_, coupling_.cols(), width) = coupling_.transpose();
    }
    size_ = end;
  }

  const ModalProblem* problem_;
  const StiffnessFactor* factor_;
  Index num_pairs_;
  double scale_ = 1.0;    // s brings 1/ω² to the order of 1
  double largest_ = 1.0;  // of T's eigenvalues
  Index size_ = 0;
  MatrixXd vectors_;    // n×(size or more)
  MatrixXd projected_;  // T
  MatrixXd coupling_;   // R of the next block to the last
  Block next_;
};

}  // namespace

EigenPairs solve_by_blocks(const ModalProblem& problem, const StiffnessFactor& factor,
                           const WantedPairs& wanted, std::uint64_t seed) {
  Lanczos lanczos(problem, factor, wanted.lowest + wanted.beyond, seed);
  const auto limit = [&] {
    return std::min(static_cast<double>(problem.num_modes()),
                    kMostVectors * static_cast<double>(lanczos.num_pairs()) + 100.0);
  };
  auto test_at = static_cast<double>(lanczos.num_pairs());
  while (!lanczos.is_exhausted() && static_cast<double>(lanczos.size()) < limit()) {
    lanczos.step();
    if (static_cast<double>(lanczos.size()) < test_at && !lanczos.is_exhausted()) continue;
    if (std::optional<EigenPairs> pairs = lanczos.find_converged(wanted)) return std::move(*pairs);
    test_at = kBetweenTests * static_cast<double>(lanczos.size());
  }
  throw support::NumericalError(fmt::format(
      "modes: {} were not found with {} vectors: more of them have one frequency than the {} of a block, or "
      "the mesh is too fine",
      lanczos.num_pairs(), lanczos.size(), kWidth));
}

EigenPairs solve_by_blocks(const ModalProblem& problem, const StiffnessFactor& factor, int num_pairs,
                           std::uint64_t seed) {
  return solve_by_blocks(problem, factor, WantedPairs{.lowest = num_pairs}, seed);
}

}  // namespace sprung::reduce
