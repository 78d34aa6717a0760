#pragma once

#include <optional>
#include <vector>

#include "fem/mesh.h"
#include "reduce/certificate/interface_loads.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/toml/toml.h"

namespace sprung::reduce {

enum class BasisKind { kFree, kFixedInterface, kClamped };

/// Which basis a design wants, and for which loads.
struct Reduction {
  BasisKind basis = BasisKind::kClamped;
  std::optional<double> highest_hz;  ///< end of the band; of kClamped it may be missing
  double tolerance = 0.01;           ///< of kFree: share of the static flexibility that may be missing
  bool all_residual = false;         ///< of kFree: a residual vector for every load
  std::vector<InterfaceFreedom> interface;
  support::SourceLocation where = {};  ///< for messages
};

/// `[reduction]` and `[interface]` of a design (reduce, "Design file"). Without `[interface]` all freedoms of
/// every named point take loads, those at the reference node excepted.
///
/// @param modes_by_number  whether `[modes]` says which modes are wanted: then the basis is "clamped" unless
///                         it is given
/// @throws support::InputError at the place of the fault
/// Checked by tests/reduce/design/design_reduction_test.cpp
Reduction read_reduction(const support::TomlTable& root, const fem::Mesh& mesh, int reference_node,
                         bool modes_by_number);

}  // namespace sprung::reduce
