#include <fmt/format.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <random>
#include <stdexcept>
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

namespace {

const std::vector<double> kValues = {1.5, -2.5, 3.5};

void write_file(const std::filesystem::path& path) {
  Hdf5Writer writer(path);
  writer.attribute("/", "format", "test");
  writer.write("/a/values", kValues, "m");
  writer.write("/names", std::vector<std::string>{"x", "long"});
  Hdf5GrowingDataset& time = writer.make_growing("/time", 0, "s");
  for (int i = 0; i < 3000; ++i) writer.append(time, std::array{1e-3 * i});
  writer.attribute("/", "complete", std::int64_t{1});
  writer.commit();
}

}  // namespace

TEST_CASE("a link to a file that does not exist is refused, and stays") {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("elsewhere.h5", folder / "a.h5");
  CHECK(error_message<InputError>([&] { Hdf5Writer(folder / "a.h5"); }) ==
        (folder / "a.h5").string() +
            ": error: cannot be written: it is a link to 'elsewhere.h5', which does not exist");
  CHECK(std::filesystem::is_symlink(folder / "a.h5"));
  CHECK_FALSE(std::filesystem::exists(folder / "elsewhere.h5"));
}

TEST_CASE("equal calls give equal bytes") {
  const TemporaryFolder folder;
  write_file(folder / "a.h5");
  write_file(folder / "b.h5");
  const std::string first = read_bytes(folder / "a.h5");
  CHECK(first.size() > 3000 * sizeof(double));
  CHECK(first == read_bytes(folder / "b.h5"));
}

TEST_CASE("every dataset is chunked, has a checksum and no time stamp") {
  const TemporaryFolder folder;
  write_file(folder / "a.h5");
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  for (const char* name : {"/a/values", "/names", "/time"}) {
    INFO(name);
    const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
    const hid_t properties = H5Dget_create_plist(dataset);
    CHECK(H5Pget_layout(properties) == H5D_CHUNKED);
    unsigned int flags = 0;
    CHECK(H5Pget_filter_by_id2(properties, H5Z_FILTER_FLETCHER32, &flags, nullptr, nullptr, 0, nullptr,
                               nullptr) >= 0);
    H5Pclose(properties);
    H5Dclose(dataset);
  }
  for (const char* name : {"/", "/a", "/a/values", "/names", "/time"}) {
    INFO(name);
#if H5_VERSION_GE(1, 12, 0)
    H5O_info1_t info{};
#else
    H5O_info_t info{};
#endif
    CHECK(H5Oget_info_by_name2(file, name, &info, H5O_INFO_TIME, H5P_DEFAULT) >= 0);
    CHECK(info.ctime == 0);
    CHECK(info.mtime == 0);
  }
  H5Fclose(file);
}

TEST_CASE("the target appears when the file is complete, and not before") {
  const TemporaryFolder folder;
  Hdf5Writer writer(folder / "a.h5");
  CHECK(writer.temporary() == folder / "a.h5.tmp");
  writer.write("x", kValues, "m");
  writer.flush();
  CHECK_FALSE(std::filesystem::exists(folder / "a.h5"));
  writer.commit();
  CHECK(std::filesystem::exists(folder / "a.h5"));
  CHECK_FALSE(std::filesystem::exists(folder / "a.h5.tmp"));
}

TEST_CASE("a file that is not committed leaves nothing behind, and the old file as it was") {
  const TemporaryFolder folder;
  write_file(folder / "a.h5");
  const std::string before = read_bytes(folder / "a.h5");
  {
    Hdf5Writer writer(folder / "a.h5");
    writer.write("x", kValues, "m");
    writer.append(writer.make_growing("t", 0, "s"), kValues);
  }
  CHECK(read_bytes(folder / "a.h5") == before);
  CHECK_FALSE(std::filesystem::exists(folder / "a.h5.tmp"));
}

