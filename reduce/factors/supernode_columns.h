#pragma once

#include <Eigen/Core>

namespace sprung::reduce {

/// Columns of the factor L of L D Lᵀ that have their rows in common, a dense matrix: a triangle with the
/// entries of D in place of its diagonal of ones, and what is below it.
struct SupernodeColumns {
  Eigen::Index first = 0;              ///< the first column
  Eigen::Index width = 0, height = 0;  ///< columns and rows
  double* values = nullptr;            ///< height×width
  const int* rows = nullptr;           ///< height, ascending

  double* column(Eigen::Index j) const { return values + j * height; }
  const int* rows_below() const { return rows + width; }
  Eigen::Index num_below() const { return height - width; }
};

/// Right-hand sides that are solved together: eight, four or one.
inline constexpr int kMostTogether = 8;

/// The supernode's unknowns of L y = b, and their shares in the equations below.
/// @param num_together  k
/// @param x             n×k, those of one unknown side by side
/// @param work          as many as rows below, times k
void solve_lower(const SupernodeColumns& node, int num_together, double* x, double* work);

/// The supernode's unknowns of D Lᵀ x = y, from those below. Parameters as above.
void solve_upper(const SupernodeColumns& node, int num_together, double* x, double* work);

}  // namespace sprung::reduce
