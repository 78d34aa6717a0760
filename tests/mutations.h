#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sprung::test {

/// Damages texts and binary files at random, from a fixed seed, the same on every machine.
class Mutations {
 public:
  explicit Mutations(std::uint64_t seed) : state_(seed) {}

  /// A copy with one to three kinds of damage: bytes changed, taken out or doubled; a number replaced by one
  /// at the edges of its type; a line taken out, doubled or exchanged with another; the end cut off.
  std::string damage(std::string_view whole);

  /// A copy in which one or two numbers are replaced by others, of any size: what parses still.
  std::string change_numbers(std::string_view whole);

 private:
  std::size_t below(std::size_t limit);  ///< 0 … limit - 1
  std::string any_number();
  void damage_once(std::string& text);
  void replace_number(std::string& text);
  void change_lines(std::string& text);

  std::uint64_t state_;
};

}  // namespace sprung::test
