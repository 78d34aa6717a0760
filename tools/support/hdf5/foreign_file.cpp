#include "tools/support/hdf5/foreign_file.h"

#include <array>
#include <fstream>

#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::support {

namespace {

bool has_hdf5_signature(const std::filesystem::path& path) {
  constexpr std::array<char, 8> kSignature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  std::array<char, 8> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  return start == kSignature;
}

}  // namespace

bool is_foreign_file(const std::filesystem::path& path, std::string_view format) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || std::filesystem::file_size(path, error) == 0)
    return false;
  if (!has_hdf5_signature(path)) return true;
  try {
    const Hdf5Reader file(path);
    return !file.has_attribute("/", "format") || file.string_attribute("/", "format") != format;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace sprung::support
