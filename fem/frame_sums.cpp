#include "fem/frame_sums.h"

#include <algorithm>
#include <vector>

namespace sprung::fem {

namespace {

// Adds to the entries in the rows of one node and the columns of another.
void add_block(Eigen::SparseMatrix<double>& sum, int row_node, int column_node,
               const Eigen::Matrix3d& block) {
  const int* starts = sum.outerIndexPtr() + 3 * column_node;
  const int* rows = sum.innerIndexPtr() + starts[0];
  int place = 0;
  while (rows[place] != 3 * row_node) place += 3;
  for (int j = 0; j < 3; ++j) Eigen::Map<Eigen::Vector3d>(sum.valuePtr() + starts[j] + place) += block.col(j);
}

}  // namespace

Eigen::SparseMatrix<double> make_frame_sum(const Mesh& mesh) {
  const auto num_nodes = static_cast<std::size_t>(mesh.num_nodes());
  std::vector<std::vector<int>> neighbours(num_nodes);
  for (std::size_t node = 0; node < num_nodes; ++node) neighbours[node].push_back(static_cast<int>(node));
  for (const Mesh::Element& element : mesh.elements) {
    neighbours[static_cast<std::size_t>(element.first)].push_back(element.second);
    neighbours[static_cast<std::size_t>(element.second)].push_back(element.first);
  }
  Eigen::Index num_entries = 0;
  for (std::vector<int>& nodes : neighbours) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    num_entries += 9 * std::ssize(nodes);
  }
  Eigen::SparseMatrix<double> sum(3 * mesh.num_nodes(), 3 * mesh.num_nodes());
  sum.resizeNonZeros(num_entries);
  std::fill_n(sum.valuePtr(), num_entries, 0.0);
  int* starts = sum.outerIndexPtr();
  int* row = sum.innerIndexPtr();
  for (const std::vector<int>& nodes : neighbours) {
    for (int component = 0; component < 3; ++component) {
      for (const int node : nodes) {
        for (int i = 0; i < 3; ++i) *row++ = 3 * node + i;
      }
      starts[1] = starts[0] + 3 * static_cast<int>(nodes.size());
      ++starts;
    }
  }
  return sum;
}

void add_at_element(Eigen::SparseMatrix<double>& sum, const Mesh::Element& element, const Matrix6& matrix) {
  add_block(sum, element.first, element.first, matrix.topLeftCorner<3, 3>());
  add_block(sum, element.first, element.second, matrix.topRightCorner<3, 3>());
  add_block(sum, element.second, element.first, matrix.bottomLeftCorner<3, 3>());
  add_block(sum, element.second, element.second, matrix.bottomRightCorner<3, 3>());
}

void add_at_node(Eigen::SparseMatrix<double>& sum, int node, const Eigen::Matrix3d& matrix) {
  add_block(sum, node, node, matrix);
}

}  // namespace sprung::fem
