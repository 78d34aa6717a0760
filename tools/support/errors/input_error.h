#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sprung::support {

/// A place in something the user gave us: a file, or a word of the command line.
struct SourceLocation {
  std::string path;  ///< file as the user named it, or the name of a command-line option
  int line = 0;      ///< 1-based; 0 when the file as a whole is meant
  int column = 0;    ///< 1-based; 0 when unknown
};

/// Untrusted input (a file, the command line) that cannot be used. Only `run_program` catches it: exit
/// code 2.
///
/// what() reads `path:line:column: error: message`, with the parts that are unknown left out. The message
/// says what was found and what was expected, with the unit.
class InputError : public std::runtime_error {
 public:
  InputError(const SourceLocation& where, std::string_view message);
};

/// The candidate nearest to `name`; "" where none is near.
std::string find_nearest_name(std::string_view name, std::span<const std::string> candidates);

/// ` (did you mean 'mass'?)` for the candidate nearest to `name`, or nothing where none is near.
std::string nearest_name_hint(std::string_view name, std::span<const std::string> candidates);

}  // namespace sprung::support
