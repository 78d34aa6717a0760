#include <cstddef>
#include <string>
#include <vector>

#include "dynamics/program/command_line.h"
#include "tools/support/processes/large_heap.h"
#include "tools/support/terminal/program.h"

// Bytes that a run of an ordinary vehicle uses. In small pages the system takes a fifth of the time of a
// short run to hand them out.
constexpr std::size_t kHeap = std::size_t{64} << 20U;

int main(int argc, char** argv) {
  sprung::support::prepare_large_heap(kHeap);
  return sprung::support::run_program("sprung-dynamics", [&] {
    return sprung::dynamics::run_arguments(std::vector<std::string>(argv + 1, argv + argc), {});
  });
}
