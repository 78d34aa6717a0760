#pragma once

#include <atomic>
#include <cstdio>
#include <functional>
#include <stdexcept>

namespace sprung::support {

/// Exit codes of every program.
enum ExitCode : int { kGood = 0, kCheckFailed = 1, kBadInput = 2, kNumerics = 3, kInterrupted = 130 };

/// Where a command writes its results, and where its warnings, its progress and the reason of its failure.
struct Streams {
  std::FILE* out = stdout;
  std::FILE* err = stderr;
};

/// An interruption that was deferred; it is thrown after open files have been closed.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An interruption is SIGINT (Ctrl-C), SIGTERM, or a SIGHUP (the terminal was closed) that was not ignored
/// from the start, as by nohup. It ends the program there and then, with a message and kInterrupted: no file
/// of ours is ever half-written under its own name. While an object of this class exists, the first
/// interruption is only noted: a calculation that has results to save asks for it repeatedly and then ends in
/// order.
class DeferredInterrupts {
 public:
  DeferredInterrupts();
  ~DeferredInterrupts();
  DeferredInterrupts(const DeferredInterrupts&) = delete;
  DeferredInterrupts& operator=(const DeferredInterrupts&) = delete;
};

/// Whether an interruption has come that was deferred; inside another program, whether that asks for the end.
bool interrupt_requested();

/// Runs a program's body: installs the signal handlers, turns exceptions into one message on stderr and an
/// exit code (InputError 2, NumericalError 3, Interrupted 130, anything else 3 as an internal error).
int run_program(const char* name, const std::function<int()>& body);

/// Runs a body inside another program: as run_program(), but the handlers of signals stay those of that
/// program, and interrupt_requested() asks `is_interrupted`. Not in two threads at a time.
int run_inside(const char* name, const Streams& streams, const std::function<bool()>& is_interrupted,
               const std::function<int()>& body);

}  // namespace sprung::support
