#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "dynamics/input/vehicle.h"

namespace sprung::test {

/// The text with its one occurrence of `old_part` replaced.
std::string with_change(const std::string& text, const std::string& old_part, const std::string& new_part);

/// The message of the InputError that `action` throws; "no error" if it throws none.
std::string input_error_of(const std::function<void()>& action);

/// Folder with the superelements of the tests' vehicle: `frame` with nodes left (-1.2, 0.1), right (1.3,
/// -0.2) and top (0.2, 0.8), modes at 5, 5, 12, 20 Hz.
std::filesystem::path superelement_folder();

/// A small vehicle that has one of everything; file name "cart.toml".
const std::string& cart_text();
dynamics::Vehicle read_cart(const std::string& text);

}  // namespace sprung::test
