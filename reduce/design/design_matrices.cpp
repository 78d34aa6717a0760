#include "reduce/design/design_matrices.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "fem/gmsh/gmsh_mesher.h"
#include "reduce/design/design.h"
#include "reduce/design/known_keys.h"
#include "reduce/design/sizes.h"
#include "reduce/matrices/abaqus_matrix.h"
#include "reduce/matrices/abaqus_substructure.h"
#include "reduce/matrices/body_checks.h"
#include "reduce/matrices/calculix_matrix.h"
#include "reduce/matrices/ground.h"
#include "reduce/matrices/matrix_market.h"
#include "reduce/matrices/nastran_dmig.h"

namespace sprung::reduce {

namespace {

using support::TomlTable;
using support::TomlValue;

enum class MatrixFormat { kMatrixMarket, kAbaqus, kCalculix, kNastran };

MatrixFormat read_format(const TomlTable& table) {
  static const std::array<std::string, 4> kWords{"matrix-market", "abaqus", "calculix", "nastran"};
  const std::string& word = table.at("format").one_of(kWords);
  return static_cast<MatrixFormat>(std::find(kWords.begin(), kWords.end(), word) - kWords.begin());
}

// The files that a design names, and what was read from them.
class FileReader {
 public:
  FileReader(const TomlTable& root, const TomlTable& table, const std::filesystem::path& folder)
      : root_(root), table_(table), folder_(folder), format_(read_format(table)) {}

  MatrixSystem read() {
    reject_keys();
    MatrixSystem system;
    if (format_ == MatrixFormat::kCalculix) {
      system.freedoms = read_calculix_freedoms(open(table_.at("freedoms")));
    } else if (format_ == MatrixFormat::kMatrixMarket || table_.has("freedoms")) {
      system.freedoms = read_freedom_table(open(table_.at("freedoms")));
    }
    MatrixEntries stiffness = read_entries("stiffness", system.freedoms);
    MatrixEntries mass = read_entries("mass", system.freedoms);
    system.stiffness_path = stiffness.path;
    system.mass_path = mass.path;
    system.stiffness = make_symmetric_matrix(std::move(stiffness), system.freedoms);
    system.mass = make_symmetric_matrix(std::move(mass), system.freedoms);
    system.nodes = read_nodes();
    return system;
  }
  std::vector<std::string> names, hashes;
  bool is_substructure = false;  // the files say that the body is a condensed one

 private:
  void reject_keys() const {
    if (format_ == MatrixFormat::kNastran) {
      if (const auto found = table_.find("freedoms"))
        throw found->error("is not needed: the entries of a punch file name their freedoms");
      return;
    }
    for (const char* key : {"stiffness_name", "mass_name"}) {
      if (const auto found = table_.find(key)) throw found->error("belongs to the format \"nastran\" alone");
    }
  }
  std::filesystem::path open(const TomlValue& name) {
    std::filesystem::path path = folder_ / name.string();
    if (std::find(names.begin(), names.end(), name.string()) == names.end()) {
      names.push_back(name.string());
      hashes.push_back(calc_file_hash(path));
    }
    return path;
  }
  MatrixEntries read_entries(const std::string& key, FreedomList& freedoms) {
    const std::filesystem::path path = open(table_.at(key));
    switch (format_) {
      case MatrixFormat::kMatrixMarket:
        return read_matrix_market(path, freedoms);
      case MatrixFormat::kAbaqus:
        if (is_abaqus_substructure(path)) {
          is_substructure = true;
          return read_abaqus_substructure(path, key == "mass" ? "MASS" : "STIFFNESS", freedoms,
                                          table_.has("freedoms"));
        }
        return read_abaqus_matrix(path, freedoms, table_.has("freedoms"));
      case MatrixFormat::kCalculix:
        return read_calculix_matrix(path, freedoms);
      default:
        return read_nastran_dmig(path, table_.string_or(key + "_name", ""), freedoms);
    }
  }
  // From a table, or from a mesh beside it.
  NodeTable read_nodes() {
    const auto nodes = table_.find("nodes"), mesh = root_.find("mesh");
    if (nodes && mesh) throw nodes->error("stands beside 'mesh'; give either");
    if (!mesh) return read_node_table(open(table_.at("nodes")));
    const fem::Mesh read = fem::read_gmsh_file(open(*mesh));
    NodeTable table{.ids = read.node_ids, .positions = Eigen::Matrix3Xd::Zero(3, read.num_nodes())};
    table.positions.topRows<2>() = read.node_positions;
    return table;
  }

