#include "dynamics/measured/text_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/support/errors/input_error.h"

namespace sprung::dynamics {

namespace {

// The number of bytes of the character that begins here, or 0 if none does.
std::size_t character_size(std::string_view rest) {
  const auto byte = static_cast<unsigned char>(rest[0]);
  if (byte < 0x80) return byte >= 0x20 || (byte >= '\t' && byte <= '\r') || byte == 0x1A ? 1 : 0;
  const std::size_t size = byte >= 0xF5 ? 0 : byte >= 0xF0 ? 4 : byte >= 0xE0 ? 3 : byte >= 0xC2 ? 2 : 0;
  if (rest.size() < size) return 0;
  for (std::size_t k = 1; k < size; ++k) {
    if ((static_cast<unsigned char>(rest[k]) & 0xC0U) != 0x80U) return 0;
  }
  return size;
}

// What the file may be, for the message.
std::string_view guess_encoding(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return "UTF-16";
  const bool has_controls = std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x80 && character_size({&c, 1}) == 0;
  });
  if (has_controls) return "binary data or another encoding";
  return "Latin-1 or Windows-1252; convert it by iconv -f WINDOWS-1252 -t UTF-8 OLD > NEW";
}

}  // namespace

void check_text(std::string_view text, const std::string& path, int lines_before) {
  support::SourceLocation place{path, 1, 1};
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character_size(text.substr(at));
    if (size == 0 && place.line > lines_before) {
      throw support::InputError(
          place, fmt::format("is no text: got the byte 0x{:02X}, as of {}; expected UTF-8 or ASCII",
                             static_cast<unsigned char>(text[at]), guess_encoding(text)));
    }
    const std::size_t step = size == 0 ? 1 : size;
    place.column += static_cast<int>(step);
    if (text[at] == '\n') place = {path, place.line + 1, 1};
    at += step;
  }
}

}  // namespace sprung::dynamics
