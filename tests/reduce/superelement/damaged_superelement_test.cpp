// Superelement files that are damaged, incomplete or of another format.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "reduce/superelement/superelement_fields.h"
#include "tests/catch.h"
#include "tests/reduce/superelement/hdf5_tampering.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

using support::InputError;
using testing::make_two_armed_body;
using testing::message_of;
using testing::read_bytes;

// The message of reading a whole file after it was tampered with.
std::string read_tampered(const std::function<void(testing::Hdf5Tampering&)>& change) {
  write_superelement(make_two_armed_body(), "tampered.h5");
  {
    testing::Hdf5Tampering file("tampered.h5");
    change(file);
  }
  return message_of<InputError>([] { read_superelement("tampered.h5"); });
}

TEST_CASE("a dataset that is missing, of another shape or type is named") {
  const std::string prefix = "tampered.h5: error: dataset '";
  for (const SuperelementField& field : superelement_fields()) {
    const std::string name(field.path);
    CAPTURE(name);
    CHECK_THAT(read_tampered([&](auto& file) { file.remove(name); }), Contains(prefix + name + "'"));
    // Five by one reals fit nowhere, whatever the type and shape that belong here.
    CHECK_THAT(read_tampered([&](auto& file) {
                 file.replace(name, {5, 1}, std::vector<double>(5, 1.0));
               }),
               Contains(prefix));
  }
  CHECK_THAT(read_tampered([](auto& file) {
               file.replace("/matrices/mass", {7, 6}, std::vector<double>(42, 1.0));
             }),
             Contains(prefix + "/matrices/mass'"));
}

TEST_CASE("a dataset whose unit is not that of the specification is named with both units") {
  for (const SuperelementField& field : superelement_fields()) {
    const std::string name(field.path);
    CAPTURE(name);
    CHECK_THAT(read_tampered([&](auto& file) { file.set_unit(name, "mm"); }),
               Contains("tampered.h5: error: dataset '" + name + "' has the unit 'mm', expected '" +
                        std::string(field.unit) + "'"));
  }
}

TEST_CASE("a dataset of a version after that of the file is named with both versions") {
  const std::string old = testing::source_path("tests/reduce/data/version_1.h5");
  std::filesystem::copy_file(old, "stiffened.h5", std::filesystem::copy_options::overwrite_existing);
  testing::Hdf5Tampering("stiffened.h5").add("/stiffening/acceleration", {1}, {0.0});
  CHECK(
      message_of<InputError>([] { read_superelement("stiffened.h5"); }) ==
      "stiffened.h5: error: dataset '/stiffening/acceleration' belongs to version 2 of the format, the file "
      "is of version 1");
}

TEST_CASE("contents that the specification does not name are ignored") {
  const std::string hash = write_superelement(make_two_armed_body(), "more.h5");
  testing::Hdf5Tampering("more.h5").add("/modes/phase", {2}, {0.0, 1.0});
  testing::Hdf5Tampering("more.h5").set_unit("/modes/phase", "rad");
  CHECK(read_superelement("more.h5").content_hash == hash);
}

TEST_CASE("impossible values are named with their dataset") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto fault = [](const std::string& name, std::size_t index, double value) {
    return read_tampered([&](auto& file) { file.set(name, index, value); });
  };
  CHECK_THAT(fault("/inertia/mass", 0, -3.0), Contains("dataset '/inertia/mass' is -3 kg, expected > 0"));
  CHECK_THAT(fault("/inertia/second_moment", 0, 0.0),
             Contains("dataset '/inertia/second_moment' is 0 kg·m²"));
  CHECK_THAT(fault("/inertia/P", 3, nan), Contains("dataset '/inertia/P'"));
  CHECK_THAT(fault("/modes/shape", 20, nan), Contains("dataset '/modes/shape'"));
  CHECK_THAT(fault("/nodes/position", 2, std::numeric_limits<double>::infinity()),
             Contains("dataset '/nodes/position'"));
  CHECK_THAT(fault("/modes/frequency", 1, -5.0), Contains("dataset '/modes/frequency' is -5 Hz for mode 2"));
  CHECK_THAT(fault("/matrices/stiffness", 1, 1e6),
             Contains("dataset '/matrices/stiffness' is not symmetric"));
  CHECK_THAT(fault("/matrices/mass", 0, -1.0),
             Contains("dataset '/matrices/mass' has the diagonal entry -1 for mode 1"));
  CHECK_THAT(fault("/inertia/B", 1, 1.0), Contains("dataset '/inertia/B' is not skew"));
}

