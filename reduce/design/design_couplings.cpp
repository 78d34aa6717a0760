#include "reduce/design/design_couplings.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "reduce/design/design_frame.h"
#include "reduce/design/known_keys.h"

namespace sprung::reduce {

bool follows(const fem::BeamModel& model, int node) {
  return std::any_of(model.couplings.begin(), model.couplings.end(),
                     [node](const fem::Coupling& one) { return one.node == node; });
}

namespace {

using support::TomlTable;
using support::TomlValue;

int read_follower(const fem::BeamModel& model, const TomlValue& name) {
  const int node = find_named_node(model.mesh, name);
  if (follows(model, node))
    throw name.error(fmt::format("names '{}', which follows other points already", name.string()));
  return node;
}

void read_rigid_offset(const TomlTable& table, fem::BeamModel& model) {
  expect_keys(table, {"from", "to"});
  const int leader = find_named_node(model.mesh, table.at("from"));
  const int node = read_follower(model, table.at("to"));
  if (node == leader) throw table.at("to").error("is at the place of 'from'");
  model.couplings.push_back(fem::make_rigid_offset(model.mesh.node_positions, node, leader));
}

std::vector<double> read_weights(const TomlTable& table, std::size_t num_leaders) {
  if (!table.has("weights")) return std::vector<double>(num_leaders, 1.0);
  const TomlValue weights = table.at("weights");
  std::vector<double> numbers = weights.numbers(support::positive(""));
  if (numbers.size() != num_leaders)
    throw weights.error(fmt::format("has {} numbers for {} points", numbers.size(), num_leaders));
  return numbers;
}

// Whether an element that is no spring has the node.
bool is_on_line(const fem::BeamModel& model, int node) {
  return std::any_of(model.mesh.elements.begin(), model.mesh.elements.end(), [&](const auto& element) {
    const bool is_spring = model.sections[static_cast<std::size_t>(element.section)].bushing.has_value();
    return !is_spring && (element.first == node || element.second == node);
  });
}

void read_average(const TomlTable& table, fem::BeamModel& model) {
  expect_keys(table, {"point", "of", "weights"});
  const int node = read_follower(model, table.at("point"));
  if (is_on_line(model, node))
    throw table.at("point").error(
        "is a node of a line, which an average would hold: put it where no line has a node");
  std::vector<int> leaders;
  for (const TomlValue& name : table.at("of").items()) {
    leaders.push_back(find_named_node(model.mesh, name));
    if (leaders.back() == node) throw name.error("is the point that follows");
    if (std::count(leaders.begin(), leaders.end(), leaders.back()) > 1)
      throw name.error("names a node twice");
  }
  if (leaders.size() < 2)
    throw table.at("of").error(fmt::format("names {} points, expected at least 2", leaders.size()));
  const std::vector<double> weights = read_weights(table, leaders.size());
  model.couplings.push_back(fem::make_average(model.mesh.node_positions, node, leaders, weights));
}

// A leader may be declared a follower by a later table, so that all are read before.
void check_leaders(const fem::BeamModel& model, const TomlTable& root) {
  for (const fem::Coupling& coupling : model.couplings) {
    for (const fem::Coupling::Leader& leader : coupling.leaders) {
      if (!follows(model, leader.node)) continue;
      const auto& where = root.has("rigid_offsets") ? root.at("rigid_offsets") : root.at("averages");
      throw where.error(fmt::format(
          "{} follows {}, which follows others itself; let both follow the same points",
          fem::describe_node(model.mesh, coupling.node), fem::describe_node(model.mesh, leader.node)));
    }
  }
}

}  // namespace

std::set<std::string> list_followers(const TomlTable& root) {
  std::set<std::string> names;
  for (const auto& [section, key] : {std::pair{"rigid_offsets", "to"}, std::pair{"averages", "point"}}) {
    const auto array = root.find(section);
    if (!array) continue;
    for (const TomlValue& item : array->items()) names.insert(item.table().at(key).string());
  }
  return names;
}

void read_couplings(const TomlTable& root, fem::BeamModel& model) {
  if (const auto offsets = root.find("rigid_offsets")) {
    for (const TomlValue& item : offsets->items()) read_rigid_offset(item.table(), model);
  }
  if (const auto averages = root.find("averages")) {
    for (const TomlValue& item : averages->items()) read_average(item.table(), model);
  }
  check_leaders(model, root);
}

void expect_no_follower(const fem::BeamModel& model, int node, const TomlValue& value, const char* needs) {
  if (!follows(model, node)) return;
  throw value.error(fmt::format("names a point that follows others; {}", needs));
}

}  // namespace sprung::reduce
