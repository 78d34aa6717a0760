#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace sprung::reduce {

/// Rows and columns of a matrix of a free frame without the three of a node.
/// @param matrix  3N×3N
/// @param node    0-based
/// @return (3N−3)×(3N−3)
Eigen::SparseMatrix<double> remove_node(const Eigen::SparseMatrix<double>& matrix, int node);
/// Rows without the three of a node. @return (3N−3)×n
Eigen::MatrixXd remove_node(const Eigen::MatrixXd& rows, int node);

/// Displacements of all freedoms from those of a frame held at a node: nothing moves there.
/// @param rows  (3N−3)×n   @return 3N×n
Eigen::MatrixXd insert_node(const Eigen::MatrixXd& rows, int node);

}  // namespace sprung::reduce
