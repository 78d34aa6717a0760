#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace sprung::test {

using Keys = std::set<std::string>;

/// A section of the reference: "### Title", a table of keys, examples.
struct Section {
  Keys keys;
  std::vector<std::string> examples;
};

struct Reference {
  std::map<std::string, Section> sections;  // by title
  std::string vehicle;                      // all examples of "## Vehicle file"
  std::vector<std::string> runs;            // those of "## Run file"
};

/// The reference of all input keys, dynamics/models/README.md.
Reference read_reference();

/// What the examples of "## Vehicle file" need beside them: a file of measured histories, in the present
/// folder.
void write_history();

}  // namespace sprung::test
