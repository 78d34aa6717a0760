// Road tables: an InputError, or a road whose height is a number wherever it is asked for.
#include <cmath>
#include <cstdlib>

#include "dynamics/input/road_input.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const sprung::fuzz::MemoryFile file(data, size);
  sprung::dynamics::RoadDescription description;
  description.shape = "table";
  description.file = file.path();
  try {
    const auto road = sprung::dynamics::make_road(description);
    for (const double s : {-1.0, 0.0, 0.3, 7.0, 1e6}) {
      if (!std::isfinite(road->height(s))) std::abort();
    }
  } catch (const sprung::support::InputError&) {
  }
  return 0;
}
