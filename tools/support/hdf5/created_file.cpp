#include "tools/support/hdf5/created_file.h"

#include <fmt/format.h>

#include <string_view>

#include "tools/support/hdf5/hdf5_library.h"

namespace sprung::support::hdf5 {

namespace {

constexpr std::string_view kNoCache = "HDF5's cache cannot be set";
constexpr std::size_t kCacheSize = std::size_t{2} << 20;  // bytes

// All that is in the cache is freed when the file is closed, which takes seconds for 100,000 objects.
void keep_cache_small(hid_t access) {
  H5AC_cache_config_t cache{};
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  check(H5Pget_mdc_config(access, &cache), kNoCache);
  cache.set_initial_size = true;
  cache.initial_size = kCacheSize;
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  check(H5Pset_mdc_config(access, &cache), kNoCache);
}

}  // namespace

Hdf5Handle create_file(const std::filesystem::path& path, bool keeps_order) {
  const std::string_view what = "cannot be written";
  const Hdf5Handle access = own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
  // Format 1.10: its structure carries checksums too, and other programs have read it since 2016.
  check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110), what);
  check(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG), what);
  keep_cache_small(access.get());
  check(H5Pset_file_locking(access.get(), false, true), what);  // TemporaryFile has its lock
  const Hdf5Handle creation = make_properties(H5P_FILE_CREATE);
  if (keeps_order) {
    check(H5Pset_link_creation_order(creation.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), what);
  }
  return own(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose, what);
}

void hold_structure_between_flushes(std::int64_t file) {
  H5AC_cache_config_t cache{};
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  check(H5Fget_mdc_config(file, &cache), kNoCache);
  if (!cache.evictions_enabled) return;
  cache.set_initial_size = false;
  cache.evictions_enabled = false;
  check(H5Fset_mdc_config(file, &cache), kNoCache);
}

void remove_attribute(hid_t object, const std::string& name) {
  const std::string what = fmt::format("attribute '{}' cannot be written", name);
  if (check(H5Aexists(object, name.c_str()), what) > 0) check(H5Adelete(object, name.c_str()), what);
}

void write_scalar_attribute(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type,
                            const void* value) {
  const std::string what = fmt::format("attribute '{}' cannot be written", name);
  const auto open_or_make = [&] {
    if (check(H5Aexists(object, name.c_str()), what) > 0) return H5Aopen(object, name.c_str(), H5P_DEFAULT);
    const Hdf5Handle space = own(H5Screate(H5S_SCALAR), H5Sclose, what);
    return H5Acreate2(object, name.c_str(), file_type, space.get(), H5P_DEFAULT, H5P_DEFAULT);
  };
  const Hdf5Handle attribute = own(open_or_make(), H5Aclose, what);
  check(H5Awrite(attribute.get(), memory_type, value), what);
}

}  // namespace sprung::support::hdf5
