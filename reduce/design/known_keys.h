#pragma once

#include <initializer_list>
#include <string_view>

#include "tools/support/toml/toml.h"

namespace sprung::reduce {

/// Declares all keys of a table at once and rejects every other, before any is read: a misspelt key is then
/// called misspelt, and not the right one missing.
/// @throws support::InputError at the first unknown key, with the nearest known one
void expect_keys(const support::TomlTable& table, std::initializer_list<std::string_view> keys);

}  // namespace sprung::reduce
