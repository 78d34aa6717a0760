#include "reduce/factors/sparse_factor.h"

#include <Eigen/SparseCholesky>
#include <stdexcept>

#include "reduce/factors/row_major.h"
#include "reduce/factors/supernodal_factor.h"

namespace sprung::reduce {

namespace {

constexpr Eigen::Index kBlock = 32;  // columns solved at a time: L is read once for all of them

class SimplicialFactor final : public SparseFactor {
 public:
  explicit SimplicialFactor(const SparseMatrix& matrix) : factor_(matrix) {}

  bool is_usable(bool is_definite) const {
    if (factor_.info() != Eigen::Success) return false;
    const Eigen::VectorXd D = factor_.vectorD();
    return D.allFinite() && (!is_definite || D.minCoeff() > 0.0);
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& x) const override {
    if (x.cols() == 1) return factor_.solve(x);
    Eigen::MatrixXd solution(x.rows(), x.cols());
    for (Eigen::Index begin = 0; begin < x.cols(); begin += kBlock) {
      const Eigen::Index width = std::min(kBlock, x.cols() - begin);
      RowMajorMatrix block = factor_.permutationP() * x.middleCols(begin, width);
      solve_permuted(block);
      solution.middleCols(begin, width) = factor_.permutationPinv() * block;
    }
    return solution;
  }

  int num_negative() const override { return static_cast<int>((factor_.vectorD().array() < 0.0).count()); }

  std::unique_ptr<SparseFactor> factor_like(const SparseMatrix& matrix) const override {
    return make_sparse_factor(matrix, false, FactorMethod::kSimplicial);
  }

 private:
  // L D Lᵀ x = b in place.
  void solve_permuted(RowMajorMatrix& x) const {
    const SparseMatrix& L = factor_.matrixL().nestedExpression();  // without the diagonal of ones
    const Eigen::VectorXd D = factor_.vectorD();
    for (Eigen::Index j = 0; j < L.cols(); ++j) {
      for (SparseMatrix::InnerIterator entry(L, j); entry; ++entry) {
        if (entry.row() > j) x.row(entry.row()) -= entry.value() * x.row(j);
      }
    }
    x = D.cwiseInverse().asDiagonal() * x;
    for (Eigen::Index j = L.cols(); j-- > 0;) {
      for (SparseMatrix::InnerIterator entry(L, j); entry; ++entry) {
        if (entry.row() > j) x.row(j) -= entry.value() * x.row(entry.row());
      }
    }
  }

  Eigen::SimplicialLDLT<SparseMatrix> factor_;
};

}  // namespace

std::unique_ptr<SparseFactor> make_sparse_factor(const SparseMatrix& matrix, bool is_definite,
                                                 FactorMethod method) {
  if (method == FactorMethod::kSupernodal && !has_cholmod()) {
    throw std::invalid_argument("make_sparse_factor: this program was built without CHOLMOD");
  }
  const bool is_large = method == FactorMethod::kAutomatic && matrix.rows() > kMostSimplicial;
  if (method == FactorMethod::kSupernodal || (is_large && has_cholmod())) {
    return make_supernodal_factor(matrix, is_definite, find_supernodes(matrix));
  }
  auto factor = std::make_unique<SimplicialFactor>(matrix);
  if (!factor->is_usable(is_definite)) return nullptr;
  return factor;
}

}  // namespace sprung::reduce
