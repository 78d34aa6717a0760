#include "tools/support/hdf5/chunk_compressor.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "tools/support/hdf5/fletcher32.h"
#include "tools/support/hdf5/hdf5_library.h"

namespace sprung::support {

namespace {

constexpr int kFastest = 1;  // level of deflate: higher ones gain some hundredths in histories
constexpr std::size_t kSize = sizeof(float);
static_assert(std::endian::native == std::endian::little, "the first byte of a number is its lowest");
constexpr std::size_t kLargestStored = 65535;  // bytes of one stored block (RFC 1951, 3.2.4)

// Whether compressing would gain nothing: two bytes of the first thousand are equal about as rarely as two
// that are drawn at random, which are in one of 256 cases.
bool is_random(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kLooked = 1024;
  constexpr double kMostEqual = 1.25 / 256;  // with 1.5 files of results grow by 2 %
  std::array<std::size_t, 256> count{};
  const std::span<const std::uint8_t> looked = bytes.first(std::min(bytes.size(), kLooked));
  for (const std::uint8_t byte : looked) ++count[byte];
  double num_equal = 0.0;
  for (const std::size_t one : count)
    num_equal += static_cast<double>(one) * (static_cast<double>(one) - 1.0);
  const auto num_looked = static_cast<double>(looked.size());
  return num_equal < kMostEqual * num_looked * (num_looked - 1.0);
}

// Blocks of deflate that hold the bytes as they are, none of them the last of its stream.
void append_stored(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& stream) {
  while (!bytes.empty()) {
    const std::span<const std::uint8_t> block = bytes.first(std::min(bytes.size(), kLargestStored));
    const auto length = static_cast<std::uint16_t>(block.size());
    for (const int byte : {0, length & 0xff, length >> 8, ~length & 0xff, (~length >> 8) & 0xff})
      stream.push_back(static_cast<std::uint8_t>(byte));
    stream.insert(stream.end(), block.begin(), block.end());
    bytes = bytes.subspan(block.size());
  }
}

}  // namespace

void ChunkCompressor::Free::operator()(libdeflate_compressor* compressor) const {
  libdeflate_free_compressor(compressor);
}

std::vector<std::uint8_t> ChunkCompressor::append_checksum(std::span<const float> values) {
  const std::uint32_t checksum = calc_fletcher32(std::as_bytes(values));
  std::vector<std::uint8_t> chunk(values.size_bytes() + sizeof checksum);
  std::memcpy(chunk.data(), values.data(), values.size_bytes());
  std::memcpy(chunk.data() + values.size_bytes(), &checksum, sizeof checksum);
  return chunk;
}

std::vector<std::uint8_t> ChunkCompressor::compress(std::span<const std::uint8_t> chunk) {
  if (!compressor_) compressor_.reset(libdeflate_alloc_compressor(kFastest));
  if (!compressor_) throw hdf5::Failure("there is no memory to compress it");
  const std::size_t count = chunk.size() / kSize;
  words_.resize(count);
  std::memcpy(words_.data(), chunk.data(), count * kSize);
  shuffled_.resize(count * kSize);
  std::array<std::uint8_t*, kSize> parts{};
  for (std::size_t byte = 0; byte < kSize; ++byte) parts[byte] = shuffled_.data() + byte * count;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t word = words_[i];
    for (std::size_t byte = 0; byte < kSize; ++byte)
      parts[byte][i] = static_cast<std::uint8_t>(word >> (8 * byte));
  }
  const std::span<const std::uint8_t> all(shuffled_);
  std::size_t num_stored = 0;
  while (num_stored + count < all.size() && is_random(all.subspan(num_stored, count))) num_stored += count;
  // A stream of zlib (RFC 1950): two bytes that announce it, blocks of deflate, the checksum of what they
  // hold.
  std::vector<std::uint8_t> packed{0x78, 0x01};
  append_stored(all.first(num_stored), packed);
  const std::span<const std::uint8_t> rest = all.subspan(num_stored);
  const std::size_t start = packed.size();
  packed.resize(start + libdeflate_deflate_compress_bound(compressor_.get(), rest.size()));
  packed.resize(start + libdeflate_deflate_compress(compressor_.get(), rest.data(), rest.size(),
                                                    packed.data() + start, packed.size() - start));
  const std::uint32_t checksum = libdeflate_adler32(1, all.data(), all.size());
  for (const int shift : {24, 16, 8, 0}) packed.push_back(static_cast<std::uint8_t>(checksum >> shift));
  return packed;
}

}  // namespace sprung::support
