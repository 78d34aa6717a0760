#include "tools/support/hdf5/fletcher32.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>

namespace sprung::support {

namespace {

constexpr std::size_t kRowSize = sizeof(std::uint64_t);           // bytes that are read at a time
constexpr std::size_t kWords = kRowSize / sizeof(std::uint16_t);  // of a row, each with sums of its own
constexpr std::size_t kMostRows = 256;                            // whose sums fit in 32 bits
constexpr std::uint64_t kHalf = 0xffff'ffff;
constexpr std::uint64_t kEven = 0x0000'ffff'0000'ffff;  // words 0 and 2, each with room for its sums

// x mod 65535, which stands for zero only if x is zero.
std::uint32_t reduce(std::uint64_t x) {
  return x == 0 ? 0 : static_cast<std::uint32_t>((x - 1) % 65535 + 1);
}

}  // namespace

std::uint32_t calc_fletcher32(std::span<const std::byte> bytes) {
  assert(bytes.size() % kRowSize == 0);
  std::uint64_t sum = 0, weighted = 0;  // reduced
  while (!bytes.empty()) {
    const std::size_t rows = std::min(bytes.size() / kRowSize, kMostRows);
    // Σ_i w and Σ_i (rows − i) w over the rows, for the words of a row two by two.
    std::uint64_t even = 0, even_twice = 0, odd = 0, odd_twice = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      std::uint64_t words = 0;
      std::memcpy(&words, bytes.data() + i * kRowSize, kRowSize);
      even += words & kEven;
      even_twice += even;
      odd += (words >> 16U) & kEven;
      odd_twice += odd;
    }
    const std::array<std::uint64_t, kWords> once{even & kHalf, odd & kHalf, even >> 32U, odd >> 32U};
    const std::array<std::uint64_t, kWords> twice{even_twice & kHalf, odd_twice & kHalf, even_twice >> 32U,
                                                  odd_twice >> 32U};
    weighted += rows * kWords * sum;
    for (std::size_t k = 0; k < kWords; ++k) {
      sum += once[k];
      weighted += kWords * twice[k] - k * once[k];
    }
    sum = reduce(sum);
    weighted = reduce(weighted);
    bytes = bytes.subspan(rows * kRowSize);
  }
  // The words above are little-endian; exchanging the bytes of one multiplies it by 256 in this arithmetic.
  static_assert(std::endian::native == std::endian::little);
  return reduce(256 * weighted) << 16U | reduce(256 * sum);
}

}  // namespace sprung::support
