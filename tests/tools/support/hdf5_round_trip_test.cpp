#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/hdf5/hdf5_file.h"

using namespace sprung::support;

namespace {

// Numbers that are all different and not round: 0.1, 1.2, 2.3 …
std::vector<double> make_values(std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(0.1 + 1.1 * static_cast<double>(i));
  return values;
}

// The rows of a matrix one after the other.
std::vector<double> row_major(const RowMatrix& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

}  // namespace

TEST_CASE("arrays of doubles come back bit by bit, in shape and order") {
  const TemporaryFolder folder;
  Eigen::MatrixXd matrix(2, 3);
  matrix << 1.1, -2.2, 3.3, 4.4, 5.5, std::numeric_limits<double>::denorm_min();
  const Eigen::VectorXd vector = matrix.row(1);
  {
    Hdf5Writer writer(folder / "a.h5");
    writer.write("matrix", matrix, "m");
    writer.write("/deep/er/vector", vector, "kg");
    writer.write("span", std::span<const double>(matrix.data(), 6), "");
    writer.write("expression", 2.0 * matrix.transpose(), "N/m");
    writer.write("column", matrix.col(2), "N");
    writer.write("row", matrix.row(0), "N");
    writer.write("cube", make_values(24), {2, 3, 4}, "m");
    writer.commit();
  }
  const Hdf5Reader reader(folder / "a.h5");
  CHECK(reader.reals("/matrix", {2, 3}) == row_major(matrix));
  CHECK(reader.reals("matrix", {-1, -1}) == row_major(matrix));
  CHECK(reader.reals("/deep/er/vector", {3}) == row_major(vector));
  CHECK(reader.reals("span", {6})[1] == 4.4);  // columns first, as Eigen keeps them
  CHECK(reader.reals("expression", {3, 2}) == row_major(2.0 * matrix.transpose()));
  CHECK(reader.reals("column", {2}) == row_major(matrix.col(2)));
  CHECK(reader.reals("row", {3}) == row_major(matrix.row(0)));
  CHECK(reader.reals("cube", {2, 3, 4}) == make_values(24));
  CHECK(reader.shape("cube") == std::vector<std::int64_t>{2, 3, 4});
  CHECK(reader.reals("matrix", {2, 3})[1] == -2.2);
}

TEST_CASE("integers and strings come back") {
  const TemporaryFolder folder;
  const std::vector<std::int64_t> integers = {
      -1, 0, std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min(), 7, 8};
  const std::vector<std::string> strings = {"front", "", "Träger №1", std::string(70000, 'x')};
  {
    Hdf5Writer writer(folder / "a.h5");
    writer.write("line", integers);
    writer.write("table", integers, {3, 2});
    writer.write("names", strings);
    writer.write("blank", std::vector<std::string>{""});
    writer.commit();
  }
  const Hdf5Reader reader(folder / "a.h5");
  CHECK(reader.integers("line", {6}) == integers);
  CHECK(reader.integers("table", {3, 2}) == integers);
  CHECK(reader.strings("names", {-1}) == strings);
  CHECK(reader.strings("blank", {-1}) == std::vector<std::string>{""});
}

TEST_CASE("attributes come back, the last value of each") {
  const TemporaryFolder folder;
  {
    Hdf5Writer writer(folder / "a.h5");
    writer.make_group("bodies/chassis");
    writer.write("x", make_values(3), "m/s²");
    writer.attribute("/", "format", "sprung results");
    writer.attribute("/", "text", std::string(100000, 't'));
    writer.attribute("/", "complete", std::int64_t{0});
    writer.attribute("/", "complete", std::int64_t{1});
    writer.attribute("bodies/chassis", "mass", 11950.5);
    writer.attribute("x", "note", "");
    writer.commit();
  }
  const Hdf5Reader reader(folder / "a.h5");
  CHECK(reader.real_attribute("bodies/chassis", "mass") == 11950.5);
  CHECK(reader.string_attribute("/", "format") == "sprung results");
  CHECK(reader.string_attribute("/", "text") == std::string(100000, 't'));
  CHECK(reader.integer_attribute("/", "complete") == 1);
  CHECK(reader.string_attribute("x", "note").empty());
  CHECK(reader.string_attribute("x", "unit") == "m/s²");
  CHECK(reader.has_attribute("x", "unit"));
  CHECK_FALSE(reader.has_attribute("x", "units"));
  CHECK_FALSE(reader.has_attribute("y", "unit"));
}

TEST_CASE("a file lists its contents") {
  const TemporaryFolder folder;
  {
    Hdf5Writer writer(folder / "a.h5");
    writer.write("points/seat/position", make_values(2), "m");
    writer.write("points/arm/position", make_values(2), "m");
    writer.make_group("empty");
    writer.make_group("empty");
    writer.commit();
  }
  const Hdf5Reader reader(folder / "a.h5");
  CHECK(reader.has("empty"));
  CHECK(reader.has("/"));
  CHECK(reader.has("points"));
  CHECK(reader.has("/points/seat/position"));
  CHECK_FALSE(reader.has("points/seat/velocity"));
  CHECK_FALSE(reader.has("points/nobody/position"));
  CHECK_FALSE(reader.has("points/seat/position/x"));
}

TEST_CASE("empty arrays come back empty") {
  const TemporaryFolder folder;
  {
    Hdf5Writer writer(folder / "a.h5");
    writer.write("matrix", Eigen::MatrixXd(3, 0), "m");
    writer.write("vector", std::span<const double>(), "m");
    writer.write("integers", std::span<const std::int64_t>());
    writer.write("strings", std::span<const std::string>());
    writer.make_growing("growing", 2, "m");
    writer.commit();
  }
  const Hdf5Reader reader(folder / "a.h5");
  CHECK(reader.reals("matrix", {3, 0}).empty());
  CHECK(reader.reals("vector", {0}).empty());
  CHECK(reader.integers("integers", {0}).empty());
  CHECK(reader.strings("strings", {-1}).empty());
  CHECK(reader.reals("growing", {0, 2}).empty());
}

TEST_CASE("a dataset of several chunks comes back whole") {
  const TemporaryFolder folder;
  // 300 × 1000 doubles are 2.4 MB: three chunks, the last one cut by the edge.
  const Eigen::VectorXd column = Eigen::VectorXd::LinSpaced(300, 0.1, 7.3);
  const Eigen::RowVectorXd row = Eigen::RowVectorXd::LinSpaced(1000, -3.0, 2.9);
  const Eigen::MatrixXd matrix = column * row;
  {
    Hdf5Writer writer(folder / "a.h5");
    writer.write("matrix", matrix, "m");
    writer.commit();
  }
  CHECK(Hdf5Reader(folder / "a.h5").reals("matrix", {300, 1000}) == row_major(matrix));
}

TEST_CASE("a growing dataset holds all rows in the order in which they were added") {
  const TemporaryFolder folder;
  const std::size_t num_rows = GENERATE(1, 1023, 1024, 1025, 5001);
  const std::size_t rows_at_once = GENERATE(1, 7, 3000);
  const std::vector<double> values = make_values(3 * num_rows);
  {
    Hdf5Writer writer(folder / "a.h5");
    Hdf5GrowingDataset& time = writer.make_growing("time", 0, "s");
    Hdf5GrowingDataset& position = writer.make_growing("bodies/chassis/position", 3, "m");
    const std::span<const double> all(values);
    for (std::size_t row = 0; row < num_rows; row += rows_at_once) {
      const std::size_t count = std::min(rows_at_once, num_rows - row);
      writer.append(time, all.subspan(row, count));
      writer.append(position, all.subspan(3 * row, 3 * count));
      if (row % 700 == 0) writer.flush();
    }
    writer.commit();
  }
  const Hdf5Reader reader(folder / "a.h5");
  CHECK(reader.reals("bodies/chassis/position", {static_cast<std::int64_t>(num_rows), 3}) == values);
  CHECK(reader.reals("time", {static_cast<std::int64_t>(num_rows)}) ==
        std::vector<double>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(num_rows)));
  CHECK(reader.string_attribute("time", "unit") == "s");
}
