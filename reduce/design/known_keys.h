#pragma once

#include <initializer_list>
#include <string_view>

#include "tools/support/toml/toml.h"

namespace sprung::reduce {

/// Declares all keys of a table and rejects every other one before any key is read. The message about a
/// misspelt key then names that key, and does not say that the right one is missing.
/// @throws support::InputError at the first unknown key, with the nearest known one
void expect_keys(const support::TomlTable& table, std::initializer_list<std::string_view> keys);

}  // namespace sprung::reduce
