#include "tests/reduce/test_bodies.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <numeric>
#include <random>

#include "fem/assembly.h"
#include "reduce/modes/held_node.h"
#include "reduce/reduction/reduction.h"
#include "tests/reduce/free_body_truth.h"

namespace sprung::reduce::testing {

namespace {

Eigen::Vector2d turn(double x, double y, double angle) {
  return {std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y};
}

int get_node(fem::BeamModel& model, const Eigen::Vector2d& position) {
  if (const int node = find_node_at(model, position); node >= 0) return node;
  const auto num_nodes = static_cast<Eigen::Index>(model.mesh.node_ids.size());
  model.mesh.node_ids.push_back(num_nodes + 1);
  model.mesh.node_positions.conservativeResize(2, num_nodes + 1);
  model.mesh.node_positions.col(num_nodes) = position;
  return static_cast<int>(num_nodes);
}

std::vector<int> make_permutation(std::size_t size, std::mt19937_64& generator) {
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), generator);
  return order;
}

double calc_relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double scale) {
  return (a - b).cwiseAbs().maxCoeff() / scale;
}

}  // namespace

ModalProblem make_modal_problem(const fem::BeamModel& model, int node) {
  const fem::AssembledMatrices matrices = fem::assemble(model);
  return {.stiffness = remove_node(matrices.stiffness, node), .mass = remove_node(matrices.mass, node)};
}

fem::BeamProperties make_section(bool shear_and_rotary_inertia) {
  const double outer = 0.06, inner = 0.054, youngs_modulus = 2.1e11, density = 7850.0;
  const double area = std::numbers::pi / 4.0 * (outer * outer - inner * inner);
  const double second_moment = std::numbers::pi / 64.0 * (std::pow(outer, 4) - std::pow(inner, 4));
  fem::BeamProperties section{.axial_rigidity = youngs_modulus * area,
                              .bending_rigidity = youngs_modulus * second_moment,
                              .mass_per_length = density * area};
  if (shear_and_rotary_inertia) {
    section.shear_rigidity = 0.5 * youngs_modulus / 2.6 * area;
    section.rotary_inertia = density * second_moment;
  }
  return section;
}

fem::BeamModel make_model(const std::vector<fem::BeamProperties>& sections) {
  fem::BeamModel model;
  model.mesh.node_positions.resize(2, 0);
  model.sections = sections;
  for (std::size_t i = 0; i < sections.size(); ++i)
    model.mesh.section_names.push_back("section " + std::to_string(i));
  return model;
}

int find_node_at(const fem::BeamModel& model, const Eigen::Vector2d& position) {
  for (Eigen::Index node = 0; node < model.mesh.node_positions.cols(); ++node) {
    if ((model.mesh.node_positions.col(node) - position).norm() < 1e-9) return static_cast<int>(node);
  }
  return -1;
}

void add_line(fem::BeamModel& model, const Eigen::Vector2d& from, const Eigen::Vector2d& to, int num_elements,
              int section) {
  int previous = get_node(model, from);
  for (int i = 1; i <= num_elements; ++i) {
    const double share = static_cast<double>(i) / num_elements;
    const int next = get_node(model, from + share * (to - from));
    model.mesh.elements.push_back({.first = previous, .second = next, .section = section});
    previous = next;
  }
}

fem::BeamModel make_star(int num_arms, double angle, int num_elements) {
  fem::BeamModel model = make_model();
  for (int arm = 0; arm < num_arms; ++arm) {
    const double direction = angle + 2.0 * std::numbers::pi * arm / num_arms;
    add_line(model, Eigen::Vector2d::Zero(), 1.2 * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
             num_elements);
  }
  return model;
}

fem::BeamModel make_spoked_square(double angle, int num_elements) {
  fem::BeamModel model = make_model();
  const Eigen::Vector2d corners[] = {turn(0.5, -0.5, angle), turn(0.5, 0.5, angle), turn(-0.5, 0.5, angle),
                                     turn(-0.5, -0.5, angle)};
  for (int i = 0; i < 4; ++i) {
    add_line(model, Eigen::Vector2d::Zero(), corners[i], num_elements);
    add_line(model, corners[i], corners[(i + 1) % 4], num_elements);
  }
  return model;
}

fem::BeamModel make_lattice(int columns, int rows) {
  fem::BeamModel model = make_model();
  const int width = columns + 1, num_nodes = width * (rows + 1);
  model.mesh.node_positions.resize(2, num_nodes);
  for (int node = 0; node < num_nodes; ++node) {
    model.mesh.node_ids.push_back(node + 1);
    model.mesh.node_positions.col(node) << node % width, node / width;
    if (node % width < columns) model.mesh.elements.push_back({node, node + 1, 0});
    if (node / width < rows) model.mesh.elements.push_back({node, node + width, 0});
  }
  return model;
}

