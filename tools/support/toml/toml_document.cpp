#include "tools/support/files/read_text_file.h"
#include "tools/support/toml/toml.h"
#include "tools/support/toml/toml_parser.h"

namespace sprung::support {

TomlDocument TomlDocument::read(const std::filesystem::path& path) {
  return parse(read_text_file(path), path.string());
}

TomlDocument TomlDocument::parse(std::string text, const std::string& name) {
  TomlDocument document;
  document.root_ = std::make_unique<TomlNode>(parse_toml(text, name));
  document.text_ = std::move(text);
  document.name_ = name;
  return document;
}

}  // namespace sprung::support
