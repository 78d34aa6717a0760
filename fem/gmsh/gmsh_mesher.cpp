#include "fem/gmsh/gmsh_mesher.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <cstdlib>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fem/gmsh/geo_script.h"
#include "fem/gmsh/gmsh_contents.h"
#include "fem/gmsh/gmsh_contents_bytes.h"
#include "fem/gmsh/msh_file.h"
#include "tools/support/files/bytes.h"
#include "tools/support/files/read_text_file.h"

namespace sprung::fem {

namespace {

using support::InputError;

constexpr int kLineType = 1;    // gmsh's number of the two-node line
constexpr int kPointType = 15;  // and of the point

// What is wrong with the input, without its place; it crosses from the child to the parent as text.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The first message of a level ("Error", "Warning") in gmsh's log, or "".
std::string find_logged(const std::string& level) {
  std::vector<std::string> log;
  gmsh::logger::get(log);
  for (const std::string& entry : log) {
    if (entry.rfind(level + ": ", 0) == 0) return entry.substr(level.size() + 2);
  }
  return {};
}

// Runs gmsh calls; what gmsh throws or logs as an error becomes a Refusal.
template <class Calls>
void run_gmsh(Calls&& calls) {
  gmsh::initialize(0, nullptr, /*readConfigFiles=*/false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::logger::start();
  try {
    calls();
  } catch (const Refusal&) {
    throw;
  } catch (const std::string& message) {  // of gmsh 4.8
    throw Refusal("gmsh: " + message);
  } catch (const std::runtime_error& error) {  // of gmsh 4.13
    throw Refusal(fmt::format("gmsh: {}", error.what()));
  }
  if (const std::string message = find_logged("Error"); !message.empty()) throw Refusal("gmsh: " + message);
}

// gmsh crashes on damaged files, and keeps locale, parameters and memory from one model to the next: each
// model gets a process of its own, which is thrown away.
template <class Calls>
GmshContents run_gmsh_in_child(const support::SourceLocation& where, const support::ChildLimits& limits,
                               Calls&& calls) {
  const auto work = [&] {
    GmshContents contents;
    run_gmsh([&] { contents = calls(); });
    return pack(contents);
  };
  try {
    return unpack(support::run_in_limited_child("gmsh", work, limits));
  } catch (const support::ChildFailure& failure) {
    throw InputError(where, failure.what());
  } catch (const support::DamagedBytes&) {
    throw InputError(where, "gmsh sent a damaged mesh");
  }
}

// Groups of an entity; a negative tag takes a curve in the opposite direction.
struct EntityGroups {
  std::vector<int> tags;  // positive
  bool is_reversed = false;
};
EntityGroups get_groups(int dimension, int entity) {
  EntityGroups groups;
  gmsh::model::getPhysicalGroupsForEntity(dimension, entity, groups.tags);
  for (int& tag : groups.tags) {
    groups.is_reversed = groups.is_reversed || tag < 0;
    tag = std::abs(tag);
  }
  return groups;
}

void get_elements(GmshContents& contents, const std::pair<int, int>& entity) {
  const auto [dimension, tag] = entity;
  const auto [groups, is_reversed] = get_groups(dimension, tag);
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> ids, nodes;
  gmsh::model::mesh::getElements(types, ids, nodes, dimension, tag);
  for (std::size_t t = 0; t < types.size(); ++t) {
    if (types[t] != kLineType && types[t] != kPointType) {
      std::string name;
      int of_dimension = 0, order = 0, num_nodes = 0, num_primary = 0;
      std::vector<double> parameters;
      gmsh::model::mesh::getElementProperties(types[t], name, of_dimension, order, num_nodes, parameters,
                                              num_primary);
      throw Refusal(
          fmt::format("element {} is a {}, expected straight two-node lines only", ids[t].front(), name));
    }
    for (std::size_t e = 0; e < ids[t].size(); ++e) {
      const auto id = static_cast<std::int64_t>(ids[t][e]);
      const auto node = [&](std::size_t i) { return static_cast<std::int64_t>(nodes[t][i]); };
      if (types[t] == kPointType) {
        contents.points.push_back({.id = id, .node = node(e), .groups = groups});
      } else {
        const auto [first, second] = is_reversed ? std::pair(2 * e + 1, 2 * e) : std::pair(2 * e, 2 * e + 1);
        contents.lines.push_back(
            {.id = id, .first = node(first), .second = node(second), .curve = tag, .groups = groups});
      }
    }
  }
}

GmshContents get_contents() {
  GmshContents contents;
  std::vector<std::size_t> ids;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(ids, coordinates, parameters);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    contents.nodes.push_back({.id = static_cast<std::int64_t>(ids[i]),
                              .position = Eigen::Map<const Eigen::Vector3d>(coordinates.data() + 3 * i)});
  }
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities);
  for (const std::pair<int, int>& entity : entities) get_elements(contents, entity);
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dimension, tag] : groups) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, tag, name);
    contents.groups.push_back({.dimension = dimension, .tag = tag, .name = name});
  }
  return contents;
}

