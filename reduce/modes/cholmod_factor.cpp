#include "reduce/modes/cholmod_factor.h"

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr int kSolvedTogether = 8;  // columns: their sums stay in the registers

// CHOLMOD's parameters, workspace and status. It is not thread-safe.
class CholmodCommon {
 public:
  CholmodCommon() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    common_.postorder = 1;
  }
  ~CholmodCommon() { cholmod_finish(&common_); }
  CholmodCommon(const CholmodCommon&) = delete;
  CholmodCommon& operator=(const CholmodCommon&) = delete;
  cholmod_common* get() { return &common_; }

 private:
  cholmod_common common_ = {};
};

// The lower triangle, in CHOLMOD's own memory.
cholmod_sparse* copy_lower(const SparseMatrix& matrix, cholmod_common* common) {
  const auto n = static_cast<std::size_t>(matrix.rows());
  const auto most = static_cast<std::size_t>((matrix.nonZeros() + matrix.rows()) / 2 + 1);
  cholmod_sparse* lower = cholmod_allocate_sparse(n, n, most, 1, 1, -1, CHOLMOD_REAL, common);
  if (lower == nullptr) return nullptr;
  auto* starts = static_cast<int*>(lower->p);
  auto* rows = static_cast<int*>(lower->i);
  auto* values = static_cast<double*>(lower->x);
  int at = 0;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    starts[j] = at;
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      if (entry.row() < j) continue;
      rows[at] = static_cast<int>(entry.row());
      values[at++] = entry.value();
    }
  }
  starts[n] = at;
  return lower;
}

class CholmodFactor final : public SparseFactor {
 public:
  CholmodFactor(const SparseMatrix& matrix, bool is_definite, std::span<const int> order) {
    cholmod_common* common = common_.get();
    common->supernodal = is_definite ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    common->final_ll = is_definite ? 1 : 0;
    common->method[0].ordering = order.empty() ? CHOLMOD_METIS : CHOLMOD_GIVEN;
    cholmod_sparse* lower = copy_lower(matrix, common);
    std::vector<int> given(order.begin(), order.end());
    if (lower != nullptr) {
      factor_ = cholmod_analyze_p(lower, given.empty() ? nullptr : given.data(), nullptr, 0, common);
      if (factor_ != nullptr) cholmod_factorize(lower, factor_, common);
      cholmod_free_sparse(&lower, common);
    }
    if (common->status < CHOLMOD_OK) {  // positive ones are warnings: a pivot that is not positive
      const int status = common->status;
      cholmod_free_factor(&factor_, common);
      throw support::NumericalError(
          status == CHOLMOD_OUT_OF_MEMORY || status == CHOLMOD_TOO_LARGE
              ? "factors of the stiffness matrix: the memory does not suffice; refine the mesh less"
              : "factors of the stiffness matrix: CHOLMOD failed");
    }
  }
  ~CholmodFactor() override { cholmod_free_factor(&factor_, common_.get()); }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  bool is_usable() const {
    if (factor_ == nullptr || factor_->minor != factor_->n) return false;
    if (factor_->is_super != 0) return true;
    for (std::size_t j = 0; j < factor_->n; ++j) {
      if (!std::isfinite(pivot(j)) || pivot(j) == 0.0) return false;
    }
    return true;
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& x) const override {
    if (factor_->is_super == 0) return solve_simplicial(x);
    Eigen::MatrixXd solution(x.rows(), x.cols());
    for (Eigen::Index begin = 0; begin < x.cols(); begin += kSolvedTogether) {
      const Eigen::Index width = std::min<Eigen::Index>(kSolvedTogether, x.cols() - begin);
      auto solved = solution.middleCols(begin, width);
      if (width == 1) {
        solve_together<1>(x.middleCols(begin, width), solved);
      } else if (width <= kSolvedTogether / 2) {
        solve_together<kSolvedTogether / 2>(x.middleCols(begin, width), solved);
      } else {
        solve_together<kSolvedTogether>(x.middleCols(begin, width), solved);
      }
    }
    return solution;
  }

  int num_negative() const override {
    if (factor_->is_super != 0) return 0;
    int number = 0;
    for (std::size_t j = 0; j < factor_->n; ++j) number += pivot(j) < 0.0 ? 1 : 0;
    return number;
  }

  std::span<const int> order() const override { return {static_cast<const int*>(factor_->Perm), factor_->n}; }

 private:
  // Right-hand sides of which as many lie together as a loop without branches runs over.
  template <int kWidth>
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kWidth, kWidth == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
  template <int kWidth>
  using Row = Eigen::Matrix<double, 1, kWidth>;

  // Columns of L that have their rows in common, a dense matrix: a triangle, and what is below it.
  struct Supernode {
    Eigen::Index first, width, height;  // column; columns and rows
    const double* values;               // height×width
    const int* rows;                    // those below the triangle, height − width

    double diagonal(Eigen::Index j) const { return values[j * height + j]; }
    const double* column(Eigen::Index j) const { return values + j * height; }
  };

