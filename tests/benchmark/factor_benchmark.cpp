// What a reduction cannot do without: assembling a frame's matrices, analysis and factors of the stiffness,
// solutions for a number of right-hand sides in blocks, and one count of the free modes. Prints a line of
// JSON with the CPU times; tools/benchmark reduce puts them beside those of whole builds. With --cholmod the
// factors and the solutions are those of CHOLMOD: its supernodal Cholesky factors in the order of METIS. With
// --methods N both methods for factors with their solutions, and both for the N lowest modes of the held
// frame.
//
//   factor_benchmark lattice.toml --columns 60 --count-below 12.5
//   factor_benchmark lattice.toml --columns 60 --methods 20

#include <fmt/format.h>
#include <time.h>

#include <CLI/CLI.hpp>
#ifdef SPRUNG_CHOLMOD
#include <Eigen/CholmodSupport>
#endif
#include <algorithm>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "reduce/factors/supernodal_factor.h"
#include "reduce/modes/block_lanczos.h"
#include "reduce/modes/eigenvalue_count.h"
#include "reduce/modes/sparse_eigen_solver.h"
#include "reduce/reduction/body_basis.h"
#include "tools/support/terminal/program.h"

namespace {

using namespace sprung;

constexpr Eigen::Index kBlock = 24;  // right-hand sides that are solved together

double process_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The factors that a build takes. Small ones are Eigen's, whose analysis counts as factorisation.
class OwnFactor {
 public:
  void analyse(const reduce::SparseMatrix& matrix) {
    if (reduce::has_cholmod() && matrix.rows() > reduce::kMostSimplicial)
      supernodes_ = reduce::find_supernodes(matrix);
  }
  void factorise(const reduce::SparseMatrix& matrix) {
    factor_ = supernodes_.order.empty()
                  ? reduce::make_sparse_factor(matrix, true)
                  : reduce::make_supernodal_factor(matrix, true, std::move(supernodes_));
    if (!factor_) throw std::runtime_error("the stiffness is not positive definite to rounding");
  }
  Eigen::MatrixXd solve(const Eigen::MatrixXd& x) const { return factor_->solve(x); }

 private:
  reduce::Supernodes supernodes_;
  std::unique_ptr<reduce::SparseFactor> factor_;
};

// The factors of one method, with their analysis.
template <reduce::FactorMethod method>
class FactorBy {
 public:
  void analyse(const reduce::SparseMatrix&) {}
  void factorise(const reduce::SparseMatrix& matrix) {
    factor_ = reduce::make_sparse_factor(matrix, true, method);
    if (!factor_) throw std::runtime_error("the stiffness is not positive definite to rounding");
  }
  Eigen::MatrixXd solve(const Eigen::MatrixXd& x) const { return factor_->solve(x); }

 private:
  std::unique_ptr<reduce::SparseFactor> factor_;
};

#ifdef SPRUNG_CHOLMOD
class CholmodFactor {
 public:
  CholmodFactor() {
    llt_.cholmod().nmethods = 1;
    llt_.cholmod().method[0].ordering = CHOLMOD_METIS;
  }
  void analyse(const reduce::SparseMatrix& matrix) { llt_.analyzePattern(matrix); }
  void factorise(const reduce::SparseMatrix& matrix) {
    llt_.factorize(matrix);
    if (llt_.info() != Eigen::Success) throw std::runtime_error("CHOLMOD found no factors");
  }
  Eigen::MatrixXd solve(const Eigen::MatrixXd& x) const { return llt_.solve(x); }

 private:
  Eigen::CholmodSupernodalLLT<reduce::SparseMatrix> llt_;
};
#endif

struct Costs {
  double analysis, factor, solutions;  // s
  double checksum;                     // of the solutions