TEST_CASE("a value changed within its range is detected by the hash") {
  CHECK_THAT(read_tampered([](auto& file) { file.set("/inertia/P", 3, 0.25); }),
             Contains("attribute 'content_hash' is") && Contains("was changed after it was written"));
}

TEST_CASE("a file of a newer version is refused with advice") {
  const std::string message =
      read_tampered([](auto& file) { file.set_attribute("version", kSuperelementVersion + 1); });
  CHECK_THAT(message, Contains(fmt::format("tampered.h5: error: superelement format version {}, this program "
                                           "reads up to version {}",
                                           kSuperelementVersion + 1, kSuperelementVersion)));
  CHECK_THAT(message,
             Contains("use a newer sprung, or make the file again from its design with sprung-reduce build"));
  CHECK_THAT(read_tampered([](auto& file) { file.set_attribute("version", 0); }),
             Contains("version 0, expected ≥ 1"));
  CHECK_THAT(read_tampered([](auto& file) { file.remove_attribute("version"); }), Contains("version"));
}

TEST_CASE("files that are no superelement are refused with what they are") {
  CHECK_THAT(read_tampered([](auto& file) { file.remove_attribute("format"); }),
             Contains("not a superelement"));
  CHECK_THAT(message_of<InputError>([] { read_superelement("absent.h5"); }), Contains("absent.h5: error:"));
  std::ofstream("empty.h5").flush();
  CHECK_THAT(message_of<InputError>([] { read_superelement("empty.h5"); }),
             Contains("empty.h5: error:") && Contains("empty"));
  std::ofstream("text.h5") << "mass = 5, this is no HDF5 file, and never was one\n";
  CHECK_THAT(message_of<InputError>([] { read_superelement("text.h5"); }),
             Contains("text.h5: error:") && Contains("HDF5"));
}

TEST_CASE("a file cut off anywhere or with a damaged byte is refused") {
  write_superelement(make_two_armed_body(), "whole.h5");
  const std::string bytes = read_bytes("whole.h5");
  constexpr std::size_t kCuts = 200;
  for (std::size_t cut = 1; cut <= kCuts; ++cut) {
    const std::size_t rest = cut < kCuts ? bytes.size() * cut / kCuts : bytes.size() - 1;
    INFO("the first " << rest << " bytes of " << bytes.size());
    std::ofstream("cut.h5", std::ios::binary) << bytes.substr(0, rest);
    CHECK_THAT(message_of<InputError>([] { read_superelement("cut.h5"); }), Contains("cut.h5: error:"));
  }
  // A byte in the middle of the shapes' values: their checksum names the dataset.
  const Superelement body = read_superelement("whole.h5");
  const double value = body.shapes(4, 2);
  const std::string pattern(reinterpret_cast<const char*>(&value), sizeof value);
  const std::size_t at = bytes.find(pattern);
  REQUIRE(at != std::string::npos);
  std::string damaged = bytes;
  damaged[at + 2] = static_cast<char>(damaged[at + 2] ^ 0x10);
  std::ofstream("damaged.h5", std::ios::binary) << damaged;
  CHECK_THAT(message_of<InputError>([] { read_superelement("damaged.h5"); }),
             Contains("damaged.h5: error: dataset '/modes/shape'"));
}

}  // namespace
}  // namespace sprung::reduce
