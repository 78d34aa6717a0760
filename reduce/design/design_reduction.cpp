#include "reduce/design/design_reduction.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "reduce/design/design_frame.h"
#include "reduce/design/known_keys.h"
#include "reduce/design/sizes.h"

namespace sprung::reduce {

namespace {

using support::TomlTable;
using support::TomlValue;

constexpr double kSmallestTolerance = 1e-6;  // well above rounding, 1e-8
// Of a basis for interface loads. With more, the matrices of its vectors fill the memory.
constexpr std::size_t kMostInterfaceFreedoms = 1000;

// 0-based freedoms of "x", "y", "r" (or "ψ"), in any order.
std::vector<int> read_freedoms(const TomlValue& value) {
  std::string_view rest = value.string();
  std::vector<int> freedoms;
  while (!rest.empty()) {
    constexpr std::array<std::pair<std::string_view, int>, 4> kLetters{
        {{"x", 0}, {"y", 1}, {"r", 2}, {"ψ", 2}}};
    const auto letter = std::find_if(kLetters.begin(), kLetters.end(),
                                     [&](const auto& one) { return rest.starts_with(one.first); });
    const bool known = letter != kLetters.end();
    if (!known || std::find(freedoms.begin(), freedoms.end(), letter->second) != freedoms.end()) {
      throw value.error(fmt::format(
          "is '{}', expected the letters x, y and r (rotation, or ψ), each at most once", value.string()));
    }
    freedoms.push_back(letter->second);
    rest.remove_prefix(letter->first.size());
  }
  if (freedoms.empty())
    throw value.error("is empty, expected some of the letters x, y and r (rotation, or ψ)");
  std::sort(freedoms.begin(), freedoms.end());
  return freedoms;
}

// A freedom that is there already keeps the point that named it first.
void add_freedom(const InterfaceFreedom& added, std::vector<InterfaceFreedom>& interface) {
  const bool known = std::any_of(interface.begin(), interface.end(), [&](const InterfaceFreedom& one) {
    return one.node == added.node && one.freedom == added.freedom;
  });
  if (!known) interface.push_back(added);
}

std::vector<InterfaceFreedom> read_interface(const TomlTable& root, const fem::Mesh& mesh,
                                             int reference_node) {
  std::vector<InterfaceFreedom> interface;
  const std::optional<TomlTable> table = root.find_table("interface");
  const auto num_points = static_cast<int>(mesh.named_nodes.size());
  for (int point = 0; point < num_points; ++point) {
    const fem::Mesh::NamedNode& named = mesh.named_nodes[static_cast<std::size_t>(point)];
    std::vector<int> freedoms{0, 1, 2};
    if (table) {
      const auto given = table->find(named.name);
      if (!given) continue;
      freedoms = read_freedoms(*given);
    } else if (named.node == reference_node) {
      continue;
    }
    for (const int freedom : freedoms) add_freedom({point, named.node, freedom}, interface);
  }
  if (table) table->reject_unknown_keys();
  if (table && interface.empty()) throw table->error("is empty, expected points and their freedoms");
  return interface;
}

BasisKind read_basis(const TomlTable& table, bool modes_by_number) {
  static const std::array<std::string, 3> kWords{"free", "fixed-interface", "clamped"};
  const auto basis = table.find("basis");
  if (!basis) return modes_by_number ? BasisKind::kClamped : BasisKind::kFree;
  const std::string& word = basis->one_of(kWords);
  return word == kWords[0]   ? BasisKind::kFree
         : word == kWords[1] ? BasisKind::kFixedInterface
                             : BasisKind::kClamped;
}

// Keys that mean nothing for the basis.
void reject_keys(const TomlTable& table, const Reduction& reduction) {
  if (reduction.basis == BasisKind::kFree) return;
  for (const char* key : {"tolerance", "residual_vectors"}) {
    if (const auto found = table.find(key)) throw found->error("belongs to the basis \"free\" alone");
  }
}

}  // namespace

Reduction read_reduction(const TomlTable& root, const fem::Mesh& mesh, int reference_node,
                         bool modes_by_number) {
  static const std::array<std::string, 2> kResidual{"certified", "all"};
  Reduction reduction;
  reduction.interface = read_interface(root, mesh, reference_node);
  const std::optional<TomlTable> table = root.find_table("reduction");
  if (!table) return reduction;
  expect_keys(*table, {"basis", "highest_frequency", "tolerance", "residual_vectors"});
  reduction.where = table->location();
  reduction.basis = read_basis(*table, modes_by_number);
  reject_keys(*table, reduction);
  if (table->has("highest_frequency"))
    reduction.highest_hz = read_size(*table, "highest_frequency", "Hz", kFrequencies);
  reduction.tolerance = table->number_or("tolerance", reduction.tolerance,
                                         {.unit = "", .at_least = kSmallestTolerance, .at_most = 1.0});
  if (const auto residual = table->find("residual_vectors")) {
    reduction.all_residual = residual->one_of(kResidual) == kResidual[1];
  }
  if (reduction.basis == BasisKind::kClamped) return reduction;
  table->at("highest_frequency");  // says which key is missing
  if (reduction.interface.empty()) {
    throw table->error(
        "asks for a basis for interface loads, but no point except the reference has a name; name points, "
        "or the reference itself in [interface]");
  }
  if (reduction.interface.size() > kMostInterfaceFreedoms) {
    throw table->error(fmt::format(
        "asks for a basis for {} freedoms of named points, expected at most {}, for each takes about one "
        "vector; name the points that take loads in [interface]",
        reduction.interface.size(), kMostInterfaceFreedoms));
  }
  return reduction;
}

}  // namespace sprung::reduce
