#include "dynamics/output/json.h"

#include <fmt/format.h>

#include <cmath>

namespace sprung::dynamics {

namespace {

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += fmt::format("\\{}", c);
    else if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      result += c;
  }
  return result + "\"";
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.17g}", value) : "null";
}

template <class Range, class Format>
std::string list(const Range& range, Format&& format) {
  std::string result = "[";
  for (const auto& item : range) result += (result.size() > 1 ? ", " : "") + format(item);
  return result + "]";
}

}  // namespace

JsonObject& JsonObject::add_raw(std::string_view name, const std::string& value) {
  members_ += fmt::format("{}{}: {}", members_.empty() ? "" : ", ", quoted(name), value);
  return *this;
}

JsonObject& JsonObject::add(std::string_view name, double value) {
  return add_raw(name, number(value));
}

JsonObject& JsonObject::add(std::string_view name, std::string_view text) {
  return add_raw(name, quoted(text));
}

JsonObject& JsonObject::add(std::string_view name, bool value) {
  return add_raw(name, value ? "true" : "false");
}

JsonObject& JsonObject::add(std::string_view name, const JsonObject& object) {
  return add_raw(name, object.str());
}

JsonObject& JsonObject::add(std::string_view name, const std::vector<JsonObject>& objects) {
  return add_raw(name, list(objects, [](const JsonObject& object) { return object.str(); }));
}

JsonObject& JsonObject::add(std::string_view name, const std::vector<std::string>& texts) {
  return add_raw(name, list(texts, [](const std::string& text) { return quoted(text); }));
}

JsonObject& JsonObject::add(std::string_view name, const std::vector<int>& numbers) {
  return add_raw(name, list(numbers, [](int value) { return fmt::format("{}", value); }));
}

JsonObject& JsonObject::add(std::string_view name, const std::vector<double>& numbers) {
  return add_raw(name, list(numbers, number));
}

}  // namespace sprung::dynamics
