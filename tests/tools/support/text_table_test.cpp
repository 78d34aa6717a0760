#include "tools/support/terminal/text_table.h"

#include <stdexcept>

#include "tests/catch.h"
#include "tests/tools/support/error_message.h"

using sprung::support::TextTable;

TEST_CASE("a table aligns text left and numbers right, by characters and not by bytes") {
  TextTable table({"körper", "f [Hz]", "note"});
  table.add_row({"chassis", "6.11", "bending"});
  table.add_row({"arm", "-88.92", ""});
  table.add_row({"", "", "2 more"});
  CHECK(table.str() ==
        "körper   f [Hz]  note\n"
        "────────────────────────\n"
        "chassis    6.11  bending\n"
        "arm      -88.92\n"
        "                 2 more\n");
}

TEST_CASE("a column with one word in it is text, and so is one without cells") {
  TextTable table({"value", "empty"});
  table.add_row({"1", ""});
  table.add_row({"none", ""});
  CHECK(table.str() ==
        "value  empty\n"
        "────────────\n"
        "1\n"
        "none\n");
}

TEST_CASE("zero has no minus sign, nor has a number that rounds to zero") {
  CHECK(sprung::support::format_fixed(-1e-9, 4) == "0.0000");
  CHECK(sprung::support::format_fixed(-0.0, 2) == "0.00");
  CHECK(sprung::support::format_fixed(-5.1e-5, 4) == "-0.0001");
  CHECK(sprung::support::format_fixed(-10.04, 1) == "-10.0");
  CHECK(sprung::support::format_fixed(2.5, 3) == "2.500");
}

TEST_CASE("one is singular") {
  CHECK(sprung::support::format_count(1, "mode") == "1 mode");
  CHECK(sprung::support::format_count(0, "mode") == "0 modes");
  CHECK(sprung::support::format_count(36, "available mode") == "36 available modes");
}

TEST_CASE("a table's row has as many cells as its header") {
  TextTable table({"a", "b"});
  CHECK(error_message<std::invalid_argument>([&] { table.add_row({"1"}); }) ==
        "TextTable::add_row: 1 cells in a table of 2 columns");
}
