#include "tests/dynamics/input/reference.h"

#include <fstream>
#include <sstream>

#include "tools/support/files/read_text_file.h"

namespace sprung::test {

namespace {

// The words in backticks of a row's first cell, where the row describes keys (its table has a column
// "meaning").
Keys read_row_keys(const std::string& line) {
  Keys keys;
  const std::string cell = line.substr(0, line.find(" |", 1));
  for (std::size_t at = cell.find('`'); at != std::string::npos;) {
    const std::size_t end = cell.find('`', at + 1);
    keys.insert(cell.substr(at + 1, end - at - 1));
    at = cell.find('`', end + 1);
  }
  return keys;
}

}  // namespace

Reference read_reference() {
  Reference reference;
  std::istringstream text(support::read_text_file(SPRUNG_MODELS "/README.md"));
  std::string part, title, example;
  bool in_example = false, in_key_table = false;
  for (std::string line; std::getline(text, line);) {
    if (in_example && line == "```") {
      in_example = false;
      if (part == "Vehicle file")
        reference.vehicle += example + "\n";
      else
        reference.runs.push_back(example);
    } else if (in_example) {
      example += line + "\n";
    } else if (line == "```toml") {
      in_example = true;
      example.clear();
    } else if (line.starts_with("## ")) {
      part = line.substr(3);
    } else if (line.starts_with("### ")) {
      title = line.substr(4);
    } else if (line.starts_with("| key |")) {
      in_key_table = true;
    } else if (!line.starts_with("|")) {
      in_key_table = false;
    } else if (in_key_table && line.starts_with("| `")) {
      reference.sections[title].merge(read_row_keys(line));
    }
  }
  return reference;
}

void write_history() {
  std::ofstream("drive.csv") << "time [s],x [mm],push [kN]\n0,0,0\n1,5,2\n2,0,0\n";
}

}  // namespace sprung::test
