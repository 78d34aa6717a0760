#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace sprung::support {

/// SHA-256 of a sequence of labelled values, independent of how a file stores them. The label and the length
/// of each value are hashed with it, so that two different sequences never give the same bytes.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  void add(std::string_view label, std::string_view text);
  void add(std::string_view label, std::span<const double> values);  ///< bit patterns; -0 counts as 0
  void add(std::string_view label, std::span<const std::int64_t> values);
  std::string hex();  ///< 64 digits; call once

 private:
  void add_header(char type, std::string_view label, std::size_t count);
  void add_bytes(std::string_view bytes);
  void add_integer(std::uint64_t value);
  struct Context;
  std::unique_ptr<Context> context_;
};

/// SHA-256 of a text, 64 hexadecimal digits.
std::string sha256(std::string_view text);

}  // namespace sprung::support