TEST_CASE("a partial file that is kept can be read") {
  const TemporaryFolder folder;
  {
    Hdf5Writer writer(folder / "run.h5", folder / "run.partial.h5");
    writer.append(writer.make_growing("t", 0, "s"), kValues);
    writer.keep_partial();
  }
  CHECK_FALSE(std::filesystem::exists(folder / "run.h5"));
  CHECK(Hdf5Reader(folder / "run.partial.h5").reals("t", {3})[2] == 3.5);
}

TEST_CASE("what was written up to a checkpoint can be read after the program was killed") {
  const TemporaryFolder folder;
  const ChildResult result = run_in_child([&] {
    Hdf5Writer writer(folder / "run.h5", folder / "run.partial.h5");
    writer.attribute("/", "format", "test");
    Hdf5GrowingDataset& pairs = writer.make_growing("a/pairs", 2, "m");
    std::vector<Hdf5GrowingDataset*> times;
    for (int i = 0; i < 30; ++i) times.push_back(&writer.make_growing(fmt::format("t{}", i), 0, "s"));
    for (int row = 0; row < 5000; ++row) {
      writer.append(pairs, std::vector{1.0 * row, 0.5});
      for (Hdf5GrowingDataset* t : times) writer.append(*t, std::vector{2.0 * row});
      if (row == 3000 || row == 3001) writer.checkpoint();
    }
    return ::raise(SIGKILL);
  });
  CHECK(result.signal == SIGKILL);
  CHECK_FALSE(std::filesystem::exists(folder / "run.h5.tmp"));
  const Hdf5Reader reader(folder / "run.partial.h5");
  CHECK(reader.reals("a/pairs", {3002, 2})[6002] == 3001.0);
  for (int i = 0; i < 30; ++i) CHECK(reader.reals(fmt::format("t{}", i), {3002})[3001] == 6002.0);
}

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
      if (row % 700 == 0) writer.checkpoint();
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
      if (row % 1500 == 1499) writer.checkpoint();
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
      if (i == 1500) writer.checkpoint();
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

TEST_CASE("a dataset of doubles can be written anew, with as many values") {
  const TemporaryFolder folder;
  Hdf5Writer writer(folder / "a.h5");
  writer.write("x", kValues, "m");
  writer.overwrite("x", std::array{7.0, 8.0, 9.0});
  CHECK(error_message<std::invalid_argument>([&] { writer.overwrite("x", std::array{1.0}); }) ==
        "Hdf5Writer::overwrite: 'x' has 3 values, got 1");
  writer.commit();
  CHECK(Hdf5Reader(folder / "a.h5").reals("x", {3}) == std::vector{7.0, 8.0, 9.0});
}

TEST_CASE("the bytes of a checkpoint are those of the last one, whenever the program is killed") {
  const TemporaryFolder folder;
  const int kill_at = GENERATE(3000, 3700);  // right behind a checkpoint, and after more rows
  const ChildResult result = run_in_child([&] {
    Hdf5Writer writer(folder / "run.h5", folder / "run.partial.h5");
    Hdf5GrowingDataset& t = writer.make_growing("t", 0, "s");
    for (int row = 1; row <= kill_at; ++row) {
      writer.append(t, std::vector{1.0 * row});
      const std::vector<std::uint8_t> bytes(static_cast<std::size_t>(row),
                                            static_cast<std::uint8_t>(row / 500));
      if (row % 500 == 0) writer.checkpoint("state/bytes", bytes);
    }
    return ::raise(SIGKILL);
  });
  CHECK(result.signal == SIGKILL);
  const Hdf5Reader reader(folder / "run.partial.h5");
  const std::int64_t rows = kill_at - kill_at % 500;
  CHECK(reader.reals("t", {rows}).back() == static_cast<double>(rows));
  const std::vector<std::int64_t> expected(static_cast<std::size_t>(rows), rows / 500);
  CHECK(reader.integers("state/bytes", {-1}) == expected);
  CHECK_FALSE(reader.has("state/bytes.next"));
}

