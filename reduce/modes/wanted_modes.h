#pragma once

#include <variant>
#include <vector>

#include "reduce/modes/clamped_modes.h"
#include "tools/support/errors/input_error.h"

namespace sprung::reduce {

struct ModeCount {
  int count = 0;  ///< the lowest ones
};
struct ModesUpTo {
  double frequency_hz = 0.0;  ///< all modes up to and with it
};
struct AllModes {};
struct ModeNumbers {
  std::vector<int> numbers;  ///< 1-based, ascending; may take part of a cluster
};

/// Which modes of a body a design wants.
struct WantedModes {
  std::variant<ModeCount, ModesUpTo, AllModes, ModeNumbers> wanted = AllModes{};
  support::SourceLocation where = {};  ///< for messages
};

/// Number of lowest modes that must be known to serve a request.
/// @return 1 … n
/// @throws support::InputError at request.where: more modes than the frame has, no mode up to the frequency
///         (with the lowest one), all modes of a frame too large for that
int calc_num_modes_needed(const WantedModes& request, const ModalProblem& problem,
                          const ClampedModeOptions& options);

/// Picks the modes of a request from the lowest ones.
/// @return 0-based columns of `modes`, ascending
/// @throws support::InputError at request.where if a count or frequency would take part of a cluster, which
///         the message names
/// Checked by tests/reduce/modes/wanted_modes_test.cpp
std::vector<int> select_modes(const WantedModes& request, const ClampedModes& modes, int num_needed);

}  // namespace sprung::reduce
