#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sprung::support {

/// A place in the user's input: in a file, or on the command line.
struct SourceLocation {
  std::string path;  ///< file as the user named it, or the name of a command-line option
  int line = 0;      ///< 1-based; 0 for the file as a whole
  int column = 0;    ///< 1-based; 0 when unknown
};

/// `path:line:column`, without the parts that are unknown.
std::string format_place(const SourceLocation& where);

/// Untrusted input (a file, the command line) that cannot be used. Only `run_program` catches it: exit
/// code 2.
///
/// what() is `path:line:column: error: message`, without the parts that are unknown. The message says what
/// was found and what was expected, with the unit.
class InputError : public std::runtime_error {
 public:
  InputError(const SourceLocation& where, std::string_view message);
};

/// Whether a name consists of letters, digits, '_' and '-' alone, as those in a vehicle do.
bool is_plain_name(std::string_view name);

/// The candidate that is spelt most like `name`; "" if none is similar.
std::string find_nearest_name(std::string_view name, std::span<const std::string> candidates);

/// ` (did you mean 'mass'?)` with the candidate that is spelt most like `name`; "" if none is similar.
std::string nearest_name_hint(std::string_view name, std::span<const std::string> candidates);

}  // namespace sprung::support
