#include "tools/support/terminal/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>
#include <utility>

#include "tools/support/errors/input_error.h"
#include "tools/support/errors/numerical_error.h"
#include "tools/support/files/unfinished_file.h"
#include "tools/support/terminal/print.h"

namespace sprung::support {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

std::atomic<int> num_deferrals{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler reads it");

const char* program_name = "";

const std::function<bool()>* question = nullptr;  // of the program that we are inside of, if there is one

// Only calls that are safe in a signal handler.
[[noreturn]] void end_at_once() {
  remove_unfinished_files();
  for (const char* text : {program_name, ": interrupted: the files made before are whole\n"})
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  ::_exit(kInterrupted);
}

// Where interruptions are deferred, the first one is noted; the second ends the process at once, as usual.
void handle_interrupt(int signal) {
  if (num_deferrals == 0) end_at_once();
  if (interrupted.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

void install_signal_handlers() {
  interrupted = false;
  struct sigaction action = {};
  action.sa_handler = handle_interrupt;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // SIGHUP comes when the terminal is closed. Under nohup it is ignored and stays so.
  struct sigaction inherited = {};
  sigaction(SIGHUP, nullptr, &inherited);
  if (inherited.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  // A full quota or a closed pipe shall be an error of the write, with a message, not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

// A file that is opened must not get the number of a standard stream that was closed, whose messages would go
// into it. Standard output stays one that cannot be written.
void keep_standard_streams_apart() {
  for (const auto& [stream, access] :
       {std::pair{STDIN_FILENO, O_RDONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_WRONLY}}) {
    if (::fcntl(stream, F_GETFD) == -1) ::open("/dev/null", access);  // the lowest number that is free
  }
}

// Prints a message after the output so far. If its stream itself is closed, nothing can be done.
void print_message(const Streams& streams, std::string_view text) {
  std::fflush(streams.out);
  write_text(streams.err, text);
  write_text(streams.err, "\n");
}

// The reader of the output may end first (`| head`), which is not an error.
int finish_output(const char* name, const Streams& streams, int code) {
  errno = 0;
  const bool failed = std::fflush(streams.out) != 0 || std::ferror(streams.out) != 0;
  const int reason = errno != 0 ? errno : last_write_error();
  if (!failed || reason == EPIPE) return code;
  print_message(streams,
                fmt::format("{}: error: standard output cannot be written: {}", name, std::strerror(reason)));
  return code == kGood ? kBadInput : code;
}

int run_body(const char* name, const Streams& streams, const std::function<int()>& body) {
  try {
    return finish_output(name, streams, body());
  } catch (const InputError& error) {
    print_message(streams, error.what());
    return kBadInput;
  } catch (const NumericalError& error) {
    print_message(streams, fmt::format("{}: error: {}", name, error.what()));
    return kNumerics;
  } catch (const Interrupted& error) {
    print_message(streams, fmt::format("{}: interrupted: {}", name, error.what()));
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    print_message(streams, fmt::format("{}: internal error: out of memory", name));
  } catch (const std::exception& error) {
    print_message(streams, fmt::format("{}: internal error: {}", name, error.what()));
  } catch (...) {
    print_message(streams, fmt::format("{}: internal error: an exception of unknown type", name));
  }
  return kNumerics;
}

}  // namespace

DeferredInterrupts::DeferredInterrupts() {
  ++num_deferrals;
}

DeferredInterrupts::~DeferredInterrupts() {
  --num_deferrals;
}

bool interrupt_requested() {
  return question ? (*question)() : interrupted.load(std::memory_order_relaxed);
}

int run_program(const char* name, const std::function<int()>& body) {
  program_name = name;
  keep_standard_streams_apart();
  install_signal_handlers();
  return run_body(name, {}, body);
}

int run_inside(const char* name, const Streams& streams, const std::function<bool()>& is_interrupted,
               const std::function<int()>& body) {
  const std::function<bool()>* const outer = std::exchange(question, &is_interrupted);
  const int code = run_body(name, streams, body);  // which throws nothing
  question = outer;
  return code;
}

}  // namespace sprung::support
