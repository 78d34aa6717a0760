// Histories that are compressed: in single precision, and rounded.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "tests/catch.h"
#include "tests/tools/support/child_process.h"
#include "tests/tools/support/error_message.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_file.h"

using namespace sprung::support;

TEST_CASE("compressed histories of a killed program can be read up to its last checkpoint") {
  // Chunks of 1024 rows are written in part at each checkpoint, and compressed when they are full.
  const TemporaryFolder folder;
  const int kill_at = GENERATE(700, 1400, 2100, 3600);  // right behind a checkpoint, or after more rows
  const ChildResult result = run_in_child([&] {
    Hdf5Writer writer(folder / "run.h5", folder / "run.partial.h5");
    std::vector<Hdf5GrowingDataset*> series;
    for (int i = 0; i < 30; ++i) {
      series.push_back(&writer.make_growing(fmt::format("t{}", i), 0, "s", Hdf5Precision::kCompressedSingle));
    }
    for (int row = 1; row <= kill_at; ++row) {
      for (Hdf5GrowingDataset* t : series) writer.append(*t, std::vector{0.5 * row});
      if (row % 700 == 0) {
        writer.flush();
        writer.copy_to_partial();
      }
    }
    return ::raise(SIGKILL);
  });
  CHECK(result.signal == SIGKILL);
  const Hdf5Reader reader(folder / "run.partial.h5", Hdf5Reader::Compression::kAllowed);
  const std::int64_t rows = kill_at - kill_at % 700;
  for (int i = 0; i < 30; ++i) {
    const std::vector<double> values = reader.reals(fmt::format("t{}", i), {rows});
    CHECK(values[0] == 0.5);
    CHECK(values.back() == 0.5 * static_cast<double>(rows));
    CHECK(values[static_cast<std::size_t>(rows / 2)] == 0.5 * static_cast<double>(rows / 2 + 1));
  }
}

TEST_CASE("compressed histories are those that were written, to single precision, in less space") {
  const TemporaryFolder folder;
  const auto value = [](int row, int column) { return std::sin(1e-3 * row) * std::pow(10.0, column); };
  for (const Hdf5Precision precision : {Hdf5Precision::kDouble, Hdf5Precision::kCompressedSingle}) {
    const bool is_single = precision == Hdf5Precision::kCompressedSingle;
    Hdf5Writer writer(folder / (is_single ? "single.h5" : "double.h5"), folder / "partial.h5");
    Hdf5GrowingDataset& rows = writer.make_growing("rows", 3, "m", precision);
    for (int row = 0; row < 5000; ++row) {
      writer.append(rows, std::vector{value(row, 0), value(row, 1), value(row, 2)});
      if (row % 1500 == 1499) {
        writer.flush();
        writer.copy_to_partial();
      }
    }
    writer.commit();
  }
  const Hdf5Reader single(folder / "single.h5", Hdf5Reader::Compression::kAllowed);
  const std::vector<double> found = single.reals("rows", {5000, 3});
  const std::vector<double> exact = Hdf5Reader(folder / "double.h5").reals("rows", {5000, 3});
  double largest = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
    largest = std::max(largest, std::abs(found[i] - exact[i]) / std::max(std::abs(exact[i]), 1e-30));
  CHECK(largest <= 6e-8);  // half a unit in the last place of 24 bits
  CHECK(largest > 1e-9);
  CHECK(100 * read_bytes(folder / "single.h5").size() < 45 * read_bytes(folder / "double.h5").size());
  const std::string path = folder / "single.h5";
  CHECK(error_message<InputError>([&] {
          Hdf5Reader(path).reals("rows", {5000, 3});
        }) == path + ": error: dataset 'rows' is compressed or coded by a filter, which is not read");
}

