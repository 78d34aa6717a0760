#include "tools/support/hdf5/fletcher32.h"

#include <cstring>
#include <random>
#include <span>
#include <vector>

#include "tests/catch.h"

using namespace sprung;

namespace {

// Word by word, as the sums are defined.
std::uint32_t sum_words(const std::vector<double>& values) {
  std::vector<unsigned char> bytes(values.size() * sizeof(double));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  const auto add = [](std::uint32_t a, std::uint32_t b) { return ((a + b) & 0xffffU) + ((a + b) >> 16U); };
  std::uint32_t sum = 0, weighted = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    sum = add(sum, static_cast<std::uint32_t>(bytes[i] << 8U | bytes[i + 1]));
    weighted = add(weighted, sum);
  }
  return weighted << 16U | sum;
}

std::uint32_t calc_checksum(const std::vector<double>& values) {
  return support::calc_fletcher32(std::as_bytes(std::span(values)));
}

}  // namespace

TEST_CASE("The checksum is that of its definition, word by word", "[hdf5]") {
  std::mt19937_64 random(17);
  for (const std::size_t size : {0, 1, 2, 7, 255, 256, 257, 4096, 100003}) {
    std::vector<double> values(size);
    for (double& value : values) {
      const std::uint64_t bits = random();
      std::memcpy(&value, &bits, sizeof value);
    }
    INFO(size << " values");
    CHECK(calc_checksum(values) == sum_words(values));
  }
}

TEST_CASE("Zero words and words that add up to zero in ones' complement give different sums", "[hdf5]") {
  CHECK(calc_checksum(std::vector<double>(1000, 0.0)) == 0);
  const std::uint64_t ones = ~std::uint64_t{0};
  std::vector<double> values(513);
  for (double& value : values) std::memcpy(&value, &ones, sizeof value);
  CHECK(calc_checksum(values) == sum_words(values));
  CHECK(calc_checksum(values) == 0xffffffffU);
}
