#pragma once

#include <string_view>

#include "tools/support/toml/toml.h"

namespace sprung::reduce {

/// Sizes that the numbers of a design may have. No structure is built beyond them; and within them no product
/// that the reduction forms (E I / L³, ω⁴, ∫r² dm) leaves the range of a double.
struct SizeRange {
  double smallest, largest;
};
inline constexpr SizeRange kLengths{1e-12, 1e9};           // m
inline constexpr SizeRange kAreas{1e-24, 1e24};            // m²
inline constexpr SizeRange kSecondMoments{1e-48, 1e48};    // m⁴
inline constexpr SizeRange kSectionModuli{1e-36, 1e36};    // m³
inline constexpr SizeRange kModuli{1e-6, 1e18};            // Pa
inline constexpr SizeRange kDensities{1e-6, 1e12};         // kg/m³
inline constexpr SizeRange kMassesPerLength{1e-24, 1e24};  // kg/m
inline constexpr SizeRange kShearCoefficients{1e-6, 1.0};  // of the area
inline constexpr SizeRange kStiffnesses{1e-24, 1e24};      // N/m, N·m, of springs
inline constexpr SizeRange kFrequencies{1e-15, 1e9};       // Hz
inline constexpr double kLargestMass = 1e24;               // kg, of a point
inline constexpr double kLargestInertia = 1e48;            // kg·m², of a point

/// A number that the key must have, positive and within the range.
/// @throws support::InputError at the value
double read_size(const support::TomlTable& table, std::string_view key, std::string_view unit,
                 const SizeRange& range);

}  // namespace sprung::reduce
