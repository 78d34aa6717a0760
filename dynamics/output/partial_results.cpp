#include "dynamics/output/partial_results.h"

#include <fmt/format.h>

#include <cstdint>

#include "dynamics/output/results_model.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/files/bytes.h"

namespace sprung::dynamics {

namespace {

namespace fs = std::filesystem;

// The first bytes of a packed state: its layout. Increase the number with every change of what is packed.
constexpr std::uint64_t kStateLayout = 0x7370'7275'6e67'0004;  // "sprung", 4

support::Hdf5Reader open_partial(const fs::path& results) {
  const fs::path partial = partial_name(results);
  std::error_code ignored;
  if (!fs::exists(partial, ignored)) {
    throw support::InputError({.path = partial.string()},
                              "there is no such file, so there is no run to resume; run without --resume");
  }
  return support::Hdf5Reader(partial, support::Hdf5Reader::Compression::kAllowed);
}

template <class Bytes, class Extent>
void transfer_extent(Bytes& bytes, Extent& extent) {
  bytes.transfer(extent.rows);
  bytes.transfer(extent.events);
}

}  // namespace

fs::path partial_name(const fs::path& results) {
  return results.parent_path() / (results.stem().string() + ".partial" + results.extension().string());
}

std::string pack_run_state(const Checkpoint& checkpoint, const ResultsExtent& extent,
                           const RunStatistics& statistics) {
  support::ByteWriter bytes;
  bytes.transfer(kStateLayout);
  transfer_checkpoint(bytes, checkpoint);
  transfer_extent(bytes, extent);
  statistics.save(bytes);
  return bytes.bytes();
}

PartialResults::PartialResults(const fs::path& results, const ResultsHeader& header)
    : file_(open_partial(results)), start_(header.start), model_(header.model) {
  check_same_run(header);
}

void PartialResults::expect_same(bool is_same, std::string_view what) const {
  if (is_same) return;
  throw support::InputError(
      {.path = file_.path().string()},
      fmt::format("is of another run: {} changed since; undo that, or run without --resume", what));
}

void PartialResults::check_same_run(const ResultsHeader& header) const {
  expect_same(file_.string_attribute("/", "format") == kResultsFormat, "the format has");
  expect_same(file_.string_attribute("/", "program_version") == SPRUNG_VERSION, "the program's version has");
  expect_same(file_.strings("/model/run_text", {1})[0] == header.run.text, "the run file has");
  expect_same(file_.strings("/model/vehicle_text", {1})[0] == header.vehicle.text, "the vehicle file has");
  expect_same(file_.strings("/model/overrides", {-1}) == header.overrides, "the assignments of --set have");
  for (const auto& [name, superelement] : header.vehicle.superelements) {
    expect_same(
        file_.string_attribute("/model/superelements/" + name, "content_hash") == superelement.content_hash,
        fmt::format("superelement '{}' has", name));
  }
  for (const HistoryUse& history : header.vehicle.histories) {
    expect_same(file_.string_attribute("/model/resolved/histories/" + history.key, "sha256") == history.hash,
                fmt::format("the file '{}' has", history.file));
  }
  const RoadSamples road = sample_road(header);
  expect_same(file_.reals("/model/road/distance", {-1}) == road.distance &&
                  file_.reals("/model/road/height", {-1}) == road.height,
              "the road has");
}

std::optional<PartialResults::RunState> PartialResults::read_state(RunStatistics& statistics) const {
  const std::string dataset(kCheckpointDataset);
  if (!file_.has(dataset)) return std::nullopt;
  const std::vector<std::int64_t> values = file_.integers(dataset, {-1});
  const std::string packed(values.begin(), values.end());
  RunState state;
  try {
    support::ByteReader bytes(packed);
    std::uint64_t layout = 0;
    bytes.transfer(layout);
    if (layout != kStateLayout) {
      throw support::InputError(
          {.path = file_.path().string()},
          fmt::format("dataset '{}' was written by another version of the program, whose state this one does "
                      "not read; run without --resume, or resume with that version",
                      dataset));
    }
    transfer_checkpoint(bytes, state.checkpoint);
    transfer_extent(bytes, state.extent);
    statistics.restore(bytes);
    if (!bytes.at_end() || !state.checkpoint.fits(model_)) throw support::DamagedBytes();
  } catch (const support::DamagedBytes&) {
    throw support::InputError({.path = file_.path().string()},
                              fmt::format("dataset '{}' is damaged; run without --resume", dataset));
  }
  const State& start = state.checkpoint.start;
  expect_same(start.time == start_.time && start.q == start_.q && start.v == start_.v, "the start has");
  return state;
}

std::vector<Event> PartialResults::read_events(std::size_t count) const {
  const std::vector<double> times = file_.real_rows("/events/time", 0, count);
  const std::vector<std::int64_t> shape{static_cast<std::int64_t>(file_.shape("/events/time")[0])};
  const std::vector<std::string> kinds = file_.strings("/events/kind", shape),
                                 objects = file_.strings("/events/object", shape),
                                 texts = file_.strings("/events/text", shape);
  std::vector<Event> events;
  for (std::size_t i = 0; i < count; ++i) events.push_back({times[i], kinds[i], objects[i], texts[i]});
  return events;
}

}  // namespace sprung::dynamics
