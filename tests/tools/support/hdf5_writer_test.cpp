#include <fmt/format.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
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

TEST_CASE("what was flushed and copied can be read after the program was killed") {
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
      if (row == 3000 || row == 3001) {
        writer.flush();
        CHECK(writer.copy_to_partial().empty());
      }
    }
    return ::raise(SIGKILL);
  });
  CHECK(result.signal == SIGKILL);
  const Hdf5Reader reader(folder / "run.partial.h5");
  CHECK(reader.reals("a/pairs", {3002, 2})[6002] == 3001.0);
  for (int i = 0; i < 30; ++i) CHECK(reader.reals(fmt::format("t{}", i), {3002})[3001] == 6002.0);
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

TEST_CASE("bytes that were overwritten are those of the last copy, whenever the program is killed") {
  const TemporaryFolder folder;
  const int kill_at = GENERATE(3000, 3700);  // right behind a checkpoint, and after more rows
  const ChildResult result = run_in_child([&] {
    Hdf5Writer writer(folder / "run.h5", folder / "run.partial.h5");
    Hdf5GrowingDataset& t = writer.make_growing("t", 0, "s");
    for (int row = 1; row <= kill_at; ++row) {
      writer.append(t, std::vector{1.0 * row});
      const std::vector<std::uint8_t> bytes(static_cast<std::size_t>(row),
                                            static_cast<std::uint8_t>(row / 500));
      if (row % 500 != 0) continue;
      writer.overwrite("state/bytes", bytes);
      writer.flush();
      writer.copy_to_partial();
    }
    return ::raise(SIGKILL);
  });
  CHECK(result.signal == SIGKILL);
  const Hdf5Reader reader(folder / "run.partial.h5");
  const std::int64_t rows = kill_at - kill_at % 500;
  CHECK(reader.reals("t", {rows}).back() == static_cast<double>(rows));
  const std::vector<std::int64_t> expected(static_cast<std::size_t>(rows), rows / 500);
  CHECK(reader.integers("state/bytes", {-1}) == expected);
  CHECK_FALSE(reader.has(".removed 0"));
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
      if (row % every == 0) {
        writer.flush();
        writer.copy_to_partial();
      }
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
