#pragma once

#include <string>
#include <string_view>

#include "tools/support/toml/toml.h"

namespace sprung::support {

/// Parses a TOML text. Only this function uses the parsing library.
/// @param name  used in place of the path in messages
/// @return the root table, entries in the order of the text, each node with its place and full key
/// @throws InputError at the place where the text is not TOML, or has a date or time, which no key of this
/// project takes
TomlNode parse_toml(std::string_view text, const std::string& name);

}  // namespace sprung::support
