#include "tools/support/terminal/program.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <new>
#include <stdexcept>

#include "tests/catch.h"
#include "tests/tools/support/child_process.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/errors/numerical_error.h"

using namespace sprung::support;

namespace {

ChildResult run(const std::function<int()>& body) {
  return run_in_child([&] { return run_program("sprung-test", body); });
}

}  // namespace

TEST_CASE("a program's exit code is what its body returns") {
  CHECK(run([] { return static_cast<int>(kGood); }).exit_code == 0);
  const ChildResult failed = run([] { return static_cast<int>(kCheckFailed); });
  CHECK(failed.exit_code == 1);
  CHECK(failed.output.empty());
}

TEST_CASE("a program turns each exception into its exit code and one message") {
  const ChildResult input = run([]() -> int { throw InputError({"a.toml", 3, 1}, "unknown key 'x'"); });
  CHECK(input.exit_code == 2);
  CHECK(input.output == "a.toml:3:1: error: unknown key 'x'\n");

  const ChildResult numerics = run([]() -> int { throw NumericalError("no convergence at t = 0.1 s"); });
  CHECK(numerics.exit_code == 3);
  CHECK(numerics.output == "sprung-test: error: no convergence at t = 0.1 s\n");

  const ChildResult interrupted = run([]() -> int { throw Interrupted("r.partial.h5 is incomplete"); });
  CHECK(interrupted.exit_code == 130);
  CHECK(interrupted.output == "sprung-test: interrupted: r.partial.h5 is incomplete\n");

  const ChildResult memory = run([]() -> int { throw std::bad_alloc(); });
  CHECK(memory.exit_code == 3);
  CHECK(memory.output == "sprung-test: internal error: out of memory\n");

  const ChildResult ours =
      run([]() -> int { throw std::invalid_argument("beam: length must be > 0 m, got 0"); });
  CHECK(ours.exit_code == 3);
  CHECK(ours.output == "sprung-test: internal error: beam: length must be > 0 m, got 0\n");

  const ChildResult foreign = run([]() -> int { throw 7; });
  CHECK(foreign.exit_code == 3);
  CHECK(foreign.output == "sprung-test: internal error: an exception of unknown type\n");
}

TEST_CASE("the message comes after what was printed before") {
  const ChildResult result = run([]() -> int {
    std::fputs("step 1\n", stdout);
    throw NumericalError("stuck");
  });
  CHECK(result.output == "step 1\nsprung-test: error: stuck\n");
}

TEST_CASE("an interruption ends the program where it is, with a message") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP);
  std::signal(signal, SIG_DFL);  // nohup has the program ignore SIGHUP
  const ChildResult result = run([signal]() -> int {
    { const DeferredInterrupts earlier; }
    std::raise(signal);
    return 50;
  });
  CHECK(result.exit_code == 130);
  CHECK(result.output == "sprung-test: interrupted: the files made before are whole\n");
}

TEST_CASE("the first interruption that is deferred sets a flag and does not end the program") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP);
  std::signal(signal, SIG_DFL);  // nohup has the program ignore SIGHUP
  const ChildResult result = run([signal]() -> int {
    const DeferredInterrupts deferred;
    if (interrupt_requested()) return 50;
    std::raise(signal);
    if (!interrupt_requested()) return 51;
    throw Interrupted("closed");
  });
  CHECK(result.exit_code == 130);
  CHECK(result.output == "sprung-test: interrupted: closed\n");
}

TEST_CASE("the second interruption that is deferred ends the program at once") {
  const ChildResult result = run([]() -> int {
    const DeferredInterrupts deferred;
    std::raise(SIGINT);
    std::raise(SIGINT);
    return 50;
  });
  CHECK(result.signal == SIGINT);
  CHECK(result.exit_code == -1);
}

TEST_CASE("a program under nohup continues when its terminal is closed") {
  std::signal(SIGHUP, SIG_IGN);
  const ChildResult result = run([]() -> int {
    std::raise(SIGHUP);
    return interrupt_requested() ? 50 : 7;
  });
  std::signal(SIGHUP, SIG_DFL);
  CHECK(result.exit_code == 7);
}

TEST_CASE("a file-size limit and a closed pipe are errors of the write, not signals") {
  const ChildResult result = run([] {
    std::raise(SIGXFSZ);
    std::raise(SIGPIPE);
    return 7;
  });
  CHECK(result.exit_code == 7);
}

TEST_CASE("output that does not reach the disk is an error") {
  const ChildResult result = run([] {
    const int full = ::open("/dev/full", O_WRONLY);
    ::dup2(full, STDOUT_FILENO);
    std::fputs("result\n", stdout);
    return static_cast<int>(kGood);
  });
  CHECK(result.exit_code == 2);
  CHECK(result.output == "sprung-test: error: standard output cannot be written: No space left on device\n");
}

TEST_CASE("a reader that closes the pipe is no error") {
  const ChildResult result = run([] {
    int ends[2] = {};
    if (::pipe(ends) != 0) return 50;
    ::close(ends[0]);
    ::dup2(ends[1], STDOUT_FILENO);
    std::fputs("result\n", stdout);
    return static_cast<int>(kGood);
  });
  CHECK(result.exit_code == 0);
  CHECK(result.output.empty());
}
