#include "tools/support/files/temporary_file.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/catch.h"
#include "tests/tools/support/child_process.h"
#include "tests/tools/support/error_message.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/errors/input_error.h"

using namespace sprung::support;

namespace {

void write_into(const TemporaryFile& file, const std::string& text) {
  std::ofstream(file.path()) << text;
}

}  // namespace

TEST_CASE("a temporary file becomes the target, or goes away") {
  const TemporaryFolder folder;
  write_bytes(folder / "a", "earlier");
  {
    const TemporaryFile file(folder / "a");
    write_into(file, "given up");
  }
  CHECK(read_bytes(folder / "a") == "earlier");
  {
    TemporaryFile file(folder / "a");
    write_into(file, "new");
    file.rename_to_target();
  }
  CHECK(read_bytes(folder / "a") == "new");
  CHECK_FALSE(std::filesystem::exists(folder / "a.tmp"));
}

TEST_CASE("a second writer is refused before it has changed the file of the first") {
  const TemporaryFolder folder;
  TemporaryFile first(folder / "a");
  write_into(first, "of the first");
  CHECK(error_message<InputError>([&] { TemporaryFile(folder / "a"); }) ==
        (folder / "a").string() + ": error: cannot be written: another writer is at '" +
            (folder / "a.tmp").string() + "'");
  first.rename_to_target();
  CHECK(read_bytes(folder / "a") == "of the first");
  const TemporaryFile second(folder / "a");  // now it may
}

TEST_CASE("what a killed program has left is taken over") {
  const TemporaryFolder folder;
  const ChildResult result = run_in_child([&] {
    const TemporaryFile file(folder / "a");
    write_into(file, "half");
    return ::raise(SIGKILL);
  });
  CHECK(result.signal == SIGKILL);
  CHECK(read_bytes(folder / "a.tmp") == "half");
  TemporaryFile file(folder / "a");
  write_into(file, "whole");
  file.rename_to_target();
  CHECK(read_bytes(folder / "a") == "whole");
}

TEST_CASE(
    "a file that another program has removed or replaced is not renamed, and the other one is not removed") {
  const TemporaryFolder folder;
  {
    TemporaryFile file(folder / "a");
    std::filesystem::remove(folder / "a.tmp");
    write_bytes(folder / "a.tmp", "of another program");
    CHECK(error_message<InputError>([&] { file.rename_to_target(); }) ==
          (folder / "a").string() + ": error: cannot be written: another program has removed or replaced '" +
              (folder / "a.tmp").string() + "'");
  }
  CHECK(read_bytes(folder / "a.tmp") == "of another program");
  CHECK_FALSE(std::filesystem::exists(folder / "a"));
}

TEST_CASE("a file that is left stays where it is") {
  const TemporaryFolder folder;
  {
    TemporaryFile file(folder / "a");
    write_into(file, "whole");
    file.leave();
  }
  CHECK(read_bytes(folder / "a.tmp") == "whole");
}