  const TomlTable& root_;
  const TomlTable& table_;
  std::filesystem::path folder_;
  MatrixFormat format_;
};

Eigen::Vector3d read_axis(const TomlValue& value) {
  static const std::array<std::string, 6> kWords{"x", "y", "z", "-x", "-y", "-z"};
  const auto index = std::find(kWords.begin(), kWords.end(), value.one_of(kWords)) - kWords.begin();
  return (index < 3 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(index % 3);
}

PlanarAxes read_axes(const TomlTable& table) {
  const auto axes = table.find("axes");
  if (!axes) return {};
  const std::vector<TomlValue> items = axes->items();
  if (items.size() != 2) throw axes->error(fmt::format("has {} axes, expected 2", items.size()));
  PlanarAxes read{.first = read_axis(items[0]), .second = read_axis(items[1])};
  if (std::abs(read.first.dot(read.second)) > 0.5) throw axes->error("names one axis twice, expected two");
  return read;
}

void check_expected(const TomlTable& table, const MatrixBody& body) {
  const auto expected = table.find_table("expected");
  if (!expected) return;
  expect_keys(*expected, {"mass", "centre_of_mass", "inertia", "tolerance"});
  ExpectedMass known{.where = expected->location(), .mass = {}, .centre = {}, .inertia = {}};
  if (expected->has("mass")) known.mass = expected->number("mass", support::positive("kg"));
  if (expected->has("inertia")) known.inertia = expected->number("inertia", support::positive("kg·m²"));
  if (const auto centre = expected->find("centre_of_mass")) {
    const std::vector<double> place = centre->numbers(support::any("m"), 2);
    known.centre = Eigen::Vector2d(place[0], place[1]);
  }
  known.tolerance =
      expected->number_or("tolerance", known.tolerance, {.unit = "", .above = 0.0, .at_most = 0.1});
  check_expected_mass(body, known);
}

}  // namespace

DesignMatrices read_design_matrices(const TomlTable& root, const std::filesystem::path& folder) {
  const TomlTable table = root.at("matrices").table();
  expect_keys(table, {"format", "stiffness", "mass", "stiffness_name", "mass_name", "freedoms", "nodes",
                      "axes", "length_unit", "mass_unit", "expected", "reduced"});
  const PlanarAxes axes = read_axes(table);
  const support::Quantity length{.unit = "m", .above = 0.0, .at_most = kLengths.largest};
  const support::Quantity mass{.unit = "kg", .above = 0.0, .at_most = kLargestMass};
  const MatrixUnits units{.length = table.number_or("length_unit", 1.0, length),
                          .mass = table.number_or("mass_unit", 1.0, mass)};
  FileReader reader(root, table, folder);
  DesignMatrices read{.body = make_matrix_body(reader.read(), axes, units),
                      .input_names = std::move(reader.names),
                      .input_hashes = std::move(reader.hashes)};
  read.body.is_reduced |= reader.is_substructure;
  if (const auto reduced = table.find("reduced")) read.body.is_reduced |= reduced->boolean();
  for (const std::string& remark : check_matrix_body(read.body)) read.body.remarks.push_back(remark);
  release_from_ground(read.body);
  check_expected(table, read.body);
  return read;
}

}  // namespace sprung::reduce
