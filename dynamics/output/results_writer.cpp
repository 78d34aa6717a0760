#include "dynamics/output/results_writer.h"

#include <algorithm>

#include "dynamics/output/last_state.h"
#include "dynamics/output/partial_results.h"
#include "dynamics/output/results_model.h"

namespace sprung::dynamics {

namespace {

constexpr std::int64_t kResultsVersion = 2;

constexpr std::size_t kMostBuffered = std::size_t{1} << 28U;  // bytes of rows that are not written yet
constexpr std::size_t kRowsAtOnce = 1024;                     // whole chunks of most histories
constexpr double kSameOutput = 1e-9;                          // in outputs: times that differ by rounding

support::Hdf5Precision to_hdf5(StoredPrecision precision) {
  if (precision == StoredPrecision::kDouble) return support::Hdf5Precision::kDouble;
  return precision == StoredPrecision::kSingle ? support::Hdf5Precision::kCompressedSingle
                                               : support::Hdf5Precision::kCompressedRounded;
}

// Of a run from its start to its end.
double count_outputs(const ResultsHeader& header) {
  return (header.run.duration - header.start.time) / header.run.output_step + 1.0;
}

}  // namespace

StoragePlan plan_storage(const ResultsHeader& header, const RunHistories& histories) {
  StorageConditions conditions{.num_outputs = count_outputs(header),
                               .output_step = header.run.output_step,
                               .reported = header.output_points,
                               .stiffened_bodies = {}};
  for (const Body& body : header.model.bodies) {
    if (body.stiffening) conditions.stiffened_bodies.insert(body.name);
  }
  return {header.run.output, {histories.all().begin(), histories.all().end()}, std::move(conditions)};
}

ResultsWriter::ResultsWriter(const std::filesystem::path& path, const ResultsHeader& header)
    : file_(path, partial_name(path)),
      histories_(header.vehicle, header.model, header.sections,
                 header.adaptivity ? header.adaptivity->full : nullptr) {
  file_.attribute("/", "format", kResultsFormat);
  file_.attribute("/", "version", kResultsVersion);
  file_.attribute("/", "title", header.vehicle.name);
  file_.attribute("/", "units", "SI");
  file_.attribute("/", "program_version", SPRUNG_VERSION);
  file_.attribute("/", "complete", std::int64_t{0});
  write_results_model(file_, header);

  write_descriptions(header);
  make_datasets(header);
  make_last_state(file_, header.model);
  last_ = {.q = Eigen::VectorXd::Zero(header.model.num_coordinates),
           .v = Eigen::VectorXd::Zero(header.model.num_coordinates),
           .branches = {}};
  make_event_datasets(header.adaptivity ? *header.adaptivity->full : header.model);
}

// Writes what does not change in the run of the objects that histories belong to.
void ResultsWriter::write_descriptions(const ResultsHeader& header) {
  for (const Body& body : header.model.bodies) {
    const std::string group = "/bodies/" + body.name;
    file_.make_group(group);
    if (body.num_modes() == 0) continue;
    const std::vector<std::int64_t> numbers(body.mode_numbers.begin(), body.mode_numbers.end());
    file_.write(group + "/modal/mode_number", numbers);
  }
  const auto write_kind = [this](const std::string& group, std::string_view kind) {
    file_.make_group(group);
    file_.attribute(group, "kind", kind);
  };
  for (const auto& joint : header.model.joints) write_kind("/joints/" + joint->name, joint->kind());
  for (const auto& force : header.model.forces) write_kind("/forces/" + force->name, force->kind());
  for (const BodySections& body : header.sections.bodies()) {
    const std::string group = "/recovery/" + body.name();
    file_.write(group + "/station", body.positions(), "m");
    if (!body.sizes()) continue;
    file_.write(group + "/area", body.sizes()->area, "m^2");
    file_.write(group + "/section_modulus", body.sizes()->modulus, "m^3");
  }
}

// Makes the datasets of the histories that are stored.
void ResultsWriter::make_datasets(const ResultsHeader& header) {
  storage_ = std::make_unique<StoragePlan>(plan_storage(header, histories_));
  num_outputs_ = static_cast<std::size_t>(count_outputs(header) + kSameOutput);
  std::size_t row_size = 0;  // of all that is stored
  for (const History& history : histories_.all()) {
    const long every = storage_->every(history);
    if (every == 0) continue;
    stored_.push_back({.history = &history, .every = every});
    row_size += history.row_size * sizeof(double);
  }
  const std::size_t most_rows = kMostBuffered / row_size;
  for (Stored& stored : stored_) {
    const History& history = *stored.history;
    stored.dataset = &file_.make_growing(
        history.name, history.columns, history.unit, to_hdf5(storage_->precision(history)),
        {.number = count_rows(stored.every, num_outputs_), .most_per_chunk = most_rows});
    if (!history.role.empty()) file_.attribute(history.name, "role", history.role);
    if (stored.every > 1) file_.attribute(history.name, "every", std::int64_t{stored.every});
  }
}

// The first output, every `every`-th from there, and the last one of the run have rows.
// @param num_outputs  so far
std::size_t ResultsWriter::count_rows(long every, std::size_t num_outputs) const {
  const auto step = static_cast<std::size_t>(every);
  const bool has_last = num_outputs == num_outputs_ && num_outputs % step != 1 % step;
  return (num_outputs + step - 1) / step + (has_last ? 1 : 0);
}

void ResultsWriter::add(const Snapshot& snapshot) {
  const bool is_last = extent_.rows + 1 == num_outputs_;
  for (Stored& stored : stored_) {
    if (stored.until > 0 && !is_last) {
      --stored.until;
      continue;
    }
    stored.until = static_cast<std::size_t>(stored.every) - 1;
    stored.history->fill(snapshot, stored.dataset->next_row());
    file_.finish_row(*stored.dataset);
  }
  last_.time = snapshot.time;
  last_.q = snapshot.q;
  last_.v = snapshot.v;
  ++extent_.rows;
}

void ResultsWriter::make_event_datasets(const Model& full) {
  constexpr std::size_t kKindSize = 16, kTextSize = 120;
  std::size_t object_size = 1;
  for (const auto& force : full.forces) object_size = std::max(object_size, force->name.size());
  for (int i = 0; i < full.num_coordinates; ++i)
    object_size = std::max(object_size, full.coordinate_name(i).size());
  event_time_ = &file_.make_growing("/events/time", 0, "s");
  event_kind_ = &file_.make_growing_texts("/events/kind", kKindSize);
  event_object_ = &file_.make_growing_texts("/events/object", object_size);
  event_text_ = &file_.make_growing_texts("/events/text", kTextSize);
}

void ResultsWriter::add(const Event& event) {
  file_.append(*event_time_, std::vector{event.time});
  file_.append_text(*event_kind_, event.kind);
  file_.append_text(*event_object_, event.object);
  file_.append_text(*event_text_, event.text);
  ++extent_.events;
}

void ResultsWriter::take_over(const PartialResults& partial, const ResultsExtent& extent,
                              const Checkpoint& checkpoint) {
  const support::Hdf5Reader& earlier = partial.file();
  for (Stored& stored : stored_) {
    const std::size_t rows = count_rows(stored.every, extent.rows);
    const auto step = static_cast<std::size_t>(stored.every);
    stored.until = (step - extent.rows % step) % step;
    for (std::size_t row = 0; row < rows; row += kRowsAtOnce) {
      file_.append(*stored.dataset,
                   earlier.real_rows(stored.history->name, row, std::min(kRowsAtOnce, rows - row)));
    }
  }
  extent_.rows = extent.rows;
  last_ = checkpoint.state;
  for (const Event& event : partial.read_events(extent.events)) add(event);
}

void ResultsWriter::write_checkpoint(const Checkpoint& checkpoint, const RunStatistics& statistics) {
  write_summary(statistics, checkpoint.statistics);
  const std::string bytes = pack_run_state(checkpoint, extent_, statistics);
  file_.overwrite(std::string(kCheckpointDataset),
                  std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
  has_checkpoint_ = true;
  file_.flush();
}

std::string ResultsWriter::copy_if_due() {
  using Clock = std::chrono::steady_clock;
  constexpr int kTimeBetweenCopies = 100;  // of the time that the last one took
  const Clock::time_point start = Clock::now();
  if (start < next_copy_) return {};
  const std::string problem = file_.copy_to_partial();
  const Clock::time_point end = Clock::now();
  next_copy_ = end + kTimeBetweenCopies * (end - start);
  return problem;
}

void ResultsWriter::write_summary(const RunStatistics& statistics, const TransientStatistics& transient) {
  write_results_summary(file_, statistics, transient);
  write_last_state(file_, last_);
}

void ResultsWriter::finish(const RunStatistics& statistics, const TransientStatistics& transient,
                           const std::vector<RunWarning>& warnings) {
  write_summary(statistics, transient);
  file_.attribute("/summary", "converged", std::int64_t{is_converged(warnings)});
  write_warnings(file_, warnings);
  if (has_checkpoint_) file_.remove(std::string(kCheckpointDataset));
  file_.attribute("/", "complete", std::int64_t{1});
  file_.commit();
}

std::filesystem::path ResultsWriter::abandon() {
  file_.keep_partial();
  return file_.partial();
}

void ResultsWriter::discard() {
  has_checkpoint_ = false;
  file_.discard();
}

}  // namespace sprung::dynamics