// Their trailing bytes are stored as they are: those of 80 columns in more than one block of deflate.
TEST_CASE(
    "compressed histories of random numbers come back to the bit, and take no more than their "
    "bytes") {
  const TemporaryFolder folder;
  const int columns = GENERATE(1, 80);
  constexpr int kRows = 1500;  // the last chunk is not full
  std::mt19937 random(3);
  std::vector<double> written;
  Hdf5Writer writer(folder / "noise.h5");
  Hdf5GrowingDataset& noise =
      writer.make_growing("noise", static_cast<std::size_t>(columns), "m", Hdf5Precision::kCompressedSingle);
  for (int row = 0; row < kRows; ++row) {
    std::vector<double> values;
    for (int column = 0; column < columns; ++column)
      values.push_back(static_cast<float>(std::ldexp(static_cast<double>(random()) - 2147483648.0, -31)));
    writer.append(noise, values);
    written.insert(written.end(), values.begin(), values.end());
  }
  writer.commit();
  const Hdf5Reader reader(folder / "noise.h5", Hdf5Reader::Compression::kAllowed);
  CHECK(reader.reals("noise", {kRows, columns}) == written);
  const std::size_t in_whole_chunks = 2048 * sizeof(float) * static_cast<std::size_t>(columns);
  CHECK(read_bytes(folder / "noise.h5").size() < in_whole_chunks + 8192);
}

TEST_CASE("rounded histories have 17 binary digits, the last one rounded, and take less space again") {
  const TemporaryFolder folder;
  const auto value = [](int i) { return (i % 2 == 0 ? 1.0 : -1.0) * (1.0 + 1e-3 * std::sin(0.7 * i * i)); };
  for (const Hdf5Precision precision :
       {Hdf5Precision::kCompressedSingle, Hdf5Precision::kCompressedRounded}) {
    const bool is_rounded = precision == Hdf5Precision::kCompressedRounded;
    Hdf5Writer writer(folder / (is_rounded ? "rounded.h5" : "single.h5"), folder / "partial.h5");
    Hdf5GrowingDataset& x = writer.make_growing("x", 0, "N", precision);
    for (int i = 0; i < 5000; ++i) {
      writer.append(x, std::vector{value(i)});
      if (i == 1500) {
        writer.flush();
        writer.copy_to_partial();
      }
    }
    for (const double exact : {0.0, 65537.0, 131071.0, 1e-40}) writer.append(x, std::vector{exact});
    writer.commit();
  }
  const Hdf5Reader file(folder / "rounded.h5", Hdf5Reader::Compression::kAllowed);
  const std::vector<double> found = file.reals("x", {5004});
  double largest = 0.0, mean = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const double error = (found[static_cast<std::size_t>(i)] - value(i)) / value(i);
    largest = std::max(largest, std::abs(error));
    mean += error / 5000;
  }
  CHECK(largest <= std::ldexp(1.0, -17) + 6e-8);
  CHECK(largest > std::ldexp(1.0, -18));
  CHECK(std::abs(mean) < 0.05 * largest);  // rounded, not cut off
  CHECK(found[5000] == 0.0);
  CHECK(found[5001] == 65537.0);  // 17 digits
  CHECK(found[5002] == 131071.0);
  CHECK(std::abs(found[5003] - 1e-40) < 1e-43);
  CHECK(100 * read_bytes(folder / "rounded.h5").size() < 80 * read_bytes(folder / "single.h5").size());
}

TEST_CASE("a value beyond single precision is refused, not stored as infinity") {
  for (const auto& [precision, value, words] :
       {std::tuple(Hdf5Precision::kCompressedSingle, 1e39, "1e+39"),
        std::tuple(Hdf5Precision::kCompressedRounded, 3.40282e38, "3.4e+38")}) {
    const TemporaryFolder folder;
    Hdf5Writer writer(folder / "a.h5");
    Hdf5GrowingDataset& x = writer.make_growing("x", 0, "m", precision);
    writer.append(x, std::vector{value});
    const std::string path = folder / "a.h5";
    CHECK(error_message<InputError>([&] { writer.commit(); }) ==
          path + ": error: dataset 'x' cannot hold " + words + ": single precision ends at 3.4e+38");
  }
}