// The number of elements of each curve with all sizes multiplied by a factor. Leaves no mesh behind.
std::map<int, std::size_t> count_elements(double size_factor) {
  double own_factor = 1.0, own_flexibility = 0.0;
  gmsh::option::getNumber("Mesh.CharacteristicLengthFactor", own_factor);
  gmsh::option::getNumber("Mesh.FlexibleTransfinite", own_flexibility);
  gmsh::option::setNumber("Mesh.CharacteristicLengthFactor", size_factor * own_factor);
  gmsh::option::setNumber("Mesh.FlexibleTransfinite", 1);  // numbers of elements that are given, too
  gmsh::model::mesh::generate(1);
  std::map<int, std::size_t> counts;
  gmsh::vectorpair curves;
  gmsh::model::getEntities(curves, 1);
  for (const auto& [dimension, tag] : curves) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> ids, nodes;
    gmsh::model::mesh::getElements(types, ids, nodes, dimension, tag);
    for (const std::vector<std::size_t>& of_type : ids) counts[tag] += of_type.size();
  }
  gmsh::model::mesh::clear();
  gmsh::option::setNumber("Mesh.CharacteristicLengthFactor", own_factor);
  gmsh::option::setNumber("Mesh.FlexibleTransfinite", own_flexibility);
  return counts;
}

// Millions of elements would take gmsh a minute and gigabytes before they can be counted. So they are counted
// in meshes of much larger elements, the largest first. A curve whose number does not depend on the size (at
// least so many elements along a circle) is left to the exact count.
void check_sizes() {
  std::map<int, std::size_t> coarser = count_elements(1e9);
  for (const double factor : {1e6, 1e3}) {
    const std::map<int, std::size_t> counts = count_elements(factor);
    for (const auto& [curve, count] : counts) {
      const double estimate = factor * static_cast<double>(count);  // rounded up by less than the factor
      if (count == coarser.at(curve) || estimate - factor < kMaxElementsPerLine) continue;
      throw Refusal(fmt::format("curve {} has about {:.1e} elements by its mesh size, expected at most {}",
                                curve, estimate, kMaxElementsPerLine));
    }
    coarser = counts;
  }
}

void mesh_script() {
  check_sizes();
  gmsh::model::mesh::generate(1);
}

// gmsh applies this option of a script when it saves a mesh, not when it makes one.
void scale_as_saved(GmshContents& contents) {
  double factor = 1.0;
  gmsh::option::getNumber("Mesh.ScalingFactor", factor);
  for (GmshContents::Node& node : contents.nodes) node.position *= factor;
}

// gmsh's tags count from 1, so point p has tag p + 1 and line l has tag l + 1; sections are tagged by first
// use.
void build_lines(const FrameGeometry& geometry) {
  std::map<std::string, int> point_tags;
  for (const FrameGeometry::Point& point : geometry.points) {
    const int tag = static_cast<int>(point_tags.size()) + 1;
    gmsh::model::geo::addPoint(point.position.x(), point.position.y(), 0.0, 0.0, tag);
    point_tags[point.name] = tag;
  }
  std::vector<std::pair<std::string, std::vector<int>>> sections;
  for (std::size_t l = 0; l < geometry.lines.size(); ++l) {
    const FrameGeometry::Line& line = geometry.lines[l];
    const int tag = static_cast<int>(l) + 1;
    gmsh::model::geo::addLine(point_tags.at(line.from), point_tags.at(line.to), tag);
    gmsh::model::geo::mesh::setTransfiniteCurve(tag, line.num_elements + 1);
    std::size_t s = 0;
    while (s < sections.size() && sections[s].first != line.section) ++s;
    if (s == sections.size()) sections.push_back({line.section, {}});
    sections[s].second.push_back(tag);
  }
  gmsh::model::geo::synchronize();
  for (const auto& [name, tag] : point_tags) {
    gmsh::model::addPhysicalGroup(0, {tag}, tag);
    gmsh::model::setPhysicalName(0, tag, name);
  }
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const int tag = gmsh::model::addPhysicalGroup(1, sections[s].second, static_cast<int>(s) + 1);
    gmsh::model::setPhysicalName(1, tag, sections[s].first);
  }
}