fem::BeamModel renumber(const fem::BeamModel& model, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const std::vector<int> place = make_permutation(model.mesh.node_ids.size(), generator);  // of each old node
  const std::vector<int> order = make_permutation(model.mesh.elements.size(), generator);
  fem::BeamModel result = model;
  for (std::size_t node = 0; node < place.size(); ++node) {
    result.mesh.node_positions.col(place[node]) =
        model.mesh.node_positions.col(static_cast<Eigen::Index>(node));
  }
  for (std::size_t e = 0; e < order.size(); ++e) {
    fem::Mesh::Element element = model.mesh.elements[static_cast<std::size_t>(order[e])];
    element.first = place[static_cast<std::size_t>(element.first)];
    element.second = place[static_cast<std::size_t>(element.second)];
    if ((generator() & 1U) != 0) std::swap(element.first, element.second);
    result.mesh.elements[e] = element;
  }
  for (fem::PointMass& point : result.point_masses) point.node = place[static_cast<std::size_t>(point.node)];
  for (fem::Mesh::NamedNode& point : result.mesh.named_nodes)
    point.node = place[static_cast<std::size_t>(point.node)];
  return result;
}

Design make_design(const fem::BeamModel& model, const Eigen::Vector2d& reference, const WantedModes& modes) {
  return {.name = "body",
          .model = model,
          .reference_node = find_node_at(model, reference),
          .modes = modes,
          .damping_ratio = {0.02},
          .provenance = {}};
}

double calc_difference(const Superelement& a, const Superelement& b) {
  const InertiaInvariants &i = a.inertia, &j = b.inertia;
  const double row = std::sqrt(i.second_moment);
  double difference =
      calc_relative(a.frequency_hz.cwiseQuotient(b.frequency_hz), Eigen::VectorXd::Ones(a.num_modes()), 1.0);
  for (const double value :
       {calc_relative(i.P, j.P, std::sqrt(i.mass)), calc_relative(i.c, j.c, row),
        calc_relative(i.d, j.d, row), calc_relative(i.M_ff, j.M_ff, 1.0), calc_relative(i.B, j.B, 1.0),
        calc_relative(i.x_phi_x, j.x_phi_x, row), calc_relative(i.x_phi_y, j.x_phi_y, row),
        calc_relative(i.y_phi_x, j.y_phi_x, row), calc_relative(i.y_phi_y, j.y_phi_y, row),
        calc_relative(i.phi_x_phi_x, j.phi_x_phi_x, 1.0), calc_relative(i.phi_x_phi_y, j.phi_x_phi_y, 1.0),
        calc_relative(i.phi_y_phi_y, j.phi_y_phi_y, 1.0), std::abs(i.mass / j.mass - 1.0),
        std::abs(i.second_moment / j.second_moment - 1.0)}) {
    difference = std::max(difference, value);
  }
  for (Eigen::Index node = 0; node < a.num_nodes(); ++node) {
    Eigen::Index other = 0;
    (b.node_positions.colwise() - a.node_positions.col(node)).colwise().norm().minCoeff(&other);
    difference = std::max(difference,
                          calc_relative(a.shapes.middleRows(3 * node, 3), b.shapes.middleRows(3 * other, 3),
                                        a.shapes.cwiseAbs().maxCoeff()));
  }
  return difference;
}

std::string source_path(const std::string& path) {
  return std::string(SPRUNG_SOURCE_DIR) + "/" + path;
}

Design make_softly_held_design() {
  fem::BeamModel model = make_model({make_section(), make_section()});
  model.sections[1].bending_rigidity *= 1e-6;
  model.sections[1].axial_rigidity *= 1e-6;
  model.sections[1].mass_per_length *= 1e-3;
  add_line(model, {0.0, 0.0}, {2.0, 0.0}, 8, 0);
  add_line(model, {0.0, 0.0}, {0.0, 0.5}, 2, 1);
  const std::vector<InterfaceFreedom> interface =  // names its nodes in the model
      make_interface(model, {find_node_at(model, {0.5, 0.0}), find_node_at(model, {2.0, 0.0})});
  Design design = make_design(model, {0.0, 0.5}, {});
  design.reduction = {
      .basis = BasisKind::kFree, .highest_hz = 100.0, .tolerance = 0.01, .interface = interface};
  return design;
}

Superelement make_two_armed_body() {
  fem::BeamModel model = make_model({make_section(true), make_section()});
  add_line(model, {0.3, -0.2}, {1.5, 0.4}, 3, 0);
  add_line(model, {1.5, 0.4}, {1.1, 1.7}, 2, 1);
  model.mesh.named_nodes = {{.name = "foot", .node = 0}, {.name = "tip", .node = 5}};
  Design design = make_design(model, {0.3, -0.2}, {.wanted = ModeCount{7}});
  // Its lowest free mode is at 39 Hz, so that the band has a bound and 1.5 times its end has a mode.
  design.reduction.highest_hz = 35.0;
  design.reduction.interface = {{.point = 1, .node = 5, .freedom = 0},
                                {.point = 1, .node = 5, .freedom = 1},
                                {.point = 1, .node = 5, .freedom = 2}};
  design.provenance = {.design_text = "# Träger\nname = \"body\"\n",
                       .design_hash = std::string(64, 'a'),
                       .input_names = {"frame.geo"},
                       .input_hashes = {std::string(64, 'b')},
                       .program_version = "9.8.7",
                       .algorithm_revision = 3};
  return make_superelement(design);
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace sprung::reduce::testing
