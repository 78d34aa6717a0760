#include "tools/support/hdf5/hdf5_library.h"

#include <algorithm>

namespace sprung::support::hdf5 {

namespace {

constexpr std::string_view kUnknownReason = "HDF5 gives no reason";

// Descriptions of the error stack, the cause first. Called by C: nothing may be thrown through it.
herr_t collect_description(unsigned, const H5E_error2_t* error, void* collected) noexcept {
  try {
    if (error->desc != nullptr) static_cast<std::vector<std::string>*>(collected)->emplace_back(error->desc);
    return 0;
  } catch (...) {
    return -1;
  }
}

// HDF5 wraps the system's reason in addresses and a time: `… error message = 'No space left on device', buf =
// …`.
std::string system_reason(std::string_view description) {
  constexpr std::string_view kBefore = "error message = '";
  const std::size_t begin = description.find(kBefore);
  if (begin == std::string_view::npos) return std::string(description);
  const std::string_view rest = description.substr(begin + kBefore.size());
  return std::string(rest.substr(0, rest.find('\'')));
}

}  // namespace

void initialize() {
  // A failed H5Fclose leaves an identifier whose file is gone, and the library's clean-up at exit would use
  // it again. Everything here is closed by its owner.
  static const herr_t no_clean_up = H5dont_atexit();
  static_cast<void>(no_clean_up);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the error stack, and this with it, belongs to the thread
}

std::string failure_reason() {
  std::vector<std::string> descriptions;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, collect_description, &descriptions);
  struct Known {
    std::string_view part, meaning;
  };
  constexpr Known kKnown[] = {
      {"Fletcher32", "its checksum does not fit, the data is damaged"},
      // HDF5 1.14 says no more about a filter: it is the checksum, or the decompression before it.
      {"filter returned failure during read", "its checksum does not fit, the data is damaged"},
      {"metadata checksum", "the file is damaged (a checksum of its structure does not fit)"},
      {"truncated file", "the file is truncated"},
      {"already open for write", "the file was not closed by the program that wrote it"},
      {"unable to lock", "another program is using the file"},
  };
  for (const Known& known : kKnown) {
    for (const std::string& description : descriptions) {
      if (description.find(known.part) != std::string::npos) return std::string(known.meaning);
    }
  }
  return descriptions.empty() ? std::string(kUnknownReason) : system_reason(descriptions.front());
}

Hdf5Handle own(hid_t id, int (*close)(std::int64_t), std::string_view what) {
  return Hdf5Handle(check(id, what), close);
}

Hdf5Handle make_properties(hid_t object_class) {
  Hdf5Handle properties = own(H5Pcreate(object_class), H5Pclose, "HDF5 properties cannot be made");
  check(H5Pset_obj_track_times(properties.get(), false), "HDF5 properties cannot be set");
  return properties;
}

bool exists(hid_t file, const std::string& path) {
  const std::string what = fmt::format("'{}' cannot be looked up", path);
  for (std::size_t end = path.find('/', 1); true; end = path.find('/', end + 1)) {
    const std::string prefix = path.substr(0, end);
    if (!prefix.empty() && prefix != "/") {
      if (check(H5Lexists(file, prefix.c_str(), H5P_DEFAULT), what) == 0) return false;
      if (check(H5Oexists_by_name(file, prefix.c_str(), H5P_DEFAULT), what) == 0) return false;
      const Hdf5Handle object = own(H5Oopen(file, prefix.c_str(), H5P_DEFAULT), H5Oclose, what);
      if (end != std::string::npos && H5Iget_type(object.get()) != H5I_GROUP) return false;
    }
    if (end == std::string::npos) return true;
  }
}

std::string parent_path(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string::npos ? std::string{} : path.substr(0, slash);
}

const char* leaf_name(const std::string& path) {
  return path.c_str() + (path.find_last_of('/') + 1);
}

std::vector<hsize_t> chunk_shape(std::span<const hsize_t> shape, std::size_t element_size) {
  constexpr hsize_t kLargest = 1U << 20U;
  std::vector<hsize_t> chunk(shape.begin(), shape.end());
  hsize_t size = element_size;
  for (std::size_t i = chunk.size(); i-- > 0;) {
    chunk[i] = std::clamp<hsize_t>(kLargest / size, 1, std::max<hsize_t>(chunk[i], 1));
    size *= chunk[i];
  }
  return chunk;
}

Hdf5Handle make_dataset(hid_t group, const std::string& path, hid_t type, std::span<const hsize_t> shape,
                        std::span<const hsize_t> chunk, Storage storage) {
  const std::string what = fmt::format("dataset '{}' cannot be made", path);
  const int rank = static_cast<int>(shape.size());
  std::vector<hsize_t> limits(shape.begin(), shape.end());
  if (storage != Storage::kFixed) limits.front() = H5S_UNLIMITED;
  const Hdf5Handle space = own(H5Screate_simple(rank, shape.data(), limits.data()), H5Sclose, what);
  const Hdf5Handle properties = make_properties(H5P_DATASET_CREATE);
  check(H5Pset_chunk(properties.get(), rank, chunk.data()), what);
  check(H5Pset_fletcher32(properties.get()), what);
  if (storage == Storage::kCompressed) {
    check(H5Pset_shuffle(properties.get()), what);
    check(H5Pset_deflate(properties.get(), 1), what);
  }
  return own(
      H5Dcreate2(group, leaf_name(path), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
      H5Dclose, what);
}

Hdf5Handle make_string_type(std::size_t size) {
  const std::string_view what = "an HDF5 string type cannot be made";
  Hdf5Handle type = own(H5Tcopy(H5T_C_S1), H5Tclose, what);
  check(H5Tset_size(type.get(), std::max<std::size_t>(size, 1)), what);
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), what);
  check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), what);
  return type;
}

void write_string_attribute(hid_t object, const std::string& name, std::string_view value) {
  const std::string what = fmt::format("attribute '{}' cannot be written", name);
  const Hdf5Handle type = make_string_type(value.size());
  const Hdf5Handle space = own(H5Screate(H5S_SCALAR), H5Sclose, what);
  const Hdf5Handle attribute = own(
      H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
  std::string padded(value);
  padded.resize(std::max<std::size_t>(value.size(), 1), '\0');
  check(H5Awrite(attribute.get(), type.get(), padded.data()), what);
}

}  // namespace sprung::support::hdf5