  Supernode supernode(std::size_t s) const {
    const int* columns = static_cast<const int*>(factor_->super) + s;
    const int* rows = static_cast<const int*>(factor_->pi) + s;
    const Eigen::Index width = columns[1] - columns[0];
    return {.first = columns[0],
            .width = width,
            .height = rows[1] - rows[0],
            .values = static_cast<const double*>(factor_->x) + static_cast<const int*>(factor_->px)[s],
            .rows = static_cast<const int*>(factor_->s) + rows[0] + width};
  }

  // L Lᵀ x = b. CHOLMOD's own solution spends its time in the system's BLAS, whose reference is slow, and
  // products of matrices copy L before they use it.
  // @param given, solution  n×(up to kWidth)
  template <int kWidth>
  void solve_together(const Eigen::Ref<const Eigen::MatrixXd>& given,
                      Eigen::Ref<Eigen::MatrixXd> solution) const {
    const Eigen::Map<const Eigen::VectorXi> order(static_cast<const int*>(factor_->Perm), given.rows());
    Rows<kWidth> x = Rows<kWidth>::Zero(given.rows(), kWidth);
    x.leftCols(given.cols()) = given(order, Eigen::all);
    Rows<kWidth> gathered(static_cast<Eigen::Index>(factor_->maxesize), kWidth);
    for (std::size_t s = 0; s < factor_->nsuper; ++s) solve_lower<kWidth>(supernode(s), x, gathered);
    for (std::size_t s = factor_->nsuper; s-- > 0;) solve_upper<kWidth>(supernode(s), x, gathered);
    solution(order, Eigen::all) = x.leftCols(given.cols());
  }

  // The supernode's unknowns of L y = b, and their shares in the equations below.
  template <int kWidth>
  static void solve_lower(const Supernode& node, Rows<kWidth>& x, Rows<kWidth>& shares) {
    const Eigen::Index num_below = node.height - node.width;
    shares.topRows(num_below).setZero();
    for (Eigen::Index j = 0; j < node.width; ++j) {
      const double* column = node.column(j);
      const Row<kWidth> solved = x.row(node.first + j) / node.diagonal(j);
      x.row(node.first + j) = solved;
      for (Eigen::Index i = j + 1; i < node.width; ++i) x.row(node.first + i) -= column[i] * solved;
      for (Eigen::Index i = 0; i < num_below; ++i) shares.row(i) += column[node.width + i] * solved;
    }
    for (Eigen::Index i = 0; i < num_below; ++i) x.row(node.rows[i]) -= shares.row(i);
  }

  // The supernode's unknowns of Lᵀ x = y, from those below.
  template <int kWidth>
  static void solve_upper(const Supernode& node, Rows<kWidth>& x, Rows<kWidth>& below) {
    const Eigen::Index num_below = node.height - node.width;
    for (Eigen::Index i = 0; i < num_below; ++i) below.row(i) = x.row(node.rows[i]);
    for (Eigen::Index j = node.width; j-- > 0;) {
      const double* column = node.column(j);
      Row<kWidth> known = Row<kWidth>::Zero();
      for (Eigen::Index i = j + 1; i < node.width; ++i) known += column[i] * x.row(node.first + i);
      for (Eigen::Index i = 0; i < num_below; ++i) known += column[node.width + i] * below.row(i);
      x.row(node.first + j) = (x.row(node.first + j) - known) / node.diagonal(j);
    }
  }

  Eigen::MatrixXd solve_simplicial(const Eigen::MatrixXd& x) const {
    if (x.cols() == 0) return x;
    cholmod_dense given = {};
    given.nrow = given.d = static_cast<std::size_t>(x.rows());
    given.ncol = static_cast<std::size_t>(x.cols());
    given.nzmax = given.nrow * given.ncol;
    given.x = const_cast<double*>(x.data());  // it is only read
    given.xtype = CHOLMOD_REAL;
    given.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* solved = cholmod_solve(CHOLMOD_A, factor_, &given, common_.get());
    if (solved == nullptr) {
      throw support::NumericalError("factors of the stiffness matrix: the memory does not suffice");
    }
    Eigen::MatrixXd solution =
        Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(solved->x), x.rows(), x.cols());
    cholmod_free_dense(&solved, common_.get());
    return solution;
  }

  // D of simplicial factors stands where L has its ones.
  double pivot(std::size_t j) const {
    return static_cast<const double*>(factor_->x)[static_cast<const int*>(factor_->p)[j]];
  }

  mutable CholmodCommon common_;
  cholmod_factor* factor_ = nullptr;
};

}  // namespace

bool has_cholmod() {
  return true;
}

std::unique_ptr<SparseFactor> make_cholmod_factor(const SparseMatrix& matrix, bool is_definite,
                                                  std::span<const int> order) {
  auto factor = std::make_unique<CholmodFactor>(matrix, is_definite, order);
  if (!factor->is_usable()) return nullptr;
  return factor;
}

}  // namespace sprung::reduce
