#include "dynamics/input/superelement_cache.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <filesystem>
#include <limits>

#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"
#include "tests/dynamics/input/lumped_superelement.h"
#include "tests/tools/support/temporary_folder.h"

using namespace sprung;
using dynamics::SuperelementCache;

namespace {

constexpr std::int64_t kAnyAge = std::numeric_limits<std::int64_t>::min();

std::filesystem::path write_body(const std::filesystem::path& folder, double frequency) {
  return test::write_lumped_superelement({.name = "frame",
                                          .nodes = {{"", {0.0, 0.0}, 3.0}, {"left", {-1.2, 0.1}, 2.0}},
                                          .frequencies = {frequency, 2.0 * frequency}},
                                         folder);
}

}  // namespace

TEST_CASE("A superelement that was read before is not read again, by whatever path it is asked for") {
  const TemporaryFolder folder;
  const std::filesystem::path path = write_body(folder.path(), 5.0);
  std::filesystem::create_symlink(path, folder / "link.h5");
  SuperelementCache cache(kAnyAge);
  const reduce::Superelement expected = reduce::read_superelement(path);
  for (const std::filesystem::path& one : {path, folder / "link.h5", path}) {
    const reduce::Superelement found = cache.read(one);
    CHECK(found.content_hash == expected.content_hash);
    CHECK(found.frequency_hz == expected.frequency_hz);
    CHECK(found.shapes == expected.shapes);
  }
  CHECK(cache.num_reads() == 1);
}

TEST_CASE("A superelement whose file was replaced is read again") {
  const TemporaryFolder folder;
  SuperelementCache cache(kAnyAge);
  CHECK(cache.read(write_body(folder.path(), 5.0)).frequency_hz[0] == 5.0);
  CHECK(cache.read(write_body(folder.path(), 6.0)).frequency_hz[0] == 6.0);
  CHECK(cache.num_reads() == 2);
}

TEST_CASE("A superelement whose file was changed where it is, with its size, is read again") {
  const TemporaryFolder folder;
  const std::filesystem::path path = write_body(folder / "a", 5.0), other = write_body(folder / "b", 6.0);
  REQUIRE(std::filesystem::file_size(path) == std::filesystem::file_size(other));
  SuperelementCache cache(kAnyAge);
  CHECK(cache.read(path).frequency_hz[0] == 5.0);
  write_bytes(path, read_bytes(other));
  // Within one tick of the clock the time may still be the same: it is set to another one.
  const timespec times[] = {{.tv_sec = 1, .tv_nsec = 0}, {.tv_sec = 1, .tv_nsec = 0}};
  REQUIRE(utimensat(AT_FDCWD, path.c_str(), times, 0) == 0);
  CHECK(cache.read(path).frequency_hz[0] == 6.0);
}

TEST_CASE("A superelement whose file is too young to tell a later change by its times is not kept") {
  const TemporaryFolder folder;
  const std::filesystem::path path = write_body(folder.path(), 5.0);
  SuperelementCache cache(std::int64_t{3600} * 1'000'000'000);  // an hour
  cache.read(path);
  cache.read(path);
  CHECK(cache.num_reads() == 2);
}

TEST_CASE("A file that cannot be used is an error each time") {
  const TemporaryFolder folder;
  SuperelementCache cache(kAnyAge);
  write_bytes(folder / "bad.h5", "no superelement");
  for (const char* name : {"bad.h5", "none.h5"}) {
    const std::filesystem::path path = folder / name;
    const std::string expected = test::input_error_of([&] { reduce::read_superelement(path); });
    CHECK_FALSE(expected.empty());
    CHECK(test::input_error_of([&] { cache.read(path); }) == expected);
    CHECK(test::input_error_of([&] { cache.read(path); }) == expected);
  }
}
