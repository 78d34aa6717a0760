#include "dynamics/road/road.h"

namespace sprung::dynamics {

int Road::find_segment(double s, bool forward) const {
  int k = 0;
  while (k < num_segments() - 1 && (forward ? s >= segment_end(k) : s > segment_end(k))) ++k;
  return k;
}

}  // namespace sprung::dynamics
