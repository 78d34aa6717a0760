#include "dynamics/measured/rpc3_file.h"

#include <algorithm>
#include <limits>

#include "tests/catch.h"
#include "tests/dynamics/measured/rpc3_writer.h"
#include "tools/support/errors/input_error.h"

using namespace sprung;
using dynamics::Rpc3File;
using test::Rpc3History;

namespace {

// Two channels of 12 samples: the last of the two groups is half full.
Rpc3History two_channels() {
  Rpc3History history{.scales = {0.5, 2.0}, .samples = {{}, {}}};
  for (int k = 0; k < 12; ++k) {
    history.samples[0].push_back(k - 5);
    history.samples[1].push_back(1000 * k - 7000);
  }
  return history;
}

Rpc3File read(const Rpc3History& history) {
  test::write_file("signals.rsp", test::format_rpc3(history));
  return Rpc3File::read("signals.rsp");
}

std::string error_of_bytes(const std::string& bytes) {
  test::write_file("signals.rsp", bytes);
  try {
    const Rpc3File file = Rpc3File::read("signals.rsp");
    for (std::size_t i = 0; i < file.channels().size(); ++i) file.read_channel(i);
    return "no error";
  } catch (const support::InputError& error) {
    return error.what();
  }
}

std::string error_with(std::vector<std::pair<std::string, std::string>> changes) {
  Rpc3History history = two_channels();
  history.changes = std::move(changes);
  return error_of_bytes(test::format_rpc3(history));
}

}  // namespace

TEST_CASE("Every layout of an RPC III file gives the samples that were stored, times their scale") {
  for (const bool big_endian : {false, true}) {
    for (const bool floating_point : {false, true}) {
      for (const bool fills_last_group : {false, true}) {
        CAPTURE(big_endian, floating_point, fills_last_group);
        Rpc3History history = two_channels();
        history.big_endian = big_endian;
        history.floating_point = floating_point;
        history.fills_last_group = fills_last_group;
        const Rpc3File file = read(history);
        CHECK(file.time_step() == 0.01);
        REQUIRE(file.num_samples() == 12);
        REQUIRE(file.channels().size() == 2);
        for (std::size_t i = 0; i < 2; ++i) {
          const double scale = floating_point ? 1.0 : history.scales[i];  // these are in their unit already
          const std::vector<double> samples = file.read_channel(i);
          REQUIRE(samples.size() == 12);
          for (std::size_t k = 0; k < 12; ++k) CHECK(samples[k] == scale * history.samples[i][k]);
        }
      }
    }
  }
}

TEST_CASE("Channels have the name and the unit that the header gives, else a number") {
  Rpc3History history = two_channels();
  history.changes = {{"DESC.CHAN_2", ""}, {"UNITS.CHAN_2", ""}};
  const Rpc3File file = read(history);
  CHECK(file.channels()[0].name == "post 1");
  CHECK(file.channels()[0].unit == "mm");
  CHECK(file.channels()[1].name == "CHAN_2");
  CHECK(file.channels()[1].unit.empty());
  CHECK(file.hash().size() == 64);
}

TEST_CASE("Another full scale of the integers changes the scale of the samples") {
  Rpc3History history = two_channels();
  history.changes = {{"INT_FULL_SCALE", "16384"}};
  CHECK(read(history).read_channel(1)[0] == -7000.0);  // 2 · 16384/32768
}

TEST_CASE("A file is told by its first record") {
  test::write_file("signals.rsp", test::format_rpc3(two_channels()));
  CHECK(Rpc3File::is_one("signals.rsp"));
  test::write_file("text.csv", "FORMAT, of a text that is longer than one key of a header\n0,1\n");
  CHECK_FALSE(Rpc3File::is_one("text.csv"));
  CHECK_FALSE(Rpc3File::is_one("no such file"));
}

