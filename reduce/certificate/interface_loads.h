#pragma once

#include <Eigen/Core>
#include <vector>

namespace sprung::reduce {

/// A freedom of the body that a vehicle loads.
struct InterfaceFreedom {
  int point = 0;    ///< 0-based, of the mesh's named nodes; of several at one node the first
  int node = 0;     ///< 0-based
  int freedom = 0;  ///< 0: x, 1: y, 2: rotation
};

/// Unit loads at the interface. @return 3N×b
Eigen::MatrixXd make_interface_loads(int num_nodes, const std::vector<InterfaceFreedom>& interface);

}  // namespace sprung::reduce
