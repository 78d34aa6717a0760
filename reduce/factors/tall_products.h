#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace sprung::reduce {

/// Products of matrices with many rows and few columns. From 5000 rows on, long columns are read from memory
/// once, where a product of Eigen's packs them first; below, these are Eigen's products.
using TallMatrix = Eigen::Ref<const Eigen::MatrixXd>;

/// Whether the products of a body with so many freedoms are those of here.
bool is_tall(Eigen::Index num_rows);

/// Aᵀ B.  @param A  n×a   @param B  n×b   @return a×b
Eigen::MatrixXd multiply_transposed(const TallMatrix& A, const TallMatrix& B);

/// Y += A C.  @param A  n×a   @param C  a×b   @param Y  n×b
/// @param vectorised  by the loops of here also where A has few rows
void add_combinations(const TallMatrix& A, const TallMatrix& C, Eigen::Ref<Eigen::MatrixXd> Y);
void add_combinations(const TallMatrix& A, const TallMatrix& C, Eigen::Ref<Eigen::MatrixXd> Y,
                      bool vectorised);

/// Aᵀ X, in which each entry of A is read once for eight columns.  @param A  m×n   @param X  m×k   @return
/// n×k
Eigen::MatrixXd multiply_transposed(const Eigen::SparseMatrix<double>& A, const TallMatrix& X);

/// Vᵀ A V.  @param A  n×n   @param V  n×k   @return k×k
Eigen::MatrixXd project(const Eigen::SparseMatrix<double>& A, const TallMatrix& V);

}  // namespace sprung::reduce
