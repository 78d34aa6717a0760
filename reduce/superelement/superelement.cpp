#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

int find_point(const Superelement& superelement, const std::string& name) {
  for (const NamedPoint& point : superelement.points) {
    if (point.name == name) return point.node;
  }
  return -1;
}

}  // namespace sprung::reduce
