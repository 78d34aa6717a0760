#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sprung::reduce {

/// A row of a matrix: a direction of a node. 1, 2, 3 are the displacements along x, y, z, and 4, 5, 6 the
/// rotations about them. Direction 0 is a modal freedom: the amplitude of a shape of a body that was reduced
/// elsewhere, or of an element's internal shape, which has no place; `node` is its number then. Where a
/// number has several, a further one's direction is −2, −3, …
struct Freedom {
  std::int64_t node = 0;
  int direction = 1;
  bool is_modal() const { return direction <= 0; }
  auto operator<=>(const Freedom&) const = default;
};

/// "x of node 12", "rotation about z of node 12", "modal freedom 101", "modal freedom −1 in direction 2".
std::string describe(const Freedom& freedom);

/// The rows of a matrix, in their order.
class FreedomList {
 public:
  int size() const { return static_cast<int>(items_.size()); }
  const Freedom& operator[](int row) const { return items_[static_cast<std::size_t>(row)]; }
  /// @return its row, or −1
  int find(const Freedom& freedom) const;
  /// The row of a freedom, which becomes the last one if it was not there.
  int get(const Freedom& freedom);

 private:
  std::vector<Freedom> items_;
  std::map<Freedom, int> rows_;
};

}  // namespace sprung::reduce
