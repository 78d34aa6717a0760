#include <string>
#include <vector>

#include "dynamics/program/command_line.h"
#include "tools/support/terminal/program.h"

int main(int argc, char** argv) {
  return sprung::support::run_program("sprung-dynamics", [&] {
    return sprung::dynamics::run_arguments(std::vector<std::string>(argv + 1, argv + argc), {});
  });
}
