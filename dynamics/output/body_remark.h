#pragma once

#include <string>

namespace sprung::dynamics {

/// A doubt about the numbers of a body; the text names it.
struct BodyRemark {
  std::string body, text;
};

}  // namespace sprung::dynamics
