#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/tools/support/error_message.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_file.h"

using namespace sprung::support;

namespace {

constexpr double kMarker = 1234.56789;

// A small file of each kind of dataset; its marker can be found in the bytes.
std::string make_file(const TemporaryFolder& folder) {
  Hdf5Writer writer(folder / "a.h5");
  writer.attribute("/", "format", "test");
  writer.write("modes/shape", std::vector{1.0, kMarker, 3.0}, "m");
  writer.write("ids", std::vector<std::int64_t>{7, 8, 9});
  writer.write("names", std::vector<std::string>{"first", "second"});
  writer.append(writer.make_growing("time", 2, "s"), std::array{0.1, 0.2});
  writer.commit();
  return read_bytes(folder / "a.h5");
}

struct Content {
  std::vector<double> shape, time;
  std::vector<std::int64_t> ids;
  std::vector<std::string> names;
  std::string format, unit;
  bool operator==(const Content&) const = default;
};

Content read_all(const std::filesystem::path& path) {
  const Hdf5Reader reader(path);
  return {.shape = reader.reals("modes/shape", {3}),
          .time = reader.reals("time", {1, 2}),
          .ids = reader.integers("ids", {3}),
          .names = reader.strings("names", {-1}),
          .format = reader.string_attribute("/", "format"),
          .unit = reader.string_attribute("modes/shape", "unit")};
}

}  // namespace

TEST_CASE("a file that is no HDF5 file is refused with what it is") {
  const TemporaryFolder folder;
  const std::string place = folder.path().string();
  const auto error = [&](const std::string& name) {
    return error_message<InputError>([&] { Hdf5Reader reader(place + name); });
  };
  CHECK(error("/none.h5") == place + "/none.h5: error: there is no such file");
  CHECK(error("") == place + ": error: is a folder, not a file");
  write_bytes(folder / "empty.h5", "");
  CHECK(error("/empty.h5") == place + "/empty.h5: error: is empty");
  write_bytes(folder / "text.h5", "mass = 3\n");
  CHECK(error("/text.h5") == place + "/text.h5: error: is not an HDF5 file");
}

TEST_CASE("a truncated file is refused") {
  const TemporaryFolder folder;
  const std::string bytes = make_file(folder);
  for (const std::size_t size : {bytes.size() - 1, bytes.size() / 2, std::size_t{100}}) {
    INFO(size);
    write_bytes(folder / "b.h5", bytes.substr(0, size));
    CHECK(error_message<InputError>([&] { Hdf5Reader reader(folder / "b.h5"); }) ==
          (folder / "b.h5").string() + ": error: cannot be read: the file is truncated");
  }
  write_bytes(folder / "b.h5", bytes.substr(0, 7));
  CHECK(error_message<InputError>([&] { Hdf5Reader reader(folder / "b.h5"); }) ==
        (folder / "b.h5").string() + ": error: is not an HDF5 file");
}

TEST_CASE("a file that its program never closed is refused") {
  const TemporaryFolder folder;
  Hdf5Writer writer(folder / "a.h5");
  writer.write("x", std::vector{1.0, 2.0}, "m");
  writer.flush();
  std::filesystem::copy_file(writer.temporary(), folder / "crashed.h5");  // as a power cut would leave it
  CHECK(error_message<InputError>([&] { Hdf5Reader reader(folder / "crashed.h5"); }) ==
        (folder / "crashed.h5").string() +
            ": error: cannot be read: the file was not closed by the program that wrote it");
}

TEST_CASE("a damaged value is refused with the dataset's name") {
  const TemporaryFolder folder;
  std::string bytes = make_file(folder);
  std::array<char, sizeof kMarker> marker{};
  std::memcpy(marker.data(), &kMarker, sizeof kMarker);
  const std::size_t position = bytes.find(std::string(marker.data(), marker.size()));
  REQUIRE(position != std::string::npos);
  bytes[position + 3] = static_cast<char>(bytes[position + 3] ^ 0x10);
  write_bytes(folder / "b.h5", bytes);
  CHECK(error_message<InputError>([&] { read_all(folder / "b.h5"); }) ==
        (folder / "b.h5").string() +
            ": error: dataset 'modes/shape' cannot be read: its checksum does not fit, the data is damaged");
}

TEST_CASE("no damaged byte changes what is read: the file is refused, or the values are the same") {
  const TemporaryFolder folder;
  const std::string bytes = make_file(folder);
  const Content expected = read_all(folder / "a.h5");
  REQUIRE(expected.time == std::vector{0.1, 0.2});
  REQUIRE(expected.names.back() == "second");
  std::size_t num_refused = 0;
  std::size_t num_changed = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    write_bytes(folder / "b.h5", damaged);
    try {
      if (!(read_all(folder / "b.h5") == expected)) ++num_changed;
    } catch (const InputError&) {
      ++num_refused;
    }
  }
  CHECK(num_changed == 0);
  // Bytes that may change lie in free space between the structures, of which there is little.
  INFO(num_refused << " of " << bytes.size());
  CHECK(num_refused > bytes.size() * 9 / 10);
}
