#pragma once

#include <string>
#include <string_view>

#include "tools/support/toml/toml.h"

namespace sprung::support {

/// `parent.part`, the part in quotes if TOML requires them; the part alone if the parent is the root, whose
/// key is
/// "".
std::string join_key(std::string_view parent, std::string_view part);

/// Type and value of a node, for messages: `a string "heavy"`, `a number 3.5`, `a table` …
std::string describe(const TomlNode& node);

/// The shortest text that reads back as the same number.
std::string format_number(double value);

/// Why a number cannot be read, though it is written as one: it is beyond double precision or, without point
/// and exponent, beyond 64 bits. "" for all other text.
std::string describe_unreadable_number(std::string_view text);

/// Where a key of more than `most` parts begins, as its offset: `a.b.c` has three. None is npos. Comments and
/// strings are passed over.
std::size_t find_deep_key(std::string_view text, std::size_t most);

}  // namespace sprung::support
