#include <hdf5.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/tools/support/error_message.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_file.h"

using namespace sprung::support;

namespace {

// A small file of every type, for the errors of reading.
class SmallFile {
 public:
  SmallFile() : path_((folder_ / "s.h5").string()) {
    Hdf5Writer writer(path_);
    const std::vector<double> six = {1, 2, 3, 4, 5, 6};
    writer.write("modes/shape", Eigen::MatrixXd::Constant(3, 2, 1.5), "m");
    writer.write("cube", six, {1, 2, 3}, "m");
    writer.write("ids", std::vector<std::int64_t>{1, 2});
    writer.write("names", std::vector<std::string>{"a", "b"});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    writer.write("bad", Eigen::Matrix2d{{0.0, 1.0}, {-INFINITY, 2.0}}, "m");
    writer.write("bad_cube", std::vector{0.0, 1.0, 2.0, nan}, {2, 1, 2}, "m");
    writer.attribute("/", "real", 1.5);
    writer.attribute("/", "not_finite", std::numeric_limits<double>::quiet_NaN());
    writer.attribute("/", "integer", std::int64_t{2});
    writer.attribute("/", "text", "word");
    writer.commit();
  }

  // What a call on the file says, without the path.
  std::string error(const std::function<void(const Hdf5Reader&)>& call) const {
    const Hdf5Reader reader(path_);
    const std::string message = error_message<InputError>([&] { call(reader); });
    const std::string start = path_ + ": error: ";
    REQUIRE_THAT(message, Catch::Matchers::StartsWith(start));
    return message.substr(start.size());
  }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

// Another program's file: `fill` puts one dataset "x" into it.
std::string foreign_error(const std::function<void(hid_t)>& fill,
                          const std::function<void(const Hdf5Reader&)>& call) {
  const TemporaryFolder folder;
  const std::string path = (folder / "f.h5").string();
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  fill(file);
  H5Fclose(file);
  const std::string message = error_message<InputError>([&] { call(Hdf5Reader(path)); });
  return message.substr(path.size());
}

void make_foreign_dataset(hid_t file, hid_t type, std::vector<hsize_t> shape,
                          hid_t properties = H5P_DEFAULT) {
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t dataset = H5Dcreate2(file, "x", type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  REQUIRE(dataset >= 0);
  H5Dclose(dataset);
  H5Sclose(space);
}

}  // namespace

TEST_CASE("a file that another library of the process has open can be read") {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.h5").string();
  {
    Hdf5Writer writer(path);
    writer.write("ids", std::vector<std::int64_t>{1, 2});
    writer.commit();
  }
  const hid_t other = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  REQUIRE(other >= 0);
  CHECK(Hdf5Reader(path).integers("/ids", {2}) == std::vector<std::int64_t>{1, 2});
  CHECK(H5Fclose(other) == 0);  // it is still that library's
}

TEST_CASE("a dataset that is missing or of another type is refused") {
  const SmallFile file;
  CHECK(file.error([](const Hdf5Reader& r) {
    r.reals("modes/mass", {1, 1});
  }) == "dataset 'modes/mass' is missing");
  CHECK(file.error([](const Hdf5Reader& r) { r.reals("/none/mass", {1}); }) ==
        "dataset '/none/mass' is missing");
  CHECK(file.error([](const Hdf5Reader& r) { r.strings("modes", {-1}); }) == "'modes' is not a dataset");
  CHECK(file.error([](const Hdf5Reader& r) { r.shape("none"); }) == "dataset 'none' is missing");
}

TEST_CASE("a dataset of another shape is refused with both shapes") {
  const SmallFile file;
  CHECK(file.error([](const Hdf5Reader& r) {
    r.reals("modes/shape", {3, 3});
  }) == "dataset 'modes/shape' must have shape 3×3, has 3×2");
  CHECK(file.error([](const Hdf5Reader& r) {
    r.reals("modes/shape", {-1, 4});
  }) == "dataset 'modes/shape' must have shape any×4, has 3×2");
  CHECK(file.error([](const Hdf5Reader& r) { r.reals("modes/shape", {6}); }) ==
        "dataset 'modes/shape' must have shape 6, has 3×2");
  CHECK(file.error([](const Hdf5Reader& r) {
    r.reals("cube", {2, 3});
  }) == "dataset 'cube' must have shape 2×3, has 1×2×3");
  CHECK(file.error([](const Hdf5Reader& r) { r.integers("ids", {3}); }) ==
        "dataset 'ids' must have shape 3, has 2");
  CHECK(file.error([](const Hdf5Reader& r) {
    r.integers("ids", {2, 1});
  }) == "dataset 'ids' must have shape 2×1, has 2");
}

TEST_CASE("a dataset of another type is refused with both types") {
  const SmallFile file;
  CHECK(file.error([](const Hdf5Reader& r) { r.reals("ids", {2}); }) ==
        "dataset 'ids' must hold real numbers, holds integers");
  CHECK(file.error([](const Hdf5Reader& r) { r.reals("names", {2}); }) ==
        "dataset 'names' must hold real numbers, holds strings");
  CHECK(file.error([](const Hdf5Reader& r) {
    r.integers("modes/shape", {3, 2});
  }) == "dataset 'modes/shape' must hold integers, holds real numbers");
  CHECK(file.error([](const Hdf5Reader& r) { r.strings("ids", {-1}); }) ==
        "dataset 'ids' must hold strings, holds integers");
}

TEST_CASE("a number that is not finite is refused with its position") {
  const SmallFile file;
  CHECK(file.error([](const Hdf5Reader& r) {
    r.reals("bad", {2, 2});
  }) == "dataset 'bad' has -inf at [1, 0]");
  CHECK(file.error([](const Hdf5Reader& r) {
    r.reals("bad_cube", {2, 1, 2});
  }) == "dataset 'bad_cube' has nan at [1, 0, 1]");
}

TEST_CASE("an attribute that is missing or of another type is refused") {
  const SmallFile file;
  CHECK(file.error([](const Hdf5Reader& r) { r.integer_attribute("/", "none"); }) ==
        "attribute 'none' of '/' is missing");
  CHECK(file.error([](const Hdf5Reader& r) { r.integer_attribute("none", "real"); }) == "'none' is missing");
  CHECK(file.error([](const Hdf5Reader& r) { r.integer_attribute("/", "real"); }) ==
        "attribute 'real' of '/' must hold integers, holds real numbers");
  CHECK(file.error([](const Hdf5Reader& r) { r.integer_attribute("/", "text"); }) ==
        "attribute 'text' of '/' must hold integers, holds strings");
  CHECK(file.error([](const Hdf5Reader& r) { r.real_attribute("/", "text"); }) ==
        "attribute 'text' of '/' must hold real numbers, holds strings");
  CHECK(file.error([](const Hdf5Reader& r) { r.real_attribute("/", "not_finite"); }) ==
        "attribute 'not_finite' of '/' must be finite");
  CHECK(file.error([](const Hdf5Reader& r) { r.string_attribute("/", "real"); }) ==
        "attribute 'real' of '/' must hold strings, holds real numbers");
}

TEST_CASE("a dataset that declares more than its file holds takes no memory") {
  // 10¹² doubles in a file of a kilobyte or two, none of them ever written.
  const auto fill = [](hid_t file) {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = 1024;
    H5Pset_chunk(properties, 1, &chunk);
    make_foreign_dataset(file, H5T_IEEE_F64LE, {1000000000000}, properties);
    H5Pclose(properties);
  };
  CHECK(foreign_error(fill, [](const Hdf5Reader& r) { r.reals("x", {-1}); }) ==
        ": error: dataset 'x' declares 1000000000000 values, but holds only 0 bytes (it is damaged, or "
        "compressed)");
}

TEST_CASE("sizes whose product overflows are refused") {
  const auto fill = [](hid_t file) {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    const std::array<hsize_t, 2> chunk{16, 16};
    H5Pset_chunk(properties, 2, chunk.data());
    make_foreign_dataset(file, H5T_IEEE_F64LE, {hsize_t{1} << 31U, hsize_t{1} << 31U}, properties);
    H5Pclose(properties);
  };
  CHECK_THAT(foreign_error(fill,
                           [](const Hdf5Reader& r) {
                             r.reals("x", {-1, -1});
                           }),
             Contains("declares 2147483648×2147483648 values, but holds only 0 bytes"));
}

TEST_CASE("features that this project's files never use are refused") {
  const auto read_strings = [](const Hdf5Reader& r) { r.strings("x", {-1}); };
  const auto variable_strings = [](hid_t file) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY);
    make_foreign_dataset(file, type, {2}, properties);
    H5Pclose(properties);
    H5Tclose(type);
  };
  CHECK(foreign_error(variable_strings, read_strings) ==
        ": error: dataset 'x' must hold strings of fixed length, theirs varies");

