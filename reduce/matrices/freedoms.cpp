#include "reduce/matrices/freedoms.h"

#include <fmt/format.h>

#include <array>

namespace sprung::reduce {

std::string describe(const Freedom& freedom) {
  if (freedom.direction < 0) {
    return fmt::format("modal freedom {} in direction {}", freedom.node, -freedom.direction);
  }
  if (freedom.is_modal()) return fmt::format("modal freedom {}", freedom.node);
  constexpr std::array<const char*, 7> kNames{
      "", "x", "y", "z", "rotation about x", "rotation about y", "rotation about z"};
  return fmt::format("{} of node {}", kNames[static_cast<std::size_t>(freedom.direction)], freedom.node);
}

int FreedomList::find(const Freedom& freedom) const {
  const auto found = rows_.find(freedom);
  return found == rows_.end() ? -1 : found->second;
}

int FreedomList::get(const Freedom& freedom) {
  const auto [entry, is_new] = rows_.emplace(freedom, size());
  if (is_new) items_.push_back(freedom);
  return entry->second;
}

}  // namespace sprung::reduce
