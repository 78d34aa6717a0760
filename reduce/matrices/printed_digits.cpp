#include "reduce/matrices/printed_digits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace sprung::reduce {

namespace {

constexpr double kOfPrograms = 1e-12;
constexpr double kOfExact = 1e-4;  // numbers with fewer than six digits are exact ones, such as 0.1

// Without zeros before and behind: 0.0120 has two.
int count_digits(double value) {
  std::string digits;
  for (const char c : fmt::format("{}", value)) {
    if (c == 'e') break;
    if (c >= '0' && c <= '9' && (c != '0' || !digits.empty())) digits += c;
  }
  return static_cast<int>(digits.find_last_not_of('0') + 1);
}

}  // namespace

double estimate_rounding(const Eigen::Ref<const Eigen::VectorXd>& numbers) {
  int digits = 1;
  for (const double number : numbers) digits = std::max(digits, count_digits(number));
  const double rounding = 5.0 * std::pow(10.0, 1 - digits);
  return rounding > kOfExact ? kOfPrograms : std::max(rounding, kOfPrograms);
}

}  // namespace sprung::reduce
