#include "tools/support/hdf5/exchange_file.h"

#include <hdf5.h>

#include "tests/catch.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_file.h"

using namespace sprung::support;

namespace {

// Class of a dataset's space, size of an element, and whether its texts have variable length.
struct Stored {
  H5S_class_t space;
  std::size_t size;
  bool is_variable_text;
};

Stored find_stored(const std::filesystem::path& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset), type = H5Dget_type(dataset);
  const Stored stored{.space = H5Sget_simple_extent_type(space),
                      .size = H5Tget_size(type),
                      .is_variable_text = H5Tis_variable_str(type) > 0};
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
  return stored;
}

}  // namespace

TEST_CASE("an exchange file has arrays row by row, scalars of rank 0 and texts of variable length") {
  const TemporaryFolder folder;
  Eigen::MatrixXd matrix(2, 3);
  matrix << 1.1, -2.2, 3.3, 4.4, 5.5, 6.6;
  {
    ExchangeFile file(folder / "a.h5");
    file.write_matrix("a matrix", matrix);
    file.write_vector("vector", matrix.row(1).transpose());
    file.write_number("number", 0.1);
    file.write_integer("integer", -7);
    file.write_text("text", "größer");
    file.write_integers("short", {3, -2147483647});
    file.write_long_integers("long", {1099511627776});
    file.make_group("group");
    file.attribute("group", "kind", "empty");
    file.commit();
  }
  CHECK(find_stored(folder / "a.h5", "number").space == H5S_SCALAR);
  CHECK(find_stored(folder / "a.h5", "short").size == 4);
  CHECK(find_stored(folder / "a.h5", "text").is_variable_text);
  const Hdf5Reader reader(folder / "a.h5");
  CHECK(reader.reals("/a matrix", {2, 3}) == std::vector<double>{1.1, -2.2, 3.3, 4.4, 5.5, 6.6});
  CHECK(reader.reals("/vector", {3}) == std::vector<double>{4.4, 5.5, 6.6});
  CHECK(reader.reals("/number", {}) == std::vector<double>{0.1});
  CHECK(reader.integers("/integer", {}) == std::vector<std::int64_t>{-7});
  CHECK(reader.integers("/short", {2}) == std::vector<std::int64_t>{3, -2147483647});
  CHECK(reader.integers("/long", {1}) == std::vector<std::int64_t>{1099511627776});
  CHECK(reader.has_attribute("/group", "kind"));
}

TEST_CASE("an exchange file that is not committed leaves nothing, and the older file as it was") {
  const TemporaryFolder folder;
  {
    ExchangeFile file(folder / "a.h5");
    file.write_number("number", 1.0);
  }
  CHECK(folder.is_empty());
  CHECK_THROWS_AS(ExchangeFile(folder / "none/a.h5"), InputError);
}
