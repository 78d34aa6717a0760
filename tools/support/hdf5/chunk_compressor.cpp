#include "tools/support/hdf5/chunk_compressor.h"

#include <zlib.h>

#include <cstring>

#include "tools/support/hdf5/fletcher32.h"
#include "tools/support/hdf5/hdf5_library.h"

namespace sprung::support {

namespace {

constexpr int kFastest = 1;  // level of deflate: higher ones gain some hundredths in histories
constexpr int kMemoryLevel = 8;
constexpr std::size_t kSize = sizeof(float);

}  // namespace

struct ChunkCompressor::Stream {
  z_stream z{};
  bool is_ready = false;
};

ChunkCompressor::ChunkCompressor() : stream_(std::make_unique<Stream>()) {}

ChunkCompressor::~ChunkCompressor() {
  if (stream_->is_ready) deflateEnd(&stream_->z);
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
  z_stream& z = stream_->z;
  if (!stream_->is_ready) {
    const int status = deflateInit2(&z, kFastest, Z_DEFLATED, MAX_WBITS, kMemoryLevel, Z_DEFAULT_STRATEGY);
    if (status != Z_OK) throw hdf5::Failure("there is no memory to compress it");
    stream_->is_ready = true;
  }
  const std::size_t count = chunk.size() / kSize;
  shuffled_.resize(chunk.size());
  for (std::size_t byte = 0; byte < kSize; ++byte) {
    for (std::size_t i = 0; i < count; ++i) shuffled_[byte * count + i] = chunk[i * kSize + byte];
  }
  deflateReset(&z);
  std::vector<std::uint8_t> packed(deflateBound(&z, shuffled_.size()));
  z.next_in = shuffled_.data();
  z.avail_in = static_cast<uInt>(shuffled_.size());
  z.next_out = packed.data();
  z.avail_out = static_cast<uInt>(packed.size());
  deflate(&z, Z_FINISH);  // cannot fail: there is room for the result
  packed.resize(z.total_out);
  return packed;
}

}  // namespace sprung::support
