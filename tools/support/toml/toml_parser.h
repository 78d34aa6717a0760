#pragma once

#include <string>
#include <string_view>

#include "tools/support/toml/toml.h"

namespace sprung::support {

/// Parses a TOML text; the only place that knows the parsing library.
/// @param name  stands for the path in messages
/// @return the root table, entries in the order of the text, each node with its place and full key
/// @throws InputError at the place of the fault: not TOML, or a date or time, which no input of ours has
TomlNode parse_toml(std::string_view text, const std::string& name);

}  // namespace sprung::support