TEST_CASE("what was removed is not in the file, and can be written again") {
  const TemporaryFolder folder;
  {
    Hdf5Writer writer(folder / "a.h5");
    writer.write("group/x", kValues, "m");
    writer.write("group/y", kValues, "m");
    writer.remove("group");
    writer.write("/group/y", std::span(kValues).first(1), "m");
    CHECK_THROWS_AS(writer.remove("nothing"), InputError);
    writer.commit();
  }
  const Hdf5Reader reader(folder / "a.h5");
  CHECK_FALSE(reader.has("group/x"));
  CHECK(reader.shape("group/y") == std::vector<std::int64_t>{1});
}

TEST_CASE("texts grow row by row, and what is too long is cut between two characters") {
  const TemporaryFolder folder;
  {
    Hdf5Writer writer(folder / "a.h5");
    Hdf5GrowingDataset& texts = writer.make_growing_texts("texts", 7);
    for (int row = 0; row < 200; ++row) writer.append_text(texts, fmt::format("{}", row));
    writer.append_text(texts, "");
    writer.append_text(texts, "1234567é9");  // the space is of 8 bytes, é takes two
    writer.append_text(texts, "123456é9");
    writer.commit();
  }
  const std::vector<std::string> texts = Hdf5Reader(folder / "a.h5").strings("texts", {203});
  for (std::size_t row = 0; row < 200; ++row) CHECK(texts[row] == fmt::format("{}", row));
  CHECK(texts[200].empty());
  CHECK(texts[201] == "1234567");
  CHECK(texts[202] == "123456é");
}

TEST_CASE("rows are read from anywhere in a dataset, and no more than there are") {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.h5").string();
  {
    Hdf5Writer writer(path);
    Hdf5GrowingDataset& pairs = writer.make_growing("pairs", 2, "m");
    for (int row = 0; row < 3000; ++row) writer.append(pairs, std::vector{1.0 * row, -1.0 * row});
    writer.commit();
  }
  const Hdf5Reader reader(path);
  CHECK(reader.real_rows("pairs", 1023, 2) == std::vector{1023.0, -1023.0, 1024.0, -1024.0});
  CHECK(reader.real_rows("pairs", 2999, 1) == std::vector{2999.0, -2999.0});
  CHECK(reader.real_rows("pairs", 3000, 0).empty());
  CHECK(error_message<InputError>([&] { reader.real_rows("pairs", 2999, 2); }) ==
        path + ": error: dataset 'pairs' must have at least 3001 rows, has 3000");
}

TEST_CASE("a checkpoint does not change the bytes of the file that is whole in the end") {
  const TemporaryFolder folder;
  for (const int every : {100000, 700}) {
    Hdf5Writer writer(folder / fmt::format("{}.h5", every), folder / "partial.h5");
    Hdf5GrowingDataset& t = writer.make_growing("t", 0, "s");
    for (int row = 1; row < 5000; ++row) {
      writer.append(t, std::vector{1.0 * row});
      if (row % every == 0) writer.checkpoint();
    }
    writer.commit();
  }
  CHECK(Hdf5Reader(folder / "700.h5").reals("t", {4999}) ==
        Hdf5Reader(folder / "100000.h5").reals("t", {4999}));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 2);
}

TEST_CASE("a file that is whole takes away what an earlier program left of it") {
  const TemporaryFolder folder;
  write_bytes(folder / "run.partial.h5", "an older partial file");
  Hdf5Writer writer(folder / "run.h5", folder / "run.partial.h5");
  writer.write("x", kValues, "m");
  CHECK(read_bytes(folder / "run.partial.h5") == "an older partial file");
  writer.commit();
  CHECK_FALSE(std::filesystem::exists(folder / "run.partial.h5"));
}

TEST_CASE("a file left over from a crash is overwritten") {
  const TemporaryFolder folder;
  write_bytes(folder / "a.h5.tmp", "half a file");
  write_file(folder / "a.h5");
  CHECK(Hdf5Reader(folder / "a.h5").reals("/a/values", {3})[0] == 1.5);
}

