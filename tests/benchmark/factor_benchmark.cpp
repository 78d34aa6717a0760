// What a reduction cannot do without: assembling a frame's matrices, analysis and factors of the stiffness,
// solutions for a number of right-hand sides in blocks, and one count of the free modes. Prints a line of
// JSON with the CPU times; tools/benchmark reduce puts them beside those of whole builds. With --cholmod the
// factors and the solutions are those of CHOLMOD: its supernodal Cholesky factors in the order of METIS.
//
//   factor_benchmark lattice.toml --columns 60 --count-below 12.5

#include <fmt/format.h>
#include <time.h>

#include <CLI/CLI.hpp>
#ifdef SPRUNG_CHOLMOD
#include <Eigen/CholmodSupport>
#endif
#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <string>

#include "reduce/modes/eigenvalue_count.h"
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

#ifdef SPRUNG_CHOLMOD
class CholmodFactor {
 public:
  explicit CholmodFactor(const reduce::SparseMatrix& matrix) {
    llt_.cholmod().nmethods = 1;
    llt_.cholmod().method[0].ordering = CHOLMOD_METIS;
    llt_.compute(matrix);
    if (llt_.info() != Eigen::Success) throw std::runtime_error("CHOLMOD found no factors");
  }
  Eigen::MatrixXd solve(const Eigen::MatrixXd& x) const { return llt_.solve(x); }

 private:
  Eigen::CholmodSupernodalLLT<reduce::SparseMatrix> llt_;
};
#endif

struct Costs {
  double factor, solutions;  // s
  double checksum;           // of the solutions
};

template <class Factor>
Costs measure(const reduce::SparseMatrix& stiffness, int num_columns) {
  Costs costs{};
  const double start = process_seconds();
  const Factor factor(stiffness);
  const double factored = process_seconds();
  for (Eigen::Index done = 0; done < num_columns; done += kBlock) {
    const Eigen::Index count = std::min(kBlock, num_columns - done);
    costs.checksum += factor.solve(Eigen::MatrixXd::Random(stiffness.rows(), count)).sum();
  }
  costs.factor = factored - start;
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

int run(int argc, char** argv) {
  std::string path;
  int num_columns = 60;
  double highest_hz = 0.0;
  bool with_cholmod = false;
  CLI::App app("CPU times of factors, solutions and a count, as JSON: see tools/benchmark");
  app.add_option("design", path, "design file")->required();
  app.add_option("--columns", num_columns, "right-hand sides");
  app.add_option("--count-below", highest_hz, "of free modes, Hz")->required();
  app.add_flag("--cholmod", with_cholmod, "CHOLMOD's factors and solutions");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? support::kGood : support::kBadInput;
  }
  const reduce::Design design = reduce::read_design(path);
  const reduce::BodyMatrices matrices = reduce::make_body_matrices(design);
  const reduce::SparseMatrix& stiffness = matrices.free.stiffness;
  const Costs costs = with_cholmod ? measure_cholmod(stiffness, num_columns)
                                   : measure<reduce::StiffnessFactor>(stiffness, num_columns);
  const double start = process_seconds();
  const double omega = 2.0 * std::numbers::pi * highest_hz;
  const int counted = reduce::count_modes_below(matrices.free, omega * omega);
  fmt::print(R"({{"freedoms": {}, "factor": {:.4f}, "solutions": {:.4f}, "count": {:.4f}, "free_modes": {}, )"
             R"("checksum": {:.3e}}})"
             "\n",
             stiffness.rows(), costs.factor, costs.solutions, process_seconds() - start, counted,
             costs.checksum);
  return support::kGood;
}

}  // namespace

int main(int argc, char** argv) {
  return sprung::support::run_program("factor_benchmark", [&] { return run(argc, argv); });
}
