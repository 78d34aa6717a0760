#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "fem/beam_element.h"
#include "fem/mesh.h"

namespace sprung::fem {

/// A matrix of zeros with the entries that the elements of a mesh have, and those of each node alone: what
/// matrices of the elements are added to. Made once, it is copied for each sum.
/// @return 3N×3N, compressed
/// Checked by tests/fem/assembly_test.cpp
Eigen::SparseMatrix<double> make_frame_sum(const Mesh& mesh);

/// Adds a matrix of an element, in the order of the freedoms at its ends. The sum of matrices that are
/// exactly symmetric is so, too. @param sum  from make_frame_sum, of the same mesh
void add_at_element(Eigen::SparseMatrix<double>& sum, const Mesh::Element& element, const Matrix6& matrix);

/// Adds to the entries of a node alone. @param sum  as above
void add_at_node(Eigen::SparseMatrix<double>& sum, int node, const Eigen::Matrix3d& matrix);

}  // namespace sprung::fem
