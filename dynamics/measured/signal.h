#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace sprung::dynamics {

/// What a file says of one of its columns or channels.
struct Signal {
  std::string name;
  std::string unit;  ///< as written; "" if the file states none
};

/// A unit in terms of an SI unit.
struct KnownUnit {
  std::string_view si_unit;  ///< "m", "N", "N·m", "rad", "s"; "" for a pure number
  double factor = 1.0;       ///< in SI units
};

/// @param name  as files write it: "mm", "kN", "deg"
/// @return none if it is not known
std::optional<KnownUnit> find_unit(std::string_view name);
/// The units that `find_unit` knows for a quantity, for messages: "m, mm, cm".
/// @param si_unit  "" for all of them
std::string list_units(std::string_view si_unit);

/// The names of signals in quotes, for messages: "'time', 'front'".
std::string list_names(std::span<const Signal> signals);

/// Reads a number.
/// @return none unless the text is one finite number and nothing else
std::optional<double> parse_number(std::string_view text);

/// A text without the blanks at its ends.
std::string_view trim(std::string_view text);

}  // namespace sprung::dynamics
