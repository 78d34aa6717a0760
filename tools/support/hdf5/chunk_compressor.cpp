#include "tools/support/hdf5/chunk_compressor.h"

#include <libdeflate.h>

#include <cstring>

#include "tools/support/hdf5/fletcher32.h"
#include "tools/support/hdf5/hdf5_library.h"

namespace sprung::support {

namespace {

constexpr int kFastest = 1;  // level of deflate: higher ones gain some hundredths in histories
constexpr std::size_t kSize = sizeof(float);

}  // namespace

void ChunkCompressor::Free::operator()(libdeflate_compressor* compressor) const {
  libdeflate_free_compressor(compressor);
}

std::vector<std::uint8_t> ChunkCompressor::append_checksum(std::span<const float> values) {
  static_assert(sizeof(double) == 2 * kSize);
  // The rule of the checksum is that of bytes, so two numbers may be read as one of twice the size.
  std::vector<double> pairs(values.size() / 2);
  std::memcpy(pairs.data(), values.data(), values.size_bytes());
  const std::uint32_t checksum = calc_fletcher32(pairs);
  std::vector<std::uint8_t> chunk(values.size_bytes() + sizeof checksum);
  std::memcpy(chunk.data(), values.data(), values.size_bytes());
  std::memcpy(chunk.data() + values.size_bytes(), &checksum, sizeof checksum);
  return chunk;
}

std::vector<std::uint8_t> ChunkCompressor::compress(std::span<const std::uint8_t> chunk) {
  if (!compressor_) compressor_.reset(libdeflate_alloc_compressor(kFastest));
  if (!compressor_) throw hdf5::Failure("there is no memory to compress it");
  const std::size_t count = chunk.size() / kSize;
  shuffled_.resize(chunk.size());
  for (std::size_t byte = 0; byte < kSize; ++byte) {
    for (std::size_t i = 0; i < count; ++i) shuffled_[byte * count + i] = chunk[i * kSize + byte];
  }
  std::vector<std::uint8_t> packed(libdeflate_zlib_compress_bound(compressor_.get(), shuffled_.size()));
  packed.resize(libdeflate_zlib_compress(compressor_.get(), shuffled_.data(), shuffled_.size(), packed.data(),
                                         packed.size()));
  return packed;
}

}  // namespace sprung::support
