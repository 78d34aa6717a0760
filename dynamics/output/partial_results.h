#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/output/results_writer.h"

namespace sprung::dynamics {

/// Dataset with the state of the run, in partial files only.
inline constexpr std::string_view kCheckpointDataset = "/checkpoint";

/// NAME.partial.h5 for NAME.h5.
std::filesystem::path partial_name(const std::filesystem::path& results);

/// The results that an interrupted or killed run has left, from which the same run can continue.
class PartialResults {
 public:
  /// @param results  name of the complete file   @param header  its start and model have to outlive this
  /// @throws support::InputError if there is no partial file, if it is damaged, or of another run: then the
  ///         message says what differs
  PartialResults(const std::filesystem::path& results, const ResultsHeader& header);

  /// A run at its last checkpoint.
  struct RunState {
    Checkpoint checkpoint;
    ResultsExtent extent;  ///< that belong to it; the file may hold more
  };
  /// @param[out] statistics  of the run, up to the checkpoint
  /// @return none where the run was interrupted before its first checkpoint
  /// @throws support::InputError if it is damaged
  std::optional<RunState> read_state(RunStatistics& statistics) const;
  std::vector<Event> read_events(std::size_t count) const;  ///< the first ones
  const support::Hdf5Reader& file() const { return file_; }

 private:
  void check_same_run(const ResultsHeader& header) const;
  void expect_same(bool is_same, std::string_view what) const;

  support::Hdf5Reader file_;
  const State& start_;  // of the run
  const Model& model_;
};

/// The content of the checkpoint's dataset.
std::string pack_run_state(const Checkpoint& checkpoint, const ResultsExtent& extent,
                           const RunStatistics& statistics);

}  // namespace sprung::dynamics