TEST_CASE("two writers cannot write the same file") {
  const TemporaryFolder folder;
  const std::string target = (folder / "a.h5").string();
  Hdf5Writer first(target);
  first.write("x", kValues, "m");
  first.flush();
  CHECK(error_message<InputError>([&] { Hdf5Writer second(target); }) ==
        target + ": error: cannot be written: another writer is at '" + target + ".tmp'");
  first.commit();
  CHECK(Hdf5Reader(target).reals("x", {3})[0] == 1.5);
}

TEST_CASE("a target that cannot be written is refused before anything is written") {
  const TemporaryFolder folder;
  const std::string place = folder.path().string();
  const auto error = [&](const std::string& name) {
    return error_message<InputError>([&] { Hdf5Writer writer(place + name); });
  };
  CHECK(error("/none/deep/a.h5") ==
        place + "/none/deep/a.h5: error: cannot be written: there is no folder '" + place + "/none'");
  CHECK(error("/") == place + "/: error: cannot be written: it names no file");
  CHECK(folder.is_empty());
  std::filesystem::create_directory(folder / "sub");
  CHECK(error("/sub") == place + "/sub: error: cannot be written: it is a folder");
  write_bytes(folder / "file", "text");
  CHECK(error("/file/a.h5") ==
        place + "/file/a.h5: error: cannot be written: '" + place + "/file' is not a folder");
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK(error("/pipe") == place + "/pipe: error: cannot be written: it is not a regular file");
  std::filesystem::create_directory(folder / "a.h5.tmp");
  CHECK(error("/a.h5") == place + "/a.h5: error: cannot be written: '" + place + "/a.h5.tmp' is in the way");
  CHECK(error_message<InputError>([] { Hdf5Writer writer("/dev/null"); }) ==
        "/dev/null: error: cannot be written: it is not a regular file");
}

TEST_CASE("a target that has become a folder leaves no temporary file") {
  const TemporaryFolder folder;
  {
    Hdf5Writer writer(folder / "a.h5");
    std::filesystem::create_directory(folder / "a.h5");
    CHECK(error_message<InputError>([&] { writer.commit(); }) ==
          (folder / "a.h5").string() + ": error: cannot be written: Is a directory");
  }
  CHECK_FALSE(std::filesystem::exists(folder / "a.h5.tmp"));
}

TEST_CASE("a caller's mistake is distinguished from a bad file") {
  const TemporaryFolder folder;
  Hdf5Writer writer(folder / "a.h5");
  writer.write("x", kValues, "m");
  Hdf5GrowingDataset& growing = writer.make_growing("t", 2, "s");
  const auto error = [](const auto& call) { return error_message<std::invalid_argument>(call); };
  CHECK(error([&] { writer.write("/x", kValues, "m"); }) == "Hdf5Writer: dataset '/x' is there already");
  CHECK(error([&] {
          writer.write("y", kValues, {1, 2, 2}, "m");
        }) == "Hdf5Writer::write: 'y' has 3 values, its shape asks for 4");
  CHECK(error([&] { writer.append(growing, kValues); }) ==
        "Hdf5Writer::append: 3 values are not whole rows of 't' (2 columns)");
  CHECK(error([&] { writer.attribute("z", "a", 1.0); }) == "Hdf5Writer::attribute: there is no 'z'");
  CHECK(error([&] { writer.write("s", std::vector{std::string(1, '\0')}); }) ==
        "Hdf5Writer: a string of 's' contains NUL");
  CHECK(error([&] { writer.attribute("/", "s", std::string(1, '\0')); }) ==
        "Hdf5Writer: a string of 's' contains NUL");
  CHECK(error([&] { Hdf5Writer other(folder / "b.h5", "/tmp/b.tmp"); }) ==
        "Hdf5Writer: partial file '/tmp/b.tmp' is not in the folder of '" + (folder / "b.h5").string() + "'");
  writer.commit();  // none of them has spoilt the file
  CHECK(Hdf5Reader(folder / "a.h5").has("t"));
  CHECK(Hdf5Reader(folder / "a.h5").has("x"));
}
