#include "tools/support/processes/limited_child.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <new>

#include "tests/catch.h"
#include "tests/tools/support/child_process.h"
#include "tests/tools/support/error_message.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/terminal/program.h"

using namespace sprung::support;

namespace {

std::string failure_of(const std::function<std::string()>& work, const ChildLimits& limits = {}) {
  return error_message<ChildFailure>([&] { run_in_limited_child("library", work, limits); });
}

}  // namespace

TEST_CASE("What a child process returns comes through, of any size and with any byte") {
  std::string bytes(3 << 20, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7);
  CHECK(run_in_limited_child("library", [&] { return bytes; }, {}) == bytes);
  CHECK(run_in_limited_child("library", [] { return std::string(); }, {}).empty());
}

TEST_CASE("Each bad end of a child process is told and harms nothing") {
  CHECK(failure_of([]() -> std::string { throw std::runtime_error("wrong tag 7"); }) == "wrong tag 7");
  CHECK(failure_of([]() -> std::string { throw 7; }) == "an exception of unknown type");
  CHECK(failure_of([]() -> std::string { throw std::bad_alloc(); }) ==
        "library asked for more than 4.0 GiB of memory");
  CHECK(failure_of([]() -> std::string {
          ::raise(SIGSEGV);
          return {};
        }) == "library crashed (Segmentation fault)");
  CHECK(failure_of([]() -> std::string { ::_exit(0); }) == "library ended without a word");
  const std::string endless = failure_of(
      []() -> std::string {
        for (volatile unsigned i = 0; true;) i = i + 1;
      },
      {.processor_seconds = 1});
  INFO(endless);
  CHECK((endless == "library was stopped, after 1 s of processor time or for want of memory" ||
         endless == "library came to no end within 10 s"));  // where others take the processors
  CHECK(::waitpid(-1, nullptr, WNOHANG) < 0);                // no child is left to wait for
  CHECK(errno == ECHILD);
}

TEST_CASE("A child process reads nothing, prints nothing and writes no file") {
  const TemporaryFolder folder;
  const std::string file = (folder / "written").string();
  const ChildResult result = run_in_child([&] {
    const std::string read = run_in_limited_child(
        "library",
        [&] {
          std::cout << "printed" << std::endl;
          std::cerr << "printed" << std::endl;
          std::ofstream(file) << "some text" << std::flush;
          return std::string(std::cin.get() == EOF ? "nothing to read" : "something to read");
        },
        {});
    return read == "nothing to read" ? 0 : 1;
  });
  CHECK(result.exit_code == 0);
  CHECK(result.output.empty());
  CHECK(read_bytes(file).empty());
}

TEST_CASE("An interruption ends the child and the program") {
  const ChildResult result = run_in_child([] {
    return run_program("sprung-test", []() -> int {
      const pid_t parent = ::getpid();
      run_in_limited_child("library",
                           [parent]() -> std::string {
                             ::kill(parent, SIGTERM);
                             for (;;) ::pause();
                           },
                           {});
      return kGood;
    });
  });
  CHECK(result.exit_code == kInterrupted);
  CHECK(result.output == "sprung-test: interrupted: the files made before are whole\n");
}
