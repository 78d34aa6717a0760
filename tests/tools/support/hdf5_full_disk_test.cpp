#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/catch.h"
#include "tests/tools/support/child_process.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_file.h"

// A limit on the size of files (RLIMIT_FSIZE) simulates the full disk: both fail in the middle of a write.
// Each case runs in a process of its own to its end, because HDF5 cleans up in its destructor and at exit.

using namespace sprung::support;

namespace {

enum Outcome : int {
  kAsExpected = 0,
  kNoError = 10,
  kWrongMessage = 11,
  kLeftBehind = 12,
  kStillOpen = 13,
  kUnusable = 14,
  kAtTheEnd = 15
};

void limit_file_size(rlim_t bytes) {
  std::signal(SIGXFSZ, SIG_IGN);  // as run_program does
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = bytes;
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

void lift_limit() {
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

// The number of open descriptors of this process: a removed file that is still open fills the disk.
std::ptrdiff_t num_descriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                       std::filesystem::directory_iterator());
}

void write_growing(Hdf5Writer& writer) {
  const std::vector<double> rows(3 * 512, 1.25);
  std::vector<Hdf5GrowingDataset*> bodies;
  for (int i = 0; i < 20; ++i) bodies.push_back(&writer.make_growing(fmt::format("bodies/b{}", i), 3, "m"));
  for (int step = 0; step < 20; ++step) {
    for (Hdf5GrowingDataset* body : bodies) writer.append(*body, rows);
  }
  writer.commit();
}

void write_at_once(Hdf5Writer& writer) {
  writer.write("matrix", Eigen::MatrixXd::Constant(1000, 700, 0.5), "m");
  for (int i = 0; i < 50; ++i) writer.write(fmt::format("x{}", i), std::vector<double>(1000, 0.25), "m");
  writer.commit();
}

void write_flushing(Hdf5Writer& writer) {
  Hdf5GrowingDataset& t = writer.make_growing("t", 0, "s");
  for (int i = 0; i < 1000; ++i) {
    writer.append(t, std::vector<double>(1000, 0.25));
    writer.flush();
  }
  writer.commit();
}

void write_checkpoints(Hdf5Writer& writer) {
  Hdf5GrowingDataset& t = writer.make_growing("t", 0, "s");
  for (int i = 0; i < 1000; ++i) {
    writer.append(t, std::vector<double>(1000, 0.25));
    writer.flush();
    writer.copy_to_partial();
  }
  writer.commit();
}

// Catches the error and tries to keep the partial file, as an interrupted run does: that fails as well.
void write_and_keep(Hdf5Writer& writer) {
  try {
    write_growing(writer);
  } catch (const InputError&) {
    writer.keep_partial();
  }
}

// The limited write, then a good one in the same process.
int write_limited(const TemporaryFolder& folder, rlim_t limit, void (*write)(Hdf5Writer&)) {
  const std::ptrdiff_t num_open = num_descriptors();
  limit_file_size(limit);
  const std::string target = (folder / "a.h5").string();
  try {
    Hdf5Writer writer(target, folder / "a.partial.h5");
    write(writer);
    return kNoError;
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    const bool named = message.starts_with(target + ": error: ");
    if (!named || message.find("File too large") == std::string_view::npos) return kWrongMessage;
  }
  // A checkpoint may have left a partial file; it is readable.
  if (std::filesystem::exists(folder / "a.partial.h5")) {
    const Hdf5Reader reader(folder / "a.partial.h5");
    std::filesystem::remove(folder / "a.partial.h5");
  }
  if (!folder.is_empty()) return kLeftBehind;
  if (num_descriptors() != num_open) return kStillOpen;
  lift_limit();
  Hdf5Writer writer(target);
  write_at_once(writer);
  return Hdf5Reader(target).reals("x49", {1000})[999] == 0.25 ? kAsExpected : kUnusable;
}

}  // namespace

TEST_CASE("a write that fails is an input error, leaves nothing behind and does not harm the process") {
  const rlim_t limit = GENERATE(0, 100, 2000, 20000, 300000, 1000000, 2000000, 4700000);
  const auto write =
      GENERATE(write_growing, write_at_once, write_flushing, write_checkpoints, write_and_keep);
  const TemporaryFolder folder;
  const ChildResult result = run_in_child([&] { return write_limited(folder, limit, write); });
  INFO("limit " << limit << ", signal " << result.signal << ", output " << result.output);
  CHECK(result.exit_code == kAsExpected);
  CHECK(result.output.empty());
}

TEST_CASE("a write that fails leaves an earlier file whole") {
  const TemporaryFolder folder;
  {
    Hdf5Writer writer(folder / "a.h5");
    writer.write("x", std::vector{1.0, 2.0}, "m");
    writer.commit();
  }
  const std::string before = read_bytes(folder / "a.h5");
  const ChildResult result = run_in_child([&] {
    limit_file_size(100000);
    try {
      Hdf5Writer writer(folder / "a.h5");
      write_growing(writer);
    } catch (const InputError&) {
      return kAsExpected;
    }
    return kNoError;
  });
  CHECK(result.exit_code == kAsExpected);
  CHECK(read_bytes(folder / "a.h5") == before);
  CHECK_FALSE(std::filesystem::exists(folder / "a.h5.tmp"));
}

