#include "tools/support/terminal/program.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <set>
#include <stdexcept>
#include <string>

#include "tests/catch.h"
#include "tests/tools/support/child_process.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/errors/numerical_error.h"
#include "tools/support/hdf5/hdf5_file.h"
#include "tools/support/terminal/print.h"
#include "tools/support/terminal/progress_bar.h"

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

TEST_CASE("an interruption removes the file that is being written, and no other one") {
  const TemporaryFolder folder;
  Hdf5Writer(folder / "whole.h5").commit();
  const ChildResult result = run([&]() -> int {
    Hdf5Writer(folder / "earlier.h5").commit();
    Hdf5Writer first(folder / "first.h5"), second(folder / "whole.h5");
    Hdf5Writer kept(folder / "run.h5", folder / "run.partial.h5");
    kept.flush();
    kept.copy_to_partial();
    std::raise(SIGTERM);
    return 50;
  });
  CHECK(result.exit_code == 130);
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder / ""))
    names.insert(entry.path().filename().string());
  CHECK(names == std::set<std::string>{"earlier.h5", "run.partial.h5", "whole.h5"});
  const Hdf5Reader whole(folder / "whole.h5"), partial(folder / "run.partial.h5");
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

namespace {

struct Inside {
  int exit_code;
  std::string out, err;
};

// Runs a body with streams in memory.
Inside run_in_memory(const std::function<bool()>& is_interrupted,
                     const std::function<int(const Streams&)>& body) {
  std::array<char*, 2> texts{};
  std::array<std::size_t, 2> sizes{};
  const Streams streams{open_memstream(&texts[0], &sizes[0]), open_memstream(&texts[1], &sizes[1])};
  const int code = run_inside("sprung-test", streams, is_interrupted, [&] { return body(streams); });
  std::fclose(streams.out);
  std::fclose(streams.err);
  Inside result{code, texts[0], texts[1]};
  for (char* text : texts) std::free(text);
  return result;
}

bool never() {
  return false;
}

}  // namespace

TEST_CASE("a body inside another program prints to its streams and gives the exit codes of a program") {
  const Inside good = run_in_memory(never, [](const Streams& streams) {
    std::fputs("step 1\n", streams.out);
    return 7;
  });
  CHECK(good.exit_code == 7);
  CHECK(good.out == "step 1\n");
  CHECK(good.err.empty());

  const Inside bad = run_in_memory(never, [](const Streams&) -> int {
    throw InputError({"a.toml", 3, 1}, "unknown key 'x'");
  });
  CHECK(bad.exit_code == 2);
  CHECK(bad.err == "a.toml:3:1: error: unknown key 'x'\n");
  CHECK(run_in_memory(never, [](const Streams&) -> int { throw NumericalError("stuck"); }).exit_code == 3);
}

TEST_CASE("a body inside another program asks that for interruptions and leaves the signals alone") {
  const auto handler = std::signal(SIGINT, SIG_IGN);
  bool asked = false;
  const Inside result = run_in_memory(
      [&] {
        asked = true;
        return true;
      },
      [](const Streams&) {
        const DeferredInterrupts deferred;
        std::raise(SIGINT);  // which the other program ignores
        // A body within the body has its own question; afterwards that of the outer one counts again.
        const Inside inner =
            run_in_memory(never, [](const Streams&) { return interrupt_requested() ? 1 : 0; });
        return inner.exit_code == 0 && interrupt_requested() ? 5 : 6;
      });
  CHECK(result.exit_code == 5);
  CHECK(asked);
  CHECK(std::signal(SIGINT, handler) == SIG_IGN);
  CHECK_FALSE(interrupt_requested());
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

TEST_CASE("a message that cannot be written does not end the program") {
  const ChildResult result = run([] {
    const int full = ::open("/dev/full", O_WRONLY);
    ::dup2(full, STDERR_FILENO);
    {
      ProgressBar bar("run", false, stderr);
      for (int i = 0; i <= 100; ++i) bar.update(0.01 * i);
      bar.finish();
    }
    print(stderr, "warning: {}\n", "nobody reads this");
    std::fputs("result\n", stdout);
    return static_cast<int>(kGood);
  });
  CHECK(result.exit_code == 0);
}

TEST_CASE("a file does not get the number of a standard stream that was closed") {
  const ChildResult result = run_in_child([] {
    for (const int stream : {STDIN_FILENO, STDERR_FILENO}) ::close(stream);
    return run_program("sprung-test", [] { return ::open("/dev/null", O_RDONLY); });
  });
  CHECK(result.exit_code > STDERR_FILENO);
}

TEST_CASE("output that fails before the end tells its reason") {
  const ChildResult result = run([] {
    const int full = ::open("/dev/full", O_WRONLY);
    ::dup2(full, STDOUT_FILENO);
    print(stdout, "{}\n", std::string(100'000, '.'));
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
