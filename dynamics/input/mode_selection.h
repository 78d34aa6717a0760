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

/// How modes are chosen for bodies that are left to the program, `[mode_choice]`.
struct ModeChoiceSettings {
  double tolerance = 0.01;  ///< joint share that may be neglected, 0 to 0.5
};

/// What a run file asks for under `[modes]`, before it is known how many modes there are.
struct ModeRequest {
  enum class Kind { kCount, kNumbers, kAll, kAuto };
  Kind kind = Kind::kCount;
  int count = 0;             ///< for kCount, the lowest ones
  std::vector<int> numbers;  ///< for kNumbers, ascending, from 1
  std::string key;           ///< for messages: "modes.chassis"
  support::SourceLocation location;
};

/// What a run file asks for under `[modal_damping]`.
struct DampingRequest {
  std::vector<double> ratios;  ///< of critical, each ≥ 0
  std::string key;
  support::SourceLocation location;
};

using ModeRequests = std::map<std::string, ModeRequest>;        ///< by body
using DampingRequests = std::map<std::string, DampingRequest>;  ///< by body

/// Reads `[modes]`: of each body a count, a list of mode numbers, "all" or "auto".
ModeRequests read_modes(const support::TomlTable& table);
/// Reads `[mode_choice]`.
ModeChoiceSettings read_mode_choice(const support::TomlTable& table);
/// The bodies whose modes the program is to choose, by name.
std::vector<std::string> list_automatic_bodies(const ModeRequests& requests);
/// Reads `[modal_damping]`: of each body a ratio or a list of them.
DampingRequests read_modal_damping(const support::TomlTable& table);

/// The superelement that a run file's request about a body is about.
/// @throws support::InputError at the request's place: no such body, or a body without superelement
const reduce::Superelement& find_superelement(const std::string& body_name, const std::string& key,
                                              const support::SourceLocation& location,
                                              const Vehicle& vehicle);

/// The modes that the requests mean for this vehicle; bodies left rigid are left out. "auto" means all that
/// there are: what there is to choose from.
/// @throws support::InputError at the request's place: no such body, a body without superelement, more modes
///         than its file has, or a count that parts modes of equal frequency (explicit numbers may)
ModeSelection resolve_modes(const ModeRequests& requests, const Vehicle& vehicle);
/// The damping ratios that the requests mean; bodies whose damping stays the superelement's are left out. Of
/// a body with modes "auto" a list has one for each mode that there is.
/// @param selection  as by resolve_modes
/// @throws support::InputError at the request's place: no such body or superelement, or ratios that are
///         neither one nor as many as the body's active modes
ModalDamping resolve_modal_damping(const DampingRequests& requests, const ModeSelection& selection,
                                   const Vehicle& vehicle);
/// The damping of a smaller selection: of lists the ratios of the modes that stay.
ModalDamping keep_damping(const ModalDamping& damping, const ModeSelection& all, const ModeSelection& kept);

}  // namespace sprung::dynamics
