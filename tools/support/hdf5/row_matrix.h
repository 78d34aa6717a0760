#pragma once

#include <Eigen/Core>

namespace sprung::support {

/// Row-major matrix, the order HDF5 stores.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace sprung::support
