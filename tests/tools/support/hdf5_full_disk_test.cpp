#include <fmt/format.h>
#include <sys/resource.h>

#include <csignal>
#include <cstddef>
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
  kUnusable = 14
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
    writer.checkpoint();
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

TEST_CASE("a write that fails leaves what was there at the last checkpoint, readable") {
  const TemporaryFolder folder;
  const ChildResult result = run_in_child([&] {
    limit_file_size(300000);
    const std::ptrdiff_t num_open = num_descriptors();
    try {
      Hdf5Writer writer(folder / "a.h5", folder / "a.partial.h5");
      Hdf5GrowingDataset& t = writer.make_growing("t", 0, "s");
      writer.append(t, std::vector<double>(1500, 0.25));
      writer.checkpoint();
      writer.append(t, std::vector<double>(100000, 0.5));
      writer.commit();
    } catch (const InputError&) {
      if (num_descriptors() != num_open) return kStillOpen;
      return Hdf5Reader(folder / "a.partial.h5").reals("t", {1500})[1499] == 0.25 ? kAsExpected : kUnusable;
    }
    return kNoError;
  });
  INFO("signal " << result.signal << ", output " << result.output);
  CHECK(result.exit_code == kAsExpected);
  CHECK_FALSE(std::filesystem::exists(folder / "a.h5.tmp"));
}