  double total() const { return analysis + factor + solutions; }
};

template <class Factor>
Costs measure(const reduce::SparseMatrix& stiffness, int num_columns) {
  Costs costs{};
  const double start = process_seconds();
  Factor factor;
  factor.analyse(stiffness);
  const double analysed = process_seconds();
  factor.factorise(stiffness);
  const double factored = process_seconds();
  for (Eigen::Index done = 0; done < num_columns; done += kBlock) {
    const Eigen::Index count = std::min(kBlock, num_columns - done);
    costs.checksum += factor.solve(Eigen::MatrixXd::Random(stiffness.rows(), count)).sum();
  }
  costs.analysis = analysed - start;
  costs.factor = factored - analysed;
  costs.solutions = process_seconds() - factored;
  return costs;
}

Costs measure_cholmod([[maybe_unused]] const reduce::SparseMatrix& stiffness,
                      [[maybe_unused]] int num_columns) {
#ifdef SPRUNG_CHOLMOD
  return measure<CholmodFactor>(stiffness, num_columns);
#else
  throw std::runtime_error("this program was built without CHOLMOD");
#endif
}

// Both methods of which kMostSimplicial chooses one, as JSON.
void print_methods(const reduce::BodyMatrices& matrices, int num_columns, int num_modes) {
  using reduce::FactorMethod;
  const reduce::SparseMatrix& stiffness = matrices.free.stiffness;
  const double simplicial = measure<FactorBy<FactorMethod::kSimplicial>>(stiffness, num_columns).total();
  std::string supernodal = "null";
  if (reduce::has_cholmod()) {
    const Costs costs = measure<FactorBy<FactorMethod::kSupernodal>>(stiffness, num_columns);
    supernodal = fmt::format("{:.4f}", costs.total());
  }
  const reduce::ModalProblem held = matrices.make_held();
  const double start = process_seconds();
  const double restarted =
      reduce::solve_by_restarts(held, *matrices.factor, num_modes, 1).omega_squared(num_modes - 1);
  const double middle = process_seconds();
  const double blocked =
      reduce::solve_by_blocks(held, *matrices.factor, num_modes, 1).omega_squared(num_modes - 1);
  const double end = process_seconds();
  fmt::print(R"({{"freedoms": {}, "simplicial": {:.4f}, "supernodal": {}, "restarts": {:.4f}, )"
             R"("blocks": {:.4f}, "difference": {:.1e}}})"
             "\n",
             stiffness.rows(), simplicial, supernodal, middle - start, end - middle,
             blocked / restarted - 1.0);
}

int run(int argc, char** argv) {
  std::string path;
  int num_columns = 60, num_modes = 0;
  double highest_hz = 0.0;
  bool with_cholmod = false;
  CLI::App app("CPU times of factors, solutions and a count, as JSON: see tools/benchmark");
  app.add_option("design", path, "design file")->required();
  app.add_option("--columns", num_columns, "right-hand sides");
  CLI::Option_group* measured = app.add_option_group("measured");
  measured->add_option("--count-below", highest_hz, "of free modes, Hz");
  measured->add_option("--methods", num_modes, "both methods, with this number of modes")
      ->check(CLI::PositiveNumber);
  measured->require_option(1);
  app.add_flag("--cholmod", with_cholmod, "CHOLMOD's factors and solutions");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? support::kGood : support::kBadInput;
  }
  const reduce::Design design = reduce::read_design(path);
  const reduce::BodyMatrices matrices = reduce::make_body_matrices(design);
  if (num_modes > 0) {
    print_methods(matrices, num_columns, num_modes);
    return support::kGood;
  }
  const reduce::SparseMatrix& stiffness = matrices.free.stiffness;
  const Costs costs =
      with_cholmod ? measure_cholmod(stiffness, num_columns) : measure<OwnFactor>(stiffness, num_columns);
  const double start = process_seconds();
  const double omega = 2.0 * std::numbers::pi * highest_hz;
  const int counted = reduce::count_modes_below(matrices.free, omega * omega);
  fmt::print(
      R"({{"freedoms": {}, "analysis": {:.4f}, "factor": {:.4f}, "solutions": {:.4f}, "count": {:.4f}, )"
      R"("free_modes": {}, "checksum": {:.3e}}})"
      "\n",
      stiffness.rows(), costs.analysis, costs.factor, costs.solutions, process_seconds() - start, counted,
      costs.checksum);
  return support::kGood;
}

}  // namespace

int main(int argc, char** argv) {
  return sprung::support::run_program("factor_benchmark", [&] { return run(argc, argv); });
}
