#include "dynamics/element_input/point_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace sprung::dynamics {

PointReference read_point(const support::TomlValue& value) {
  const std::string& name = value.string();
  const std::size_t dot = name.find('.');
  if (dot == 0 || dot == std::string::npos || dot + 1 == name.size() || name.rfind('.') != dot) {
    throw value.error(fmt::format("must be a point \"body.point\" or \"ground.point\", got \"{}\"", name));
  }
  return {name, value.location()};
}

void check_point(const PointReference& reference, std::span<const std::string> known) {
  if (std::find(known.begin(), known.end(), reference.name) != known.end()) return;
  const std::string body = body_of_point(reference.name);
  const std::string point = reference.name.substr(body.size() + 1);
  std::vector<std::string> bodies, points;
  for (const std::string& name : known) {
    const std::string body_of_name = body_of_point(name);
    if (bodies.empty() || bodies.back() != body_of_name) bodies.push_back(body_of_name);
    if (body_of_name == body) points.push_back(name.substr(body.size() + 1));
  }
  if (points.empty()) {
    throw support::InputError(reference.location,
                              fmt::format("'{}' names no body of the vehicle: there is no '{}'{}",
                                          reference.name, body, support::nearest_name_hint(body, bodies)));
  }
  std::string hint = support::nearest_name_hint(point, points);
  if (hint.empty()) {
    for (const std::string& name : points) hint += (hint.empty() ? "; it has " : ", ") + name;
  }
  throw support::InputError(reference.location, fmt::format("'{}' has no point '{}'{}", body, point, hint));
}

std::string body_of_point(const std::string& point_name) {
  return point_name.substr(0, point_name.find('.'));
}

void check_name(const std::string& name, const std::string& what, const support::SourceLocation& location) {
  if (support::is_plain_name(name)) return;
  throw support::InputError(
      location,
      fmt::format("the name of a {} must be letters, digits, '_' and '-' alone, got '{}'", what, name));
}

}  // namespace sprung::dynamics
