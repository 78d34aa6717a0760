#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace sprung::test {

using Keys = std::set<std::string>;

struct Reference {
  std::map<std::string, Keys> sections;  ///< the keys in the tables below each "### Title"
  std::string vehicle;                   ///< all examples of "## Vehicle file"
  std::vector<std::string> runs;         ///< those of "## Run file"
};

/// The reference of all input keys, dynamics/models/README.md.
Reference read_reference();

/// What the examples of "## Vehicle file" need beside them: a file of measured histories, in the present
/// folder.
void write_history();

}  // namespace sprung::test
