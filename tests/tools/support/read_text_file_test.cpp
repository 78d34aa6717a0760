#include "tools/support/files/read_text_file.h"

#include <string>

#include "tests/catch.h"
#include "tests/tools/support/error_message.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/errors/input_error.h"

using sprung::support::InputError;
using sprung::support::read_text_file;

TEST_CASE("a text file is read byte by byte, whatever its size") {
  const TemporaryFolder folder;
  const std::string text = GENERATE(std::string(), std::string("a\r\nb\0c\n", 7), std::string(65536, 'x'),
                                    std::string(200001, 'y'));
  write_bytes(folder / "file.txt", text);
  CHECK(read_text_file(folder / "file.txt") == text);
}

TEST_CASE("a text file that cannot be read is named with the reason") {
  const TemporaryFolder folder;
  const std::string place = folder.path().string();
  CHECK(error_message<InputError>([&] { read_text_file(folder / "none.toml"); }) ==
        place + "/none.toml: error: cannot be read: No such file or directory");
  CHECK(error_message<InputError>([&] { read_text_file(folder.path()); }) ==
        place + ": error: cannot be read: Is a directory");
  write_bytes(folder / "file", "text");
  CHECK(error_message<InputError>([&] { read_text_file(folder / "file/x.toml"); }) ==
        place + "/file/x.toml: error: cannot be read: Not a directory");
}
