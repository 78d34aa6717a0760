#include "reduce/matrices/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include "reduce/matrices/text_lines.h"

namespace sprung::reduce {

namespace {

constexpr std::int64_t kLargestNode = std::numeric_limits<std::int32_t>::max();
constexpr std::string_view kExpanded =
    ": CalculiX makes solids of beams and shells, and writes all their nodes under one number; such a frame "
    "can come in by tools/convert_mesh";

bool is_blank(const TextLines& lines) {
  return lines.fields().empty();
}

// Goes to the heading, and requires it to be one of those that are known.
std::size_t read_heading(TextLines& lines, std::initializer_list<std::string_view> known) {
  while (lines.next() && is_blank(lines)) {
  }
  std::string heading, expected;
  for (const TextField& cell : lines.cells())
    heading += fmt::format("{}{}", heading.empty() ? "" : ",", cell.text);
  for (const std::string_view one : known) {
    if (heading == one) return lines.cells().size();
    expected += fmt::format("{}'{}'", expected.empty() ? "" : " or ", one);
  }
  throw lines.error(fmt::format("the heading is '{}', expected {}", heading, expected));
}

std::vector<TextField> read_row(const TextLines& lines, std::size_t num_cells) {
  std::vector<TextField> cells = lines.cells();
  if (cells.size() == num_cells) return cells;
  throw lines.error(fmt::format("has {} cells, expected {}", cells.size(), num_cells));
}

int read_direction(const TextLines& lines, const TextField& cell) {
  constexpr std::array<std::string_view, 7> kWords{"q", "x", "y", "z", "rx", "ry", "rz"};
  const auto* const word = std::find(kWords.begin(), kWords.end(), cell.text);
  if (word != kWords.end()) return static_cast<int>(word - kWords.begin());
  if (cell.text.size() == 1 && cell.text[0] >= '1' && cell.text[0] <= '6') return cell.text[0] - '0';
  throw lines.error(
      cell, fmt::format("'{}' is no direction, expected 1 … 6 or x, y, z, rx, ry, rz, or q of a modal "
                        "freedom",
                        cell.text));
}

// hint: what may be the cause of a freedom that stands there twice.
void add_freedom(const TextLines& lines, const TextField& where, const Freedom& freedom,
                 FreedomList& freedoms, std::string_view hint = "") {
  const int size = freedoms.size();
  if (freedoms.get(freedom) == size) return;
  throw lines.error(where, fmt::format("{} stands in the table twice{}", describe(freedom), hint));
}

}  // namespace

FreedomList read_freedom_table(const std::filesystem::path& path) {
  TextLines lines(path);
  const std::size_t num_cells = read_heading(lines, {"node,direction"});
  FreedomList freedoms;
  while (lines.next()) {
    if (is_blank(lines)) continue;
    const std::vector<TextField> cells = read_row(lines, num_cells);
    add_freedom(lines, cells[0], {lines.integer(cells[0], 1, kLargestNode), read_direction(lines, cells[1])},
                freedoms);
  }
  if (freedoms.size() == 0) throw lines.error("has no rows");
  return freedoms;
}

FreedomList read_calculix_freedoms(const std::filesystem::path& path) {
  TextLines lines(path);
  FreedomList freedoms;
  while (lines.next()) {
    const std::vector<TextField> fields = lines.fields();
    if (fields.empty()) continue;
    const std::size_t point = fields[0].text.find('.');
    if (fields.size() != 1 || point == std::string_view::npos) {
      throw lines.error(fmt::format("is '{}', expected NODE.DIRECTION", lines.line()));
    }
    const TextField node{fields[0].text.substr(0, point), fields[0].column};
    const TextField direction{fields[0].text.substr(point + 1),
                              fields[0].column + static_cast<int>(point) + 1};
    add_freedom(lines, node, {lines.integer(node, 1, kLargestNode), read_direction(lines, direction)},
                freedoms, kExpanded);
  }
  if (freedoms.size() == 0) throw lines.error("has no freedoms");
  return freedoms;
}

NodeTable read_node_table(const std::filesystem::path& path) {
  TextLines lines(path);
  const std::size_t num_cells = read_heading(lines, {"node,x,y", "node,x,y,z"});
  std::map<std::int64_t, Eigen::Vector3d> nodes;
  while (lines.next()) {
    if (is_blank(lines)) continue;
    const std::vector<TextField> cells = read_row(lines, num_cells);
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i < num_cells; ++i) position(static_cast<int>(i) - 1) = lines.real(cells[i]);
    const std::int64_t id = lines.integer(cells[0], 1, kLargestNode);
    if (!nodes.emplace(id, position).second) {
      throw lines.error(cells[0], fmt::format("node {} stands in the table twice", id));
    }
  }
  if (nodes.empty()) throw lines.error("has no rows");
  NodeTable table{.ids = {}, .positions = Eigen::Matrix3Xd(3, static_cast<Eigen::Index>(nodes.size()))};
  for (const auto& [id, position] : nodes) {
    table.positions.col(static_cast<Eigen::Index>(table.ids.size())) = position;
    table.ids.push_back(id);
  }
  return table;
}

}  // namespace sprung::reduce
