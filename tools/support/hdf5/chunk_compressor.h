#pragma once

// Private to this room.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

struct libdeflate_compressor;

namespace sprung::support {

/// Packs chunks of numbers of single precision as HDF5's filters "fletcher32", "shuffle" and "deflate" do,
/// one after the other: the checksum follows the values, then come all first bytes of the numbers, all second
/// ones and so on, and these are compressed. Neighbours in a history have the same leading bytes. The
/// trailing ones are often as if drawn at random; those are stored as they are, which deflate allows, for
/// compressing them takes as long as the rest and gains nothing.
class ChunkCompressor {
 public:
  /// @param values  of a chunk, an even number of them
  /// @return the chunk without "shuffle" and "deflate", of one size for all chunks of a shape
  static std::vector<std::uint8_t> append_checksum(std::span<const float> values);
  /// @param chunk  with its checksum
  /// @throws hdf5::Failure if there is no memory
  std::vector<std::uint8_t> compress(std::span<const std::uint8_t> chunk);

 private:
  struct Free {
    void operator()(libdeflate_compressor* compressor) const;
  };
  std::unique_ptr<libdeflate_compressor, Free> compressor_;  // made with the first chunk
  std::vector<std::uint32_t> words_;                         // the numbers of a chunk, and its checksum
  std::vector<std::uint8_t> shuffled_;  // four parts: first bytes of all numbers, second ones and so on
};

}  // namespace sprung::support
