#pragma once

#include <functional>
#include <string>

/// How a child process ended, and what it printed to stdout and stderr.
struct ChildResult {
  int exit_code = -1;  ///< -1 where a signal ended it
  int signal = 0;
  std::string output;
};

/// Runs `function` in a child process, which then ends by std::exit with the value returned (so that what a
/// library does at exit is run too), or with 99 after an exception.
ChildResult run_in_child(const std::function<int()>& function);
