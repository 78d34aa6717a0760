#include "reduce/modes/sparse_eigen_solver.h"

#include <fmt/format.h>

#include <Spectra/SymGEigsShiftSolver.h>
#include <algorithm>
#include <optional>
#include <stdexcept>

#include "reduce/modes/block_lanczos.h"
#include "reduce/modes/dense_eigen_solver.h"
#include "reduce/modes/random_vectors.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr double kTolerance = 1e-12;  // of a Ritz value, relative
constexpr Eigen::Index kMaxRestarts = 1000;
constexpr int kBeyond =
    5;  // solutions after the last one below a value: the gap has to be seen in which they are counted

// y = s K⁻¹ x. The scale s brings 1/ω² to the order of 1: Spectra's test of convergence is an absolute one
// for values below 4e-11, which is where 1/ω² of a stiff body lies.
class InverseStiffness {
 public:
  using Scalar = double;
  InverseStiffness(const StiffnessFactor& factor, Eigen::Index size, double scale)
      : factor_(&factor), size_(size), scale_(scale) {}
  Eigen::Index rows() const { return size_; }
  Eigen::Index cols() const { return size_; }
  void set_shift(double) {}  // always 0
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd>(y, rows()) =
        scale_ * factor_->solve(Eigen::Map<const Eigen::VectorXd>(x, rows()));
  }

 private:
  const StiffnessFactor* factor_;
  Eigen::Index size_;
  double scale_;
};

class MassProduct {
 public:
  using Scalar = double;
  explicit MassProduct(const ModalProblem& problem) : problem_(&problem) {}
  Eigen::Index rows() const { return problem_->size(); }
  Eigen::Index cols() const { return problem_->size(); }
  void perform_op(const double* x, double* y) const {
    const Eigen::Map<const Eigen::VectorXd> given(x, rows());
    Eigen::Map<Eigen::VectorXd> product(y, rows());
    product = problem_->mass * given;
    if (!problem_->is_free()) return;
    const Eigen::Vector3d rigid = problem_->rigid_share.transpose() * given;
    product.noalias() -= problem_->rigid_share * rigid;
  }

 private:
  const ModalProblem* problem_;
};

// ω² of the lowest mode, roughly: two steps of inverse iteration.
double estimate_lowest(const StiffnessFactor& factor, const ModalProblem& problem,
                       const Eigen::VectorXd& start) {
  Eigen::VectorXd x = factor.solve(problem.times_mass(start).col(0));
  x /= std::sqrt(x.dot(problem.times_mass(x).col(0)));
  const Eigen::VectorXd inertia = problem.times_mass(x);
  const Eigen::VectorXd y = factor.solve(inertia);
  return 1.0 / y.dot(inertia);
}

// One step of subspace iteration and a Rayleigh–Ritz projection in the flipped form: takes the iteration's
// error of 1e-12 down to rounding, and gives M-orthonormal vectors.
EigenPairs polish(const StiffnessFactor& factor, const ModalProblem& problem, const EigenPairs& rough) {
  const Eigen::MatrixXd loads = problem.times_mass(rough.vectors * rough.omega_squared.asDiagonal());
  const Eigen::MatrixXd Y = factor.solve(loads);
  const Eigen::MatrixXd stiffness = multiply_transposed(Y, loads);
  const Eigen::MatrixXd mass = multiply_transposed(Y, problem.times_mass(Y));
  const EigenPairs ritz =
      solve_dense(0.5 * (stiffness + stiffness.transpose()), 0.5 * (mass + mass.transpose()));
  EigenPairs pairs{.omega_squared = ritz.omega_squared,
                   .vectors = Eigen::MatrixXd::Zero(Y.rows(), ritz.vectors.cols())};
  add_combinations(Y, ritz.vectors, pairs.vectors);
  return pairs;
}

// That of the problem, or one that is made for it.
class KnownFactor {
 public:
  explicit KnownFactor(const ModalProblem& problem) : known_(problem.factor) {
    if (known_ == nullptr) own_.emplace(problem.stiffness);
  }
  const StiffnessFactor& operator*() const { return known_ != nullptr ? *known_ : *own_; }

 private:
  const StiffnessFactor* known_;
  std::optional<StiffnessFactor> own_;
};

}  // namespace

EigenPairs solve_sparse_below(const ModalProblem& problem, double omega_squared, std::uint64_t seed) {
  const KnownFactor factor(problem);
  return polish(*factor, problem,
                solve_by_blocks(problem, *factor, {.below = omega_squared, .beyond = kBeyond}, seed));
}

EigenPairs solve_sparse(const ModalProblem& problem, int num_pairs, std::uint64_t seed) {
  const Eigen::Index n = problem.size();
  if (!(num_pairs >= 1 && num_pairs <= problem.num_modes() - 1)) {
    throw std::invalid_argument(
        fmt::format("solve_sparse: num_pairs is {}, expected 1 … {}", num_pairs, problem.num_modes() - 1));
  }
  const KnownFactor factor(problem);
  if (n <= kMostSimplicial) return solve_by_restarts(problem, *factor, num_pairs, seed);
  return polish(*factor, problem, solve_by_blocks(problem, *factor, num_pairs, seed));
}

EigenPairs solve_by_restarts(const ModalProblem& problem, const StiffnessFactor& factor, int num_pairs,
                             std::uint64_t seed) {
  const Eigen::Index n = problem.size();
  const Eigen::VectorXd start = make_random_vector(n, seed);
  const double scale = estimate_lowest(factor, problem, start);
  InverseStiffness inverse(factor, n, scale);
  MassProduct mass(problem);
  const Eigen::Index basis_size =
      std::min<Eigen::Index>(problem.num_modes(), std::max<Eigen::Index>(3 * num_pairs, 20));
  Spectra::SymGEigsShiftSolver<InverseStiffness, MassProduct, Spectra::GEigsMode::ShiftInvert> solver(
      inverse, mass, num_pairs, basis_size, 0.0);
  solver.init(start.data());
  const Eigen::Index converged = solver.compute(Spectra::SortRule::LargestMagn, kMaxRestarts, kTolerance,
                                                Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful) {
    throw support::NumericalError(fmt::format(
        "modes: {} of {} converged after {} restarts to the tolerance {:.0e}; refine the mesh less",
        converged, num_pairs, solver.num_iterations(), kTolerance));
  }
  // The solver's vectors have Φᵀ M Φ = I; its eigenvalues are ω²/s.
  return polish(factor, problem,
                {.omega_squared = solver.eigenvalues() * scale, .vectors = solver.eigenvectors()});
}

}  // namespace sprung::reduce
