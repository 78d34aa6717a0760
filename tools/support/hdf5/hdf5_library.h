#pragma once

// Private to this room: functions that the writer and the reader share. Only this header includes HDF5's.
#include <fmt/format.h>
#include <hdf5.h>

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "tools/support/hdf5/hdf5_handle.h"

namespace sprung::support::hdf5 {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>, "Hdf5Handle relies on it");

/// A call of HDF5 that failed. The message says what was attempted, and the reason of the system or the
/// library. The writer and the reader turn it into an InputError of their file.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// To be called before any other call of HDF5. The library then prints nothing and does no clean-up at exit,
/// which would crash after a failed close.
void initialize();

/// The reason for the last failure, from HDF5's error stack, in words for the user.
std::string failure_reason();

/// Returns a status or identifier that is not negative.
/// @throws Failure `what: reason` if it is negative
template <typename Status>
Status check(Status status, std::string_view what) {
  if (status < 0) throw Failure(fmt::format("{}: {}", what, failure_reason()));
  return status;
}

/// Takes ownership of an identifier after check().
Hdf5Handle own(hid_t id, int (*close)(std::int64_t), std::string_view what);

/// Creation properties of an object of this class, without time stamps.
Hdf5Handle make_properties(hid_t object_class);

/// Whether there is an object at a path; false also if a group of the path is missing.
bool exists(hid_t file, const std::string& path);

/// The path up to the last '/', "" for the file itself.
std::string parent_path(const std::string& path);

/// The part of the path behind the last '/'.
const char* leaf_name(const std::string& path);

/// Chunk of a dataset: whole rows, at most about 1 MiB, at least one element.
std::vector<hsize_t> chunk_shape(std::span<const hsize_t> shape, std::size_t element_size);

enum class Storage {
  kFixed,
  kGrowing,     ///< the first dimension has no limit
  kCompressed,  ///< likewise; filters "shuffle" and "deflate" after the checksum
};

/// A dataset with checksums.
/// @param group  that it belongs to   @param path  from the root, of which the last part is its name
/// @param chunk  as many numbers as `shape`
Hdf5Handle make_dataset(hid_t group, const std::string& path, hid_t type, std::span<const hsize_t> shape,
                        std::span<const hsize_t> chunk, Storage storage);

/// Fixed-length UTF-8, padded with NUL.
Hdf5Handle make_string_type(std::size_t size);

void write_string_attribute(hid_t object, const std::string& name, std::string_view value);

}  // namespace sprung::support::hdf5
