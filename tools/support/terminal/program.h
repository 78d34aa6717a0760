#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>

namespace sprung::support {

/// Exit codes of every program.
enum ExitCode : int { kGood = 0, kCheckFailed = 1, kBadInput = 2, kNumerics = 3, kInterrupted = 130 };

/// The user pressed Ctrl-C, or the process received SIGTERM, or its terminal was closed. It is thrown after
/// open files have been closed.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether SIGINT, SIGTERM or SIGHUP has arrived since `run_program` started. A SIGHUP that was ignored from
/// the start, as by nohup, does not count. Long calculations ask this repeatedly.
bool interrupt_requested();

/// Runs a program's body: installs the signal handlers, turns exceptions into one message on stderr and an
/// exit code (InputError 2, NumericalError 3, Interrupted 130, anything else 3 as an internal error).
int run_program(const char* name, const std::function<int()>& body);

}  // namespace sprung::support
