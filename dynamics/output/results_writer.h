#pragma once

#include <Eigen/Core>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/adaptivity/mode_adaptation.h"
#include "dynamics/input/run.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/linear/vehicle_modes.h"
#include "dynamics/mode_choice/basis_choice.h"
#include "dynamics/output/run_histories.h"
#include "dynamics/output/storage_plan.h"
#include "dynamics/simulation/transient.h"
#include "dynamics/statistics/run_statistics.h"
#include "dynamics/statistics/run_warnings.h"
#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::dynamics {

/// The contents of a results file besides its time histories.
struct ResultsHeader {
  const Run& run;
  const Vehicle& vehicle;
  const Model& model;
  const Model& balance_model;  ///< the same on level ground
  const PlacedRoad& road;
  const State& start;
  std::vector<std::string> overrides;             ///< assignments of the command line, as given
  const Equilibrium* equilibrium = nullptr;       ///< null for a run that starts as given
  std::vector<VehicleMode> modes;                 ///< about the equilibrium
  const std::vector<std::string>& output_points;  ///< whose motion is reported
  const VehicleSections& sections;                ///< up to date at each output; has to outlive the writer
  const AdaptivityOptions* adaptivity = nullptr;  ///< null without adaptivity and without indicator
  const BasisChoice* choice = nullptr;            ///< of modes "auto"; null if there are none
};

/// Which histories the results file of a run holds, how often, and in which precision.
StoragePlan plan_storage(const ResultsHeader& header, const RunHistories& histories);

/// Root attribute `format` of a results file.
inline constexpr std::string_view kResultsFormat = "sprung-results";

class PartialResults;

/// How much a results file holds.
struct ResultsExtent {
  std::size_t rows = 0;  ///< outputs, the rows of time histories that are stored at each of them
  std::size_t events = 0;
};

/// Writes the results file during a run (dynamics/output/results.md). Checked by
/// tests/dynamics/program/output_test.py, resume_test.py
class ResultsWriter {
 public:
  /// @throws support::InputError if the file cannot be written
  ResultsWriter(const std::filesystem::path& path, const ResultsHeader& header);

  /// Takes over what a partial file of the same run holds, before anything is added.
  /// @param checkpoint  its last one, to which `extent` belongs
  /// @throws support::InputError if it holds less than `extent`, or is damaged
  void take_over(const PartialResults& partial, const ResultsExtent& extent, const Checkpoint& checkpoint);

  void add(const Snapshot& snapshot);
  void add(const Event& event);

  /// Writes what has been added, the summary up to the checkpoint and all that the run needs to continue from
  /// it.
  void write_checkpoint(const Checkpoint& checkpoint, const RunStatistics& statistics);
  bool has_checkpoint() const { return has_checkpoint_; }
  /// Copies the file behind a checkpoint to the partial name, unless copies would take more than 1 % of the
  /// time.
  /// @return "" or why it could not be copied
  std::string copy_if_due();
  /// Writes the summary of what has been added, or writes it anew.
  void write_summary(const RunStatistics& statistics, const TransientStatistics& transient);

  /// Writes summary and warnings and gives the file its final name.
  void finish(const RunStatistics& statistics, const TransientStatistics& transient,
              const std::vector<RunWarning>& warnings);
  /// Closes the file under its partial name, with the last checkpoint. @return that name
  std::filesystem::path abandon();
  /// Has the destructor remove the file, and leave one of the partial name as it is.
  void discard();
  const std::filesystem::path& partial() const { return file_.partial(); }
  const StoragePlan& storage() const { return *storage_; }

 private:
  // A history that is stored, and its dataset.
  struct Stored {
    const History* history;
    long every;             // outputs from one row to the next
    std::size_t until = 0;  // outputs before its next row
    support::Hdf5GrowingDataset* dataset = nullptr;
  };

  void write_descriptions(const ResultsHeader& header);
  void make_datasets(const ResultsHeader& header);
  std::size_t count_rows(long every, std::size_t num_outputs) const;
  void make_event_datasets(const Model& full);

  support::Hdf5Writer file_;
  RunHistories histories_;
  std::vector<Stored> stored_;
  // Of the events.
  support::Hdf5GrowingDataset *event_time_ = nullptr, *event_kind_ = nullptr, *event_object_ = nullptr,
                              *event_text_ = nullptr;
  std::unique_ptr<StoragePlan> storage_;
  std::size_t num_outputs_ = 0;  // of the whole run
  State last_;  // at the last output; of a run that is resumed, before its first one at the checkpoint
  ResultsExtent extent_;
  bool has_checkpoint_ = false;
  std::chrono::steady_clock::time_point next_copy_;  // no earlier; the first one comes at once
};

}  // namespace sprung::dynamics