  const auto unsigned_integers = [](hid_t file) {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY);
    make_foreign_dataset(file, H5T_STD_U64LE, {2}, properties);
    H5Pclose(properties);
  };
  CHECK(foreign_error(unsigned_integers, [](const Hdf5Reader& r) { r.integers("x", {2}); }) ==
        ": error: dataset 'x' holds integers that do not fit into 64 bits with a sign");

  const auto external = [](hid_t file) {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(properties, "/etc/passwd", 0, 16);
    make_foreign_dataset(file, H5T_IEEE_F64LE, {2}, properties);
    H5Pclose(properties);
  };
  CHECK(foreign_error(external, [](const Hdf5Reader& r) { r.reals("x", {2}); }) ==
        ": error: dataset 'x' has its data in another file, which is not read");
}

TEST_CASE("a link into another file is refused, direct or by a group") {
  const TemporaryFolder folder;
  const std::string path = (folder / "f.h5").string(), other = (folder / "other.h5").string();
  for (const std::string& name : {path, other}) {
    Hdf5Writer writer(name);
    writer.write("x", std::vector{1.0, 2.0}, "m");
    writer.commit();
  }
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Lcreate_external(other.c_str(), "/x", file, "linked", H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_external(other.c_str(), "/", file, "group", H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_soft("/x", file, "inside", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  const auto error = [&](const std::string& dataset) {
    return error_message<InputError>([&] { Hdf5Reader(path).reals(dataset, {2}); }).substr(path.size());
  };
  CHECK(error("linked") == ": error: dataset 'linked' is in another file, which is not read");
  CHECK(error("group/x") == ": error: dataset 'group/x' is in another file, which is not read");
  CHECK(Hdf5Reader(path).reals("inside", {2}) == std::vector{1.0, 2.0});
}

TEST_CASE("a narrower number type of another program is read correctly") {
  const TemporaryFolder folder;
  const std::string path = (folder / "f.h5").string();
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t size = 2;
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t dataset = H5Dcreate2(file, "x", H5T_IEEE_F32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const std::array<float, 2> values{0.5F, -3.25F};
  REQUIRE(H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  H5Dclose(dataset);
  H5Sclose(space);
  H5Fclose(file);
  CHECK(Hdf5Reader(path).reals("x", {2}) == std::vector{0.5, -3.25});
}