TEST_CASE("Every truncated file is refused") {
  Rpc3History history = two_channels();
  history.fills_last_group = false;
  const std::string bytes = test::format_rpc3(history);
  CHECK(error_of_bytes(bytes) == "no error");
  for (std::size_t size = 0; size < bytes.size(); size += size < 2300 ? 13 : 1) {
    CAPTURE(size);
    CHECK(error_of_bytes(bytes.substr(0, size)) != "no error");
  }
  // 18 records: 5 blocks; 2 channels, 12 samples of 2 bytes.
  CHECK(error_of_bytes(bytes.substr(0, bytes.size() - 1)) ==
        "signals.rsp: error: byte 2607: the file ends here; its header says 2608 bytes, or 2624 with a full "
        "last group");
  CHECK(error_of_bytes(bytes.substr(0, 200)) ==
        "signals.rsp: error: byte 200: the file ends within record 2 of the header, of 128 bytes");
  CHECK_THAT(error_of_bytes(bytes + std::string(2000, 'x')), Contains("the data end here, but the file has"));
}

TEST_CASE("Headers that do not fit are refused at their byte") {
  CHECK(error_with({}) == "no error");
  CHECK(
      error_with({{"FORMAT", "ASCII"}}) ==
      "signals.rsp: error: byte 32: 'FORMAT' must be BINARY_IEEE_LITTLE_END, BINARY_IEEE_BIG_END or BINARY, "
      "got 'ASCII'");
  CHECK(error_with({{"CHANNELS", "0"}}) ==
        "signals.rsp: error: byte 800: 'CHANNELS' must be a whole number from 1 to 10000, got '0'");
  CHECK(error_with({{"CHANNELS", ""}}) == "signals.rsp: error: the header has no 'CHANNELS'");
  CHECK_THAT(error_with({{"DELTA_T", "nan"}}), Contains("'DELTA_T' must be a number > 0, got 'nan'"));
  CHECK_THAT(error_with({{"DELTA_T", "-0.01"}}), Contains("'DELTA_T' must be a number > 0"));
  CHECK_THAT(error_with({{"PTS_PER_GROUP", "6"}}),
             Contains("must be a multiple of the 4 'PTS_PER_FRAME', got 6"));
  CHECK_THAT(
      error_with(
          {{"PTS_PER_FRAME", "1000000000"}, {"PTS_PER_GROUP", "1000000000"}, {"FRAMES", "1000000000"}}),
      Contains("'FRAMES' must be a whole number from 1 to 1, got '1000000000'"));
  CHECK_THAT(error_with({{"DATA_TYPE", "DOUBLE_PRECISION"}}),
             Contains("must be SHORT_INTEGER or FLOATING_POINT"));
  CHECK_THAT(error_with({{"FILE_TYPE", "MATRIX"}}), Contains("only time histories are read"));
  CHECK_THAT(error_with({{"PARTITIONS", "2"}}), Contains("several partitions"));
  CHECK_THAT(error_with({{"HALF_FRAMES", "1"}}), Contains("frames that overlap"));
  CHECK_THAT(error_with({{"SCALE.CHAN_2", ""}}), Contains("the header has no 'SCALE.CHAN_2'"));
  CHECK_THAT(error_with({{"NUM_PARAMS", "7000"}}), Contains("the file ends within record"));
  CHECK_THAT(error_with({{"NUM_HEADER_BLOCKS", "1"}}), Contains("too few for 18 records"));
  CHECK_THAT(error_with({{"FRAMES", "30"}}), Contains("the file ends here"));
}

TEST_CASE("A sample that is not finite is refused at its byte") {
  Rpc3History history = two_channels();
  history.floating_point = true;
  history.samples[1][9] = std::numeric_limits<double>::quiet_NaN();
  // Behind the header (2560) and the first group (64): 8 samples of channel 1, then sample 9 − 8 of
  // channel 2.
  CHECK(error_of_bytes(test::format_rpc3(history)) ==
        "signals.rsp: error: byte 2660: sample 10 of 'post 2' is not a finite number");
}

TEST_CASE("A scale of zero and a time step beyond all tests are refused") {
  CHECK_THAT(error_with({{"SCALE.CHAN_2", "0.0"}}),
             Contains("'SCALE.CHAN_2' must be a number other than 0, got '0.0'"));
  CHECK_THAT(error_with({{"DELTA_T", "1e300"}}), Contains("'DELTA_T' must be at most 1e+06 s, got '1e300'"));
}
