#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fem/beam_model.h"
#include "reduce/design/design.h"
#include "reduce/modes/eigen_pairs.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce::testing {

/// A steel tube, 60 mm by 3 mm: section of the test bodies unless they say otherwise.
fem::BeamProperties make_section(bool shear_and_rotary_inertia = false);

/// Adds a straight run of elements to a model; its ends join nodes that are there already.
void add_line(fem::BeamModel& model, const Eigen::Vector2d& from, const Eigen::Vector2d& to, int num_elements,
              int section = 0);

/// K and M of a frame held at a node. @param node  0-based
ModalProblem make_modal_problem(const fem::BeamModel& model, int node);

/// @return 0-based node at a place, or -1
int find_node_at(const fem::BeamModel& model, const Eigen::Vector2d& position);

fem::BeamModel make_model(const std::vector<fem::BeamProperties>& sections = {make_section()});

/// Equal cantilevers of 1.2 m from the origin, the first at an angle, the others at equal steps.
fem::BeamModel make_star(int num_arms, double angle, int num_elements = 4);

/// A square of side 1 m about the origin with a spoke from the origin to each corner, turned by an angle.
fem::BeamModel make_spoked_square(double angle, int num_elements = 3);

/// A lattice of bars of 1 m with a corner at the origin, one element each.
fem::BeamModel make_lattice(int columns, int rows);

/// The same frame with its nodes in another order, its elements in another order and some of them turned
/// round.
fem::BeamModel renumber(const fem::BeamModel& model, std::uint64_t seed);

/// A design that holds a model at a place. Damping 2 %.
Design make_design(const fem::BeamModel& model, const Eigen::Vector2d& reference, const WantedModes& modes);

/// Two unlike arms with shear and rotary inertia, seven modes, two named points, a mesh file in its
/// provenance.
Superelement make_two_armed_body();

/// A free basis of a body whose reference node hangs on a member that is softer than the others by 1e6:
/// clamped there, the body swings as a whole. Loads at two points of the stiff member.
Design make_softly_held_design();

/// A file's bytes; empty if there is none.
std::string read_bytes(const std::filesystem::path& path);
/// Writes or replaces a file.
void write_text(const std::filesystem::path& path, const std::string& text);

/// The largest difference between two superelements of one frame in frequency (relative), inertia invariants
/// and the shapes at the nodes at equal places, each by its own scale.
double calc_difference(const Superelement& a, const Superelement& b);

/// what() of the exception that a call throws; fails the test if it throws none of that type.
template <typename Error, typename Function>
std::string message_of(Function&& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// Root of the sources, for designs that are part of them.
std::string source_path(const std::string& path);

}  // namespace sprung::reduce::testing
