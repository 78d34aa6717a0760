#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/output/storage_plan.h"
#include "dynamics/section_loads/vehicle_sections.h"
#include "dynamics/simulation/transient.h"

namespace sprung::dynamics {

/// A quantity of a run over time, with one row at each output.
struct History : StoredHistory {
  std::size_t columns;  ///< of the dataset (dynamics/output/results.md); 0: it has one dimension
  std::string unit;
  std::function<void(const Snapshot&, std::span<double> row)> fill;  ///< computes the row of an output
  std::string role = {};                                             ///< of a channel, else empty
};

/// Every quantity of a run over time that a results file can hold.
class RunHistories {
 public:
  /// @param model     as run, made from the vehicle; has to outlive this
  /// @param sections  up to date whenever a row is computed; has to outlive this
  /// @param full      the model with the modes that the indicator judges; null: there is none
  RunHistories(const Vehicle& vehicle, const Model& model, const VehicleSections& sections,
               const Model* full);
  RunHistories(const RunHistories&) = delete;  // the rows of one element share what the first has computed
  RunHistories& operator=(const RunHistories&) = delete;

  /// In the order in which the rows of an output have to be computed.
  const std::vector<History>& all() const { return histories_; }

 private:
  void begin(std::optional<StoredGroup> group, const std::string& object);
  History& add(const std::string& name, std::size_t columns, const std::string& unit,
               std::function<void(const Snapshot&, std::span<double>)> fill);
  void add_motion(const std::string& name, std::size_t columns, const std::string& unit,
                  std::function<void(const Snapshot&, std::span<double>)> fill);
  void add_marker_motion(const std::string& group, std::size_t marker);
  void add_points();
  void add_bodies();
  void add_joints();
  void add_joint_coordinate(const Joint& joint, int row_of_joint);
  void add_forces();
  void add_wrenches(std::size_t force_index);
  void add_states(std::size_t force_index);
  void add_neglected(const Model& full);
  void add_sections(const VehicleSections& sections);

  const Model* model_;
  std::vector<VehiclePoint> points_;  // in the order of the model's markers
  std::vector<History> histories_;
  std::optional<StoredGroup> group_;           // of the histories that are being added
  std::string object_;                         // likewise
  std::vector<std::vector<double>> channels_;  // for each force element, of the present snapshot
  std::vector<Wrench> wrenches_;               // on all markers, by the present force element
};

}  // namespace sprung::dynamics
