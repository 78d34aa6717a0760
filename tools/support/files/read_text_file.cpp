#include "tools/support/files/read_text_file.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "tools/support/errors/input_error.h"

namespace sprung::support {

bool is_regular_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

std::string read_text_file(const std::filesystem::path& path) {
  const auto fail = [&path](int reason) {
    return InputError({.path = path.empty() ? "''" : path.string()},
                      fmt::format("cannot be read: {}", std::strerror(reason)));
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw fail(EISDIR);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw fail(errno);
  std::string text;
  constexpr std::size_t kBlock = 65536;
  // Room for all of it at once. Only regular files have a size, and it may change meanwhile.
  const std::uintmax_t size_now = std::filesystem::file_size(path, ignored);
  if (!ignored) text.reserve(static_cast<std::size_t>(size_now) + kBlock);
  while (stream) {
    const std::size_t size = text.size();
    text.resize(size + kBlock);
    stream.read(text.data() + size, kBlock);
    text.resize(size + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw fail(errno);
  return text;
}

}  // namespace sprung::support