// gmsh finds the positions of a curve's nodes by numerical integration with an error of 1e-12 of its length.
// A thousand elements on a line would differ by 1e-9 in length, and a symmetric frame would not be symmetric.
// So the nodes are placed exactly here, and those of arcs, of which gmsh divides the chords, on the arcs.
void divide_exactly(GmshContents& contents, const FrameGeometry& geometry) {
  std::map<std::string, Eigen::Vector2d> points;
  for (const FrameGeometry::Point& point : geometry.points) points[point.name] = point.position;
  std::map<std::int64_t, Eigen::Vector3d*> positions;
  for (GmshContents::Node& node : contents.nodes) positions[node.id] = &node.position;
  std::vector<int> passed(geometry.lines.size(), 0);
  for (const GmshContents::Line& element : contents.lines) {
    const FrameGeometry::Line& line = geometry.lines.at(static_cast<std::size_t>(element.curve) - 1);
    const int k = ++passed[static_cast<std::size_t>(element.curve) - 1];
    if (k == line.num_elements) continue;
    const double s = static_cast<double>(k) / line.num_elements;
    const Eigen::Vector2d &from = points.at(line.from), &to = points.at(line.to);
    auto position = positions.at(element.second)->head<2>();
    if (!((position - (1.0 - s) * from - s * to).norm() <= 1e-6 * (to - from).norm())) {
      throw InputError(line.where, fmt::format("gmsh did not divide line '{}' evenly", line.name));
    }
    position = calc_place_on_line(line, from, to, s);
  }
}

void check_script(const std::filesystem::path& path) {
  const std::string text = support::read_text_file(path);
  if (text.empty()) throw InputError({.path = path.string()}, "the file is empty");
  const std::string options = path.string() + ".opt";
  if (std::filesystem::exists(options)) {
    throw InputError(
        {.path = path.string()},
        fmt::format("gmsh would read the options in '{}', too, whose changes would not be noticed; "
                    "put what matters into the script and remove that file",
                    options));
  }
  if (const std::optional<GeoStatement> found = find_writing_statement(text)) {
    throw InputError({.path = path.string(), .line = found->line, .column = found->column},
                     fmt::format("'{}' writes a file or runs a program, which reading a mesh does not; take "
                                 "the statement out of the script",
                                 found->word));
  }
  if (const std::optional<GeoStatement> found = find_dropped_statement(text)) {
    throw InputError(
        {.path = path.string(), .line = found->line, .column = found->column},
        "the file ends within this line, of which gmsh reads the first statement only: end the line");
  }
}

void check_element_counts(const GmshContents& contents) {
  std::map<int, int> counts;
  for (const GmshContents::Line& line : contents.lines) {
    if (++counts[line.curve] > kMaxElementsPerLine) {
      throw Refusal(fmt::format("curve {} has more than {} elements", line.curve, kMaxElementsPerLine));
    }
  }
}

void check_counts(const MshDeclaration& declared, const GmshContents& contents) {
  const auto check = [&](const char* what, std::int64_t expected, std::size_t read) {
    if (expected == static_cast<std::int64_t>(read)) return;
    const std::string warning = find_logged("Warning");
    throw Refusal(
        fmt::format("the file declares {} {}, but {} could be read: it is truncated, or some belong to no "
                    "element or have the same number{}{}",
                    expected, what, read, warning.empty() ? "" : "; gmsh: ", warning));
  };
  check("nodes", declared.num_nodes, contents.nodes.size());
  check("elements", declared.num_elements, contents.lines.size() + contents.points.size());
}

void replace_groups(const MshDeclaration& declared, GmshContents& contents) {
  const auto replace = [&](auto& element) {
    const auto group = declared.element_groups.find(element.id);
    if (group == declared.element_groups.end()) return;
    element.groups.clear();
    if (group->second != 0) element.groups.push_back(std::abs(group->second));
  };
  for (GmshContents::Point& point : contents.points) replace(point);
  for (GmshContents::Line& line : contents.lines) replace(line);
}

}  // namespace

Mesh mesh_lines(const FrameGeometry& geometry) {
  check_frame_geometry(geometry);
  const support::SourceLocation where = geometry.lines.front().where;
  GmshContents contents = run_gmsh_in_child(where, {}, [&] {
    gmsh::model::add("frame");
    build_lines(geometry);
    gmsh::model::mesh::generate(1);
    return get_contents();
  });
  divide_exactly(contents, geometry);
  return make_mesh(std::move(contents), where, geometry.may_have_parts);
}

Mesh read_gmsh_file(const std::filesystem::path& path, const support::ChildLimits& limits,
                    bool may_have_parts) {
  const support::SourceLocation where{.path = path.string()};
  const bool is_script = path.extension() == ".geo";
  MshDeclaration declared;
  if (is_script) {
    check_script(path);
  } else if (path.extension() == ".msh") {
    declared = read_msh_declaration(path);
  } else {
    throw InputError(where, "the file's name must end in .geo or .msh");
  }
  GmshContents contents = run_gmsh_in_child(where, limits, [&] {
    gmsh::model::add(path.stem().string());
    gmsh::merge(path.string());
    if (is_script) mesh_script();
    GmshContents read = get_contents();
    if (is_script) {
      check_element_counts(read);
      scale_as_saved(read);
    } else {
      check_counts(declared, read);
    }
    return read;
  });
  if (!is_script) replace_groups(declared, contents);
  return make_mesh(std::move(contents), where, may_have_parts);
}

}  // namespace sprung::fem
