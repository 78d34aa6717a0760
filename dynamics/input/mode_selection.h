#pragma once

#include <map>
#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Body → ascending 1-based mode numbers of its superelement. A body that is absent is rigid.
using ModeSelection = std::map<std::string, std::vector<int>>;
/// Body → damping ratios that replace the superelement's: one for all active modes, or one for each.
using ModalDamping = std::map<std::string, std::vector<double>>;

/// How the program chooses modes for bodies with modes = "auto", `[mode_choice]`.
struct ModeChoiceSettings {
  double tolerance = 0.01;  ///< largest share of all modes left out together, 0 to 0.5
};

/// A value of `[modes]` in a run file, as read without the superelement.
struct ModeRequest {
  enum class Kind { kCount, kNumbers, kAll, kAuto, kCertified };
  Kind kind = Kind::kCount;
  int count = 0;             ///< for kCount, of the lowest modes
  std::vector<int> numbers;  ///< for kNumbers, ascending, from 1
  std::string key;           ///< for messages: "modes.chassis"
  support::SourceLocation location;
};

/// A value of `[modal_damping]` in a run file.
struct DampingRequest {
  std::vector<double> ratios;  ///< of critical, each ≥ 0
  std::string key;
  support::SourceLocation location;
};

using ModeRequests = std::map<std::string, ModeRequest>;        ///< by body
using DampingRequests = std::map<std::string, DampingRequest>;  ///< by body

/// Reads `[modes]`: for each body a count, a list of mode numbers, "all", "auto" or
/// "certified".
/// Checked by tests/dynamics/input/mode_selection_test.cpp
ModeRequests read_modes(const support::TomlTable& table);
/// Reads `[mode_choice]`.
ModeChoiceSettings read_mode_choice(const support::TomlTable& table);
/// Names of the bodies whose modes the program chooses ("auto").
std::vector<std::string> list_automatic_bodies(const ModeRequests& requests);
/// Reads `[modal_damping]`: for each body a ratio or a list of ratios.
DampingRequests read_modal_damping(const support::TomlTable& table);

/// The superelement of a body that a run file names in one of its tables.
/// @param key       for messages: "modes.chassis"
/// @throws support::InputError at `location` if there is no such body, or it has no superelement
const reduce::Superelement& find_superelement(const std::string& body_name, const std::string& key,
                                              const support::SourceLocation& location,
                                              const Vehicle& vehicle);

/// The modes that the requests select for this vehicle, without rigid bodies. "auto" selects all modes, as
/// candidates for the choice. "certified" selects all that the certificate is about.
/// @throws support::InputError at the request if there is no such body, it has no superelement or fewer
/// modes,
///         or a count would select only some modes of equal frequency (explicit numbers may);
///         for "certified" if the certificate has no bound
/// Checked by tests/dynamics/input/mode_selection_test.cpp
ModeSelection resolve_modes(const ModeRequests& requests, const Vehicle& vehicle);
/// The damping ratios that the requests give, without bodies that keep their superelement's damping. For a
/// body with modes "auto" a list has one ratio for each available mode.
/// @param selection  from resolve_modes
/// @throws support::InputError at the request if there is no such body, it has no superelement, or the number
///         of ratios is neither one nor that of the body's active modes
/// Checked by tests/dynamics/input/mode_selection_test.cpp
ModalDamping resolve_modal_damping(const DampingRequests& requests, const ModeSelection& selection,
                                   const Vehicle& vehicle);
/// The damping of a smaller selection: lists keep the ratios of the modes that remain.
ModalDamping keep_damping(const ModalDamping& damping, const ModeSelection& all, const ModeSelection& kept);

}  // namespace sprung::dynamics
