#include "reduce/superelement/certificate.h"

#include <algorithm>
#include <array>

namespace sprung::reduce {

bool Certificate::is_bounded() const {
  return largest_error() < kUnbounded;
}

double Certificate::largest_error() const {
  double largest = 0.0;
  for (const InterfaceError& one : interface) largest = std::max(largest, one.error);
  return largest;
}

int Certificate::find_worst() const {
  const bool bounded = is_bounded();
  const auto worst = std::max_element(interface.begin(), interface.end(),
                                      [&](const InterfaceError& a, const InterfaceError& b) {
                                        return bounded ? a.error < b.error : a.static_error < b.static_error;
                                      });
  return worst == interface.end() ? -1 : static_cast<int>(worst - interface.begin());
}

const char* freedom_name(int freedom) {
  static constexpr std::array<const char*, 3> kNames{"x", "y", "rotation"};
  return kNames.at(static_cast<std::size_t>(freedom));
}

}  // namespace sprung::reduce
