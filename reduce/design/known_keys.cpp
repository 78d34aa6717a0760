#include "reduce/design/known_keys.h"

namespace sprung::reduce {

void expect_keys(const support::TomlTable& table, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) static_cast<void>(table.has(key));
  table.reject_unknown_keys();
}

}  // namespace sprung::reduce
