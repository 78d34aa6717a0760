#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>

namespace sprung::support {

/// Exit codes of every program.
enum ExitCode : int { kGood = 0, kCheckFailed = 1, kBadInput = 2, kNumerics = 3, kInterrupted = 130 };

/// The user pressed Ctrl-C (or the process got SIGTERM, or its terminal was closed). What was under way has
/// been closed.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Set by SIGINT, SIGTERM and SIGHUP (unless that was ignored from the start, as by nohup) once `run_program`
/// has started; long work polls it.
bool interrupt_requested();

/// Runs a program's body: installs the signal handlers, turns exceptions into one message on stderr and an
/// exit code (InputError 2, NumericalError 3, Interrupted 130, anything else 3 as an internal error).
int run_program(const char* name, const std::function<int()>& body);

}  // namespace sprung::support
