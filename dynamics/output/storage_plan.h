#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dynamics/input/output_input.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// A time history of the results file, as far as the choice of what is stored asks.
struct StoredHistory {
  enum class Kind {
    kOther,   ///< a force, an acceleration or a rate, of which five digits are enough
    kMotion,  ///< a position, a velocity or a deflection: it is smooth
    kPlace,   ///< a length or an angle
    kFlags,   ///< it hardly ever changes, so that it takes nothing when it is compressed
  };
  std::string name;                       ///< of its dataset: "/points/chassis.seat/position"
  std::size_t row_size = 1;               ///< values at an output
  std::optional<StoredGroup> group = {};  ///< none: it is always stored
  std::string object = {};                ///< point, body, joint or force element that it belongs to
  Kind kind = Kind::kOther;
};

/// What the choice of histories depends on, besides `[output]`.
struct StorageConditions {
  double num_outputs = 0.0;
  double output_step = 0.0;           ///< [s]
  std::vector<std::string> reported;  ///< points in the summary
  std::set<std::string>
      stiffened_bodies;  ///< whose points do not follow from the motion by its linear shapes
};

/// Which histories of a run are stored, how often, and in which precision: what `[output]` asks for, and for
/// the rest all that fits into `output.size`. What does not fit is reduced in this order, until it does:
/// only the points in the summary, of which the others follow from the motion of bodies and modes; single
/// precision, compressed; forces, accelerations and rates rounded to five digits; stress resultants every 10
/// ms; reactions and wrenches every 10 ms; positions and velocities, which are smooth, every 10 ms. Checked
/// by tests/dynamics/output/storage_plan_test.cpp
class StoragePlan {
 public:
  StoragePlan(const OutputSettings& settings, const std::vector<StoredHistory>& histories,
              StorageConditions conditions);

  /// Outputs from one stored row of a history to the next; 0 if it is not stored.
  long every(const StoredHistory& history) const;
  /// Time and energies are doubles always; lengths, angles and motion are not rounded.
  StoredPrecision precision(const StoredHistory& history) const;
  double size() const { return size_; }  ///< estimate for the file [MB]
  /// What was reduced to make it fit, in words.
  const std::vector<std::string>& reductions() const { return reductions_; }

 private:
  struct Choice {
    StorageRequest::Which which;
    std::set<std::string> names;
    long every;
    long motion_every = 0;  // of positions and velocities, if not `every`
  };
  Choice& choice(StoredGroup group) { return choices_[static_cast<std::size_t>(group)]; }
  void reduce(const OutputSettings& settings, const std::vector<StoredHistory>& histories);
  long rows_between_coarse() const;
  bool thin_out(const OutputSettings& settings, StoredGroup group);
  bool thin_out_motion(const OutputSettings& settings);
  double estimate(const std::vector<StoredHistory>& histories) const;
  double count_bytes(const StoredHistory& history) const;

  StorageConditions conditions_;
  StoredPrecision precision_ = StoredPrecision::kDouble;
  std::array<Choice, kStoredGroupNames.size()> choices_;
  double size_ = 0.0;  // [MB]
  std::vector<std::string> reductions_;
};

/// The plan in a line of text: "about 18 MB; …".
std::string describe_storage(const StoragePlan& plan, const OutputSettings& settings);
/// The plan as a JSON object, the size in bytes.
support::Json make_storage_json(const StoragePlan& plan);

}  // namespace sprung::dynamics
