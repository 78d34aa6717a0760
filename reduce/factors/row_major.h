#pragma once

#include <Eigen/Core>

namespace sprung::reduce {

/// Vectors side by side, of which the values of one freedom lie together: an element's matrix is read once
/// for all of them.
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace sprung::reduce
