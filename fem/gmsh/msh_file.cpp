#include "fem/gmsh/msh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <string_view>

#include "tools/support/errors/input_error.h"
#include "tools/support/files/read_text_file.h"

namespace sprung::fem {

namespace {

// A cursor in the bytes of the file; `end` stops it at the end of a section.
class Cursor {
 public:
  Cursor(std::string_view bytes, const std::string& path, const char* section)
      : bytes_(bytes), path_(path), section_(section) {}

  bool at_end() {
    skip_blanks();
    return position_ >= bytes_.size();
  }

  std::int64_t read_number() {
    skip_blanks();
    std::int64_t value = 0;
    const auto [next, error] =
        std::from_chars(bytes_.data() + position_, bytes_.data() + bytes_.size(), value);
    if (error != std::errc()) fail("expected a whole number");
    position_ = static_cast<std::size_t>(next - bytes_.data());
    return value;
  }

  std::string_view read_word() {
    skip_blanks();
    const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n", position_), bytes_.size());
    const std::string_view word = bytes_.substr(position_, end - position_);
    position_ = end;
    return word;
  }

  void skip_line() {
    const std::size_t end = bytes_.find('\n', position_);
    position_ = end == std::string_view::npos ? bytes_.size() : end + 1;
  }

  template <class T>
  T read_binary() {
    T value{};
    if (bytes_.size() - position_ < sizeof(T)) fail("truncated");
    std::memcpy(&value, bytes_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    return value;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw support::InputError({.path = path_}, fmt::format("${}: {}", section_, what));
  }

 private:
  void skip_blanks() { position_ = std::min(bytes_.find_first_not_of(" \t\r\n", position_), bytes_.size()); }

  std::string_view bytes_;
  const std::string& path_;
  const char* section_;
  std::size_t position_ = 0;
};

// The bytes of a section, without its first and last line.
std::string_view find_section(std::string_view file, const std::string& path, const char* section) {
  const std::string begin = fmt::format("${}", section);
  std::size_t at = file.substr(0, begin.size()) == begin ? 0 : file.find("\n" + begin);
  if (at == std::string_view::npos) {
    throw support::InputError({.path = path},
                              fmt::format("no section {}; the file is truncated or has no mesh", begin));
  }
  at = std::min(file.find('\n', at + 1), file.size() - 1) + 1;
  const std::size_t end = file.rfind(fmt::format("$End{}", section));
  if (end == std::string_view::npos || end < at) {
    throw support::InputError({.path = path},
                              fmt::format("the file is truncated: section {} has no $End{}", begin, section));
  }
  return file.substr(at, end - at);
}

struct Format {
  std::string version;
  bool is_binary = false;
};

Format read_format(std::string_view file, const std::string& path) {
  if (file.empty()) throw support::InputError({.path = path}, "the file is empty");
  if (file.substr(0, 11) != "$MeshFormat") {
    throw support::InputError({.path = path}, "not a gmsh mesh: the first line is not $MeshFormat");
  }
  Cursor cursor(find_section(file, path, "MeshFormat"), path, "MeshFormat");
  Format format;
  format.version = cursor.read_word();
  format.is_binary = cursor.read_number() == 1;
  if (format.version != "2.2" && format.version != "4.1") {
    throw support::InputError({.path = path},
                              fmt::format("mesh format is {}, expected 2.2 or 4.1", format.version));
  }
  if (const std::int64_t data_size = cursor.read_number(); data_size != 8) {
    cursor.fail(fmt::format("data size is {}, expected 8", data_size));
  }
  if (format.is_binary) {
    cursor.skip_line();
    if (cursor.read_binary<std::int32_t>() != 1) cursor.fail("the file was written with another byte order");
  }
  return format;
}

// The number of nodes of a point or line element; other types are rejected later, so their elements are not
// read.
int get_num_nodes_of_type(std::int64_t type) {
  return type == 1 ? 2 : type == 15 ? 1 : 0;
}

// Negative where an element is taken in the opposite direction.
void check_group(const Cursor& cursor, std::int64_t group) {
  constexpr std::int64_t kLargest = std::numeric_limits<std::int32_t>::max();
  if (group < -kLargest || group > kLargest) {
    cursor.fail(fmt::format("physical group {} is out of range, expected up to {}", group, kLargest));
  }
}

// Each node and each element takes more than one byte.
void check_count(const Cursor& cursor, const char* what, std::int64_t count, std::size_t file_size) {
  if (count >= 0 && static_cast<std::uint64_t>(count) <= file_size) return;
  cursor.fail(fmt::format("declares {} {}, but the file has {} bytes", count, what, file_size));
}

// 4.1: number of blocks, number of nodes or elements, smallest and largest tag.
std::int64_t read_count_of_blocks(Cursor& cursor, bool is_binary) {
  if (!is_binary) {
    cursor.read_number();
    return cursor.read_number();
  }
  cursor.read_binary<std::uint64_t>();
  return cursor.read_binary<std::int64_t>();
}

// gmsh takes as many lines as are declared, and leaves out the others without a word.
void check_lines(const Cursor& cursor, const char* what, std::int64_t declared, std::int64_t found) {
  if (declared != found)
    cursor.fail(fmt::format("declares {} {}, but has lines for {}", declared, what, found));
}

void check_text_nodes(Cursor& cursor, std::int64_t declared) {
  cursor.skip_line();
  std::int64_t found = 0;
  for (; !cursor.at_end(); ++found) cursor.skip_line();
  check_lines(cursor, "nodes", declared, found);
}

void read_text_groups(Cursor& cursor, MshDeclaration& declaration) {
  cursor.skip_line();
  std::int64_t found = 0;
  for (; !cursor.at_end(); ++found) {
    const std::int64_t id = cursor.read_number();
    const std::int64_t type = cursor.read_number();
    const std::int64_t num_tags = cursor.read_number();
    const std::int64_t group = num_tags > 0 ? cursor.read_number() : 0;
    check_group(cursor, group);
    if (get_num_nodes_of_type(type) > 0) declaration.element_groups.emplace(id, static_cast<int>(group));
    cursor.skip_line();
  }
  check_lines(cursor, "elements", declaration.num_elements, found);
}

void read_binary_groups(Cursor& cursor, MshDeclaration& declaration) {
  cursor.skip_line();
  for (std::int64_t read = 0; read < declaration.num_elements;) {
    const auto [type, count, num_tags] = cursor.read_binary<std::array<std::int32_t, 3>>();
    if (get_num_nodes_of_type(type) == 0) return;
    if (count < 1 || num_tags < 0) cursor.fail("truncated");
    for (std::int32_t i = 0; i < count; ++i) {
      const std::int32_t id = cursor.read_binary<std::int32_t>();
      std::int32_t group = 0;
      for (std::int32_t tag = 0; tag < num_tags; ++tag) {
        const std::int32_t value = cursor.read_binary<std::int32_t>();
        if (tag == 0) group = value;
      }
      check_group(cursor, group);
      for (int node = 0; node < get_num_nodes_of_type(type); ++node) cursor.read_binary<std::int32_t>();
      declaration.element_groups.emplace(id, group);
    }
    read += count;
  }
}

}  // namespace

MshDeclaration read_msh_declaration(const std::filesystem::path& path) {
  return parse_msh_declaration(support::read_text_file(path), path.string());
}

MshDeclaration parse_msh_declaration(std::string_view file, const std::string& name) {
  const Format format = read_format(file, name);
  MshDeclaration declaration{.version = format.version};
  Cursor nodes(find_section(file, name, "Nodes"), name, "Nodes");
  Cursor elements(find_section(file, name, "Elements"), name, "Elements");
  const bool in_blocks = format.version == "4.1";
  const auto read_count = [&](Cursor& cursor) {
    return in_blocks ? read_count_of_blocks(cursor, format.is_binary) : cursor.read_number();
  };
  declaration.num_nodes = read_count(nodes);
  check_count(nodes, "nodes", declaration.num_nodes, file.size());
  declaration.num_elements = read_count(elements);
  check_count(elements, "elements", declaration.num_elements, file.size());
  if (in_blocks) return declaration;
  if (format.is_binary) {
    read_binary_groups(elements, declaration);
  } else {
    check_text_nodes(nodes, declaration.num_nodes);
    read_text_groups(elements, declaration);
  }
  return declaration;
}

}  // namespace sprung::fem
