#include "tools/support/hdf5/foreign_file.h"

#include <fstream>
#include <string>

#include "tests/catch.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/hdf5/hdf5_file.h"

using namespace sprung;

namespace {

void write_format(const std::filesystem::path& path, const std::string& format) {
  support::Hdf5Writer file(path);
  file.attribute("/", "format", format);
  file.commit();
}

}  // namespace

TEST_CASE("A file is foreign when it is neither ours, nor empty, nor damaged HDF5") {
  const TemporaryFolder folder;
  CHECK_FALSE(support::is_foreign_file(folder / "absent", "sprung-results"));
  std::ofstream(folder / "empty.h5").flush();
  CHECK_FALSE(support::is_foreign_file(folder / "empty.h5", "sprung-results"));
  std::ofstream(folder / "text.h5") << "vehicle = \"vehicle.toml\"\n";
  CHECK(support::is_foreign_file(folder / "text.h5", "sprung-results"));
  write_format(folder / "ours.h5", "sprung-results");
  CHECK_FALSE(support::is_foreign_file(folder / "ours.h5", "sprung-results"));
  write_format(folder / "other.h5", "sprung-superelement");
  CHECK(support::is_foreign_file(folder / "other.h5", "sprung-results"));
  std::filesystem::resize_file(folder / "other.h5", 60);  // only its signature is left
  CHECK_FALSE(support::is_foreign_file(folder / "other.h5", "sprung-results"));
}
