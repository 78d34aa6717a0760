#include "reduce/design/design.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "reduce/design/design_couplings.h"
#include "reduce/design/design_foundations.h"
#include "reduce/design/design_frame.h"
#include "reduce/design/design_matrices.h"
#include "reduce/design/design_sections.h"
#include "reduce/design/known_keys.h"
#include "reduce/design/program_version.h"
#include "reduce/design/sizes.h"
#include "tools/support/files/content_hash.h"
#include "tools/support/files/read_text_file.h"
#include "tools/support/toml/toml.h"

namespace sprung::reduce {

namespace {

using support::TomlTable;
using support::TomlValue;

constexpr double kHiddenNode = 1e-6;  // of the body's extent

void read_point_masses(const TomlTable& root, fem::BeamModel& model) {
  const auto array = root.find("point_masses");
  if (!array) return;
  for (const TomlValue& item : array->items()) {
    const TomlTable table = item.table();
    expect_keys(table, {"point", "mass", "inertia"});
    model.point_masses.push_back(
        {.node = find_named_node(model.mesh, table.at("point")),
         .mass = table.number("mass", {.unit = "kg", .at_least = 0.0, .at_most = kLargestMass}),
         .inertia = table.number_or("inertia", 0.0,
                                    {.unit = "kg·m²", .at_least = 0.0, .at_most = kLargestInertia})});
  }
}

// Parts that no line joins may be joined by springs, foundations and points that follow others.
void check_joined(const fem::BeamModel& model, const support::SourceLocation& where) {
  std::vector<std::pair<int, int>> links;
  for (const fem::Coupling& coupling : model.couplings) {
    for (const fem::Coupling::Leader& leader : coupling.leaders)
      links.emplace_back(coupling.node, leader.node);
  }
  fem::check_connected(model.mesh, links, where);
}

// Files that a design names, and their hashes.
struct InputFiles {
  std::vector<std::string> names, hashes;
};

InputFiles read_beams(const TomlTable& root, const std::filesystem::path& folder, Design& design) {
  const BeamTheory theory = read_beam_theory(root);
  const Sections sections = read_sections(root, read_materials(root), theory);
  DesignFrame frame = read_design_frame(root, folder, sections);
  design.model.mesh = std::move(frame.mesh);
  for (const std::string& name : design.model.mesh.section_names)
    design.model.sections.push_back(sections.at(name));
  read_couplings(root, design.model);
  read_foundations(root, design.model);
  check_joined(design.model, root.location());
  return {std::move(frame.input_names), std::move(frame.input_hashes)};
}

// The nodes of a body in space may lie behind each other in the plane, and a name is that of one of them.
void remark_hidden_nodes(const fem::Mesh& mesh, std::vector<std::string>& remarks) {
  const double tolerance = kHiddenNode * fem::calc_extent(mesh);
  for (const fem::Mesh::NamedNode& point : mesh.named_nodes) {
    const Eigen::Vector2d place = mesh.node_positions.col(point.node);
    const Eigen::Index num_there =
        ((mesh.node_positions.colwise() - place).colwise().norm().array() <= tolerance).count();
    if (num_there == 1) continue;
    remarks.push_back(fmt::format("point '{}' is node {}, and {} other node{} at its place in the plane",
                                  point.name, mesh.node_ids[static_cast<std::size_t>(point.node)],
                                  num_there - 1, num_there == 2 ? " lies" : "s lie"));
  }
}

InputFiles read_matrices(const TomlTable& root, const std::filesystem::path& folder, Design& design) {
  for (const char* key : {"theory", "rotary_inertia", "materials", "sections", "lines", "springs",
                          "rigid_offsets", "averages", "foundations"}) {
    if (const auto found = root.find(key))
      throw found->error("describes beams, and stands beside [matrices]; give either");
  }
  DesignMatrices read = read_design_matrices(root, folder);
  design.model.mesh.node_ids = read.body.node_ids;
  design.model.mesh.node_positions = read.body.node_positions;
  name_nodes(root, design.model.mesh);
  remark_hidden_nodes(design.model.mesh, read.body.remarks);
  design.matrices = std::move(read.body);
  return {std::move(read.input_names), std::move(read.input_hashes)};
}

void add_point_masses(const std::vector<fem::PointMass>& masses, MatrixBody& body) {
  for (const fem::PointMass& one : masses) {
    for (int freedom = 0; freedom < 3; ++freedom) {
      const double value = freedom < 2 ? one.mass : one.inertia;
      if (value > 0.0) body.mass.coeffRef(3 * one.node + freedom, 3 * one.node + freedom) += value;
    }
  }
  body.mass.makeCompressed();
}

int read_reference(const TomlTable& root, const fem::BeamModel& model) {
  static const std::array<std::string, 1> kConditions{"clamped"};
  const TomlTable table = root.at("reference").table();
  expect_keys(table, {"point", "condition"});
  const int node = find_named_node(model.mesh, table.at("point"));
  expect_no_follower(model, node, table.at("point"), "take one of those as the reference");
  if (const auto condition = table.find("condition")) condition->one_of(kConditions);
  return node;
}

ModeNumbers read_numbers(const TomlValue& value) {
  ModeNumbers wanted;
  for (const TomlValue& item : value.items())
    wanted.numbers.push_back(static_cast<int>(item.integer(1, 1'000'000)));
  std::sort(wanted.numbers.begin(), wanted.numbers.end());
  if (wanted.numbers.empty()) throw value.error("is empty, expected mode numbers");
  if (std::adjacent_find(wanted.numbers.begin(), wanted.numbers.end()) != wanted.numbers.end()) {
    throw value.error("names a mode twice");
  }
  return wanted;
}

// Whether a design says which modes it wants, as the basis "clamped" needs it.
bool has_wanted_modes(const TomlTable& table) {
  return table.has("count") || table.has("highest_frequency") || table.has("all") || table.has("numbers");
}

WantedModes read_modes(const TomlTable& table, bool has_reduction) {
  const auto count = table.find("count"), highest = table.find("highest_frequency");
  const auto all = table.find("all"), numbers = table.find("numbers");
  const int given = (count ? 1 : 0) + (highest ? 1 : 0) + (all ? 1 : 0) + (numbers ? 1 : 0);
  if (given != 1) {
    throw table.error(fmt::format(
        "has {} of the keys 'count', 'highest_frequency', 'all' and 'numbers', expected one{}", given,
        has_reduction ? " for the basis \"clamped\"" : ", or a table [reduction] beside it"));
  }
  if (count) {
    return {.wanted = ModeCount{static_cast<int>(count->integer(1, 1'000'000))}, .where = count->location()};
  }
  if (highest)
    return {.wanted = ModesUpTo{read_size(table, "highest_frequency", "Hz", kFrequencies)},
            .where = highest->location()};
  if (numbers) return {.wanted = read_numbers(*numbers), .where = numbers->location()};
  if (!all->boolean()) throw all->error("is false; leave it out and give 'count' or 'highest_frequency'");
  return {.wanted = AllModes{}, .where = all->location()};
}

void read_damping(const TomlTable& table, Design& design) {
  const TomlValue ratio = table.at("damping_ratio");
  const support::Quantity range{.unit = "of critical", .at_least = 0.0, .at_most = 1.0};
  design.damping_where = ratio.location();
  design.damping_ratio = ratio.is_array() ? ratio.numbers(range) : std::vector<double>{ratio.number(range)};
  const auto residual = table.find("residual_damping_ratio");
  if (!residual) return;
  if (design.reduction.basis != BasisKind::kFree) {
    throw residual->error("belongs to the basis \"free\" alone, which has residual vectors");
  }
  design.residual_damping_ratio = residual->number(range);
}

// The basis "fixed-interface" holds the freedoms of the interface, and a point that follows others has none.
void check_fixed_interface(const TomlTable& root, const Design& design) {
  if (design.reduction.basis != BasisKind::kFixedInterface) return;
  constexpr const char* kRemedy = "name those in [interface], or take the basis \"free\"";
  const std::optional<TomlTable> table = root.find_table("interface");
  for (const InterfaceFreedom& one : design.reduction.interface) {
    const std::string& name = design.model.mesh.named_nodes[static_cast<std::size_t>(one.point)].name;
    if (table) {
      expect_no_follower(design.model, one.node, table->at(name), kRemedy);
    } else if (follows(design.model, one.node)) {  // one of all points, which no key names
      throw root.at("reduction")
          .table()
          .at("basis")
          .error(fmt::format("holds the freedoms of '{}', a point that follows others; {}", name, kRemedy));
    }
  }
}

// The modes of the basis "clamped"; the others take what their band needs.
void read_wanted_modes(const TomlTable& root, const TomlTable& table, Design& design) {
  if (design.reduction.basis == BasisKind::kClamped) {
    design.modes = read_modes(table, root.has("reduction"));
    return;
  }
  for (const char* key : {"count", "highest_frequency", "all", "numbers"}) {
    if (const auto found = table.find(key)) {
      throw found->error(
          "belongs to the basis \"clamped\"; the others take what [reduction] highest_frequency needs");
    }
  }
}

support::TomlDocument read_with_overrides(const DesignSource& source) {
  support::TomlDocument document = support::TomlDocument::read(source.path);
  for (std::size_t i = 0; i < source.overrides.size(); ++i) {
    document.set(source.overrides[i], fmt::format("--set {}", i + 1));
  }
  if (!source.varied.empty()) document.set(source.varied, "--vary");
  return document;
}

// The value of a parameter that a text names: "=rail_height".
double find_parameter(const TomlTable& parameters, const TomlValue& value) {
  const std::string name = value.string().substr(1);
  std::vector<std::string> names;
  for (const auto& [known, number] : parameters.entries()) {
    if (known == name) return number.number(support::any(""));
    names.push_back(known);
  }
  throw value.error(fmt::format("names the parameter '{}', which [parameters] does not have{}", name,
                                support::nearest_name_hint(name, names)));
}

// Replaces the texts that name parameters, in a value and what it contains, by numbers.
void insert_in_value(const TomlTable& parameters, const TomlValue& value, support::TomlDocument& document) {
  if (value.is_table()) {
    for (const auto& [name, entry] : value.table().entries()) insert_in_value(parameters, entry, document);
  } else if (value.is_array()) {
    for (const TomlValue& item : value.items()) insert_in_value(parameters, item, document);
  } else if (value.is_string() && value.string().starts_with('=')) {
    document.set(fmt::format("{}={:.17g}", value.key(), find_parameter(parameters, value)),
                 support::format_place(value.location()));
  }
}

// Walking through a document marks its keys as known, so that another one is changed.
void insert_parameters(const support::TomlDocument& walked, support::TomlDocument& document) {
  const TomlTable root = walked.root(), parameters = root.at("parameters").table();
  for (const auto& [name, value] : root.entries()) {
    if (name != "parameters" && name != "name") insert_in_value(parameters, value, document);
  }
}

// Names of the parameters that a value and what it contains name.
void list_used(const TomlValue& value, std::vector<std::string>& used) {
  if (value.is_table()) {
    for (const auto& [name, entry] : value.table().entries()) list_used(entry, used);
  } else if (value.is_array()) {
    for (const TomlValue& item : value.items()) list_used(item, used);
  } else if (value.is_string() && value.string().starts_with('=')) {
    used.push_back(value.string().substr(1));
  }
}

std::vector<std::string> list_used(const support::TomlDocument& document) {
  std::vector<std::string> used;
  const TomlTable root = document.root();
  for (const auto& [name, value] : root.entries()) {
    if (name != "parameters" && name != "name") list_used(value, used);
  }
  return used;
}

// A parameter that nothing names is mistyped. One may replace all texts that name another one, so that those
// of the file count, too.
void check_parameters_are_used(const DesignSource& source) {
  const support::TomlDocument document = read_with_overrides(source);
  const auto parameters = document.root().find_table("parameters");
  if (!parameters) return;
  const support::TomlDocument file = support::TomlDocument::read(source.path);
  std::vector<std::string> used = list_used(document), known;
  for (std::string& name : list_used(file)) used.push_back(std::move(name));
  if (const auto table = file.root().find_table("parameters"))
    for (const auto& [name, value] : table->entries()) known.push_back(name);
  for (const auto& [name, value] : parameters->entries()) {
    if (std::find(used.begin(), used.end(), name) != used.end()) continue;
    if (std::find(known.begin(), known.end(), name) != known.end()) {
      throw value.error(fmt::format(
          "is used by nothing; write \"={}\" in place of a number of the design, or leave it out", name));
    }
    throw value.error(known.empty()
                          ? "is no parameter of the design, which has no [parameters]"
                          : fmt::format("is no parameter of the design; it has '{}'{}",
                                        fmt::join(known, "', '"), support::nearest_name_hint(name, known)));
  }
}

}  // namespace

std::string read_source_text(const DesignSource& source) {
  std::string text = support::read_text_file(source.path);
  for (const std::string& one : source.overrides) text += fmt::format("\n# --set {}", one);
  return text;
}

std::string calc_file_hash(const std::filesystem::path& path) {
  return support::sha256(support::read_text_file(path));
}

support::TomlDocument read_document(const DesignSource& source) {
  support::TomlDocument document = read_with_overrides(source);
  if (!document.root().has("parameters")) return document;
  insert_parameters(read_with_overrides(source), document);
  check_parameters_are_used(source);
  return document;
}

Design read_design(const std::filesystem::path& path) {
  return read_design(DesignSource{.path = path});
}

Design read_design(const DesignSource& source) {
  const std::filesystem::path& path = source.path;
  const support::TomlDocument document = read_document(source);
  const TomlTable root = document.root();
  expect_keys(root, {"name", "parameters", "theory", "rotary_inertia", "materials", "sections", "points",
                     "lines", "springs", "rigid_offsets", "averages", "foundations", "mesh", "matrices",
                     "point_masses", "reference", "modes", "interface", "reduction"});
  Design design;
  design.name = root.string_or("name", path.stem().string());
  if (design.name.empty()) throw root.at("name").error("is empty");
  const InputFiles files = root.has("matrices") ? read_matrices(root, path.parent_path(), design)
                                                : read_beams(root, path.parent_path(), design);
  read_point_masses(root, design.model);
  if (design.matrices) add_point_masses(design.model.point_masses, *design.matrices);
  design.reference_node = read_reference(root, design.model);
  const TomlTable modes = root.at("modes").table();
  expect_keys(modes,
              {"count", "highest_frequency", "all", "numbers", "damping_ratio", "residual_damping_ratio"});
  design.reduction = read_reduction(root, design.model.mesh, design.reference_node, has_wanted_modes(modes));
  check_fixed_interface(root, design);
  read_wanted_modes(root, modes, design);
  read_damping(modes, design);
  const std::string text = read_source_text(source);
  design.provenance = {.design_text = text,
                       .design_hash = support::sha256(text),
                       .input_names = files.names,
                       .input_hashes = files.hashes,
                       .program_version = get_program_version(),
                       .algorithm_revision = kAlgorithmRevision};
  return design;
}

}  // namespace sprung::reduce
