#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sprung::dynamics {

/// A JSON object put together member by member, for `--json`.
class JsonObject {
 public:
  JsonObject& add(std::string_view name, double value);  ///< 17 significant digits; null where not finite
  JsonObject& add(std::string_view name, std::string_view text);
  JsonObject& add(std::string_view name, const char* text) { return add(name, std::string_view(text)); }
  JsonObject& add(std::string_view name, bool value);
  JsonObject& add(std::string_view name, const JsonObject& object);
  JsonObject& add(std::string_view name, const std::vector<JsonObject>& objects);
  JsonObject& add(std::string_view name, const std::vector<std::string>& texts);
  JsonObject& add(std::string_view name, const std::vector<int>& numbers);
  JsonObject& add(std::string_view name, const std::vector<double>& numbers);  ///< each as a single one
  std::string str() const { return "{" + members_ + "}"; }

 private:
  JsonObject& add_raw(std::string_view name, const std::string& value);
  std::string members_;
};

}  // namespace sprung::dynamics
