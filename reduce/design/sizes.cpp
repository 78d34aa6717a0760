#include "reduce/design/sizes.h"

#include <fmt/format.h>

namespace sprung::reduce {

double read_size(const support::TomlTable& table, std::string_view key, std::string_view unit,
                 const SizeRange& range) {
  const double size = table.number(key, support::positive(unit));
  if (size >= range.smallest && size <= range.largest) return size;
  throw table.at(key).error(fmt::format("must be {:g} … {:g}{}{}, got {:g}", range.smallest, range.largest,
                                        unit.empty() ? "" : " ", unit, size));
}

}  // namespace sprung::reduce