TEST_CASE(
    "a writer that is abandoned before it has written its data leaves nothing, although the data would not "
    "fit") {
  const TemporaryFolder folder;
  const ChildResult result = run_in_child([&] {
    limit_file_size(5000);
    try {
      Hdf5Writer writer(folder / "a.h5");
      Hdf5GrowingDataset& t = writer.make_growing("t", 0, "s");
      writer.append(t, std::vector<double>(1000, 0.5));  // no whole chunk: not in the file yet
      throw std::runtime_error("another matter");
    } catch (const InputError&) {
      return kWrongMessage;
    } catch (const std::runtime_error&) {
      return folder.is_empty() ? kAsExpected : kLeftBehind;
    }
  });
  INFO("signal " << result.signal << ", output " << result.output);
  CHECK(result.exit_code == kAsExpected);
  CHECK(result.output.empty());
}

// Limits at small steps meet each part of a flush, and of the closing of a file, in which a chunk is written.
TEST_CASE("a disk that becomes full at any moment leaves what was flushed before, readable") {
  constexpr int kRowsPerFlush = 300, kFlushes = 17;
  const TemporaryFolder folder;
  int failures = 0, failed_closings = 0;
  for (rlim_t limit = 30000; failures == 0 || limit < 6000000; limit += 23700) {
    const ChildResult result = run_in_child([&] {
      limit_file_size(limit);
      const std::ptrdiff_t num_open = num_descriptors();
      int flushed = -1;
      try {
        Hdf5Writer writer(folder / "a.h5", folder / "a.partial.h5");
        Hdf5GrowingDataset& t = writer.make_growing("t", 0, "s");
        Hdf5GrowingDataset& x = writer.make_growing("x", 2, "m", Hdf5Precision::kCompressedSingle);
        Hdf5GrowingDataset& late = writer.make_growing("late", 40, "N");
        for (int row = 1; row <= kRowsPerFlush * kFlushes; ++row) {
          writer.append(t, std::vector{1.0 * row});
          writer.append(x, std::vector{std::sin(row), std::cos(1e3 * row)});
          if (row % kRowsPerFlush != 0) continue;
          // Its first chunk would fit where the state was.
          writer.append(writer.make_growing(fmt::format("begun {}", row), 20, "N"), std::vector<double>(20));
          writer.overwrite("state", std::vector(164000, static_cast<std::uint8_t>(row / kRowsPerFlush)));
          writer.flush();
          flushed = row;
        }
        writer.append(late, std::vector<double>(4000, 0.5));
        writer.commit();
      } catch (const InputError&) {
        if (num_descriptors() != num_open) return kStillOpen;
        if (std::filesystem::exists(folder / "a.h5.tmp")) return kLeftBehind;
        if (flushed < 0) return kAsExpected;
        const Hdf5Reader partial(folder / "a.partial.h5", Hdf5Reader::Compression::kAllowed);
        if (partial.reals("t", {flushed}).back() != flushed) return kUnusable;
        if (partial.reals("x", {flushed, 2})[1] != static_cast<float>(std::cos(1e3))) return kUnusable;
        if (partial.integers("state", {164000})[7] != flushed / kRowsPerFlush) return kUnusable;
        return flushed == kRowsPerFlush * kFlushes ? kAtTheEnd : kAsExpected;
      }
      return kNoError;
    });
    INFO("limit " << limit << ", signal " << result.signal << ", output " << result.output);
    if (result.exit_code == kNoError) break;
    CHECK((result.exit_code == kAsExpected || result.exit_code == kAtTheEnd));
    ++failures;
    if (result.exit_code == kAtTheEnd) ++failed_closings;
    std::filesystem::remove(folder / "a.partial.h5");
  }
  CHECK(failures > 10);
  CHECK(failed_closings > 0);
}

TEST_CASE("a copy that fails leaves the last one, and the writer goes on") {
  const TemporaryFolder folder;
  const ChildResult result = run_in_child([&] {
    Hdf5Writer writer(folder / "a.h5", folder / "a.partial.h5");
    Hdf5GrowingDataset& t = writer.make_growing("t", 0, "s");
    writer.append(t, std::vector<double>(1500, 0.25));
    writer.flush();
    if (!writer.copy_to_partial().empty()) return kWrongMessage;
    writer.append(t, std::vector<double>(100000, 0.5));
    writer.flush();
    limit_file_size(300000);
    if (writer.copy_to_partial() !=
        (folder / "a.partial.h5").string() + ": error: cannot be written: File too large")
      return kWrongMessage;
    if (std::filesystem::exists(folder / "a.partial.h5.tmp")) return kLeftBehind;
    if (Hdf5Reader(folder / "a.partial.h5").reals("t", {1500})[1499] != 0.25) return kUnusable;
    lift_limit();
    writer.append(t, std::vector{0.75});
    writer.commit();
    return Hdf5Reader(folder / "a.h5").reals("t", {101501}).back() == 0.75 ? kAsExpected : kUnusable;
  });
  INFO("signal " << result.signal << ", output " << result.output);
  CHECK(result.exit_code == kAsExpected);
  CHECK_FALSE(std::filesystem::exists(folder / "a.partial.h5"));
}
