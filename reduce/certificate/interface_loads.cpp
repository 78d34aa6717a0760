#include "reduce/certificate/interface_loads.h"

namespace sprung::reduce {

Eigen::MatrixXd make_interface_loads(int num_nodes, const std::vector<InterfaceFreedom>& interface) {
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(3 * num_nodes, static_cast<Eigen::Index>(interface.size()));
  for (std::size_t j = 0; j < interface.size(); ++j) {
    loads(3 * interface[j].node + interface[j].freedom, static_cast<Eigen::Index>(j)) = 1.0;
  }
  return loads;
}

}  // namespace sprung::reduce
