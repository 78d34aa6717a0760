#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fem/beam_model.h"
#include "reduce/design/design_reduction.h"
#include "reduce/matrices/matrix_body.h"
#include "reduce/modes/wanted_modes.h"
#include "reduce/superelement/superelement.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/toml/toml.h"

namespace sprung::reduce {

/// What stage one starts from: a frame, its reference node, and the basis wanted.
struct Design {
  std::string name;
  fem::BeamModel model;
  /// In place of beams: then the model has nodes, points and point masses, and no elements. The matrices
  /// contain the point masses
  std::optional<MatrixBody> matrices = {};
  int reference_node = 0;  ///< 0-based; the origin of the body frame, where clamped modes are held
  Reduction reduction = {};
  WantedModes modes = {};                             ///< of the basis kClamped
  std::vector<double> damping_ratio;                  ///< of critical: one for all modes, or one for each
  std::optional<double> residual_damping_ratio = {};  ///< of the basis kFree; none: the one of all modes
  support::SourceLocation damping_where = {};
  Provenance provenance;
};

/// Reads a design file (reduce, "Design file") and the mesh file it names, and meshes its lines.
///
/// @throws support::InputError at the place of the fault: not TOML, unknown, missing or contradictory keys,
///         wrong types, values out of range, unknown materials, sections or points, a point on no node, a
///         frame in parts, faults of the mesh file
/// Checked by tests/reduce/design/design_test.cpp
Design read_design(const std::filesystem::path& path);

/// A design file, of which some values may be replaced by others.
struct DesignSource {
  std::filesystem::path path;
  std::vector<std::string> overrides = {};  ///< as `--set` takes them: "sections.rail.height=0.12"
  std::string varied = {};                  ///< a last one, which `--vary` gives; or ""
};
/// @throws support::InputError as read_design, faults of an override at `--set N`
Design read_design(const DesignSource& source);
/// The document with its overrides, and with numbers in place of the names of its parameters
/// ("=rail_height").
/// @throws support::InputError if it is not TOML, names a parameter that is not there, or has one that
/// nothing
///         names in it or in the file without its overrides
support::TomlDocument read_document(const DesignSource& source);
/// The text that provenance keeps: that of the file, and a comment for each override.
/// @throws support::InputError if it cannot be read
std::string read_source_text(const DesignSource& source);

/// SHA-256 of a file, as provenance keeps it.
/// @throws support::InputError if it cannot be read
std::string calc_file_hash(const std::filesystem::path& path);

/// Increased whenever the same design gives another file than before: other numbers, or a new dataset.
/// `build` makes files of an earlier revision again; it takes all others as up to date.
inline constexpr std::int64_t kAlgorithmRevision = 11;

}  // namespace sprung::reduce
