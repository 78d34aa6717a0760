#include "tools/support/hdf5/flushed_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/fs.h>
#include <sys/ioctl.h>
#include <sys/sendfile.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "tools/support/hdf5/hdf5_library.h"
#include "tools/support/hdf5/open_mark.h"

namespace sprung::support::hdf5 {

namespace {

namespace fs = std::filesystem;

constexpr off_t kStructureOfFlush = off_t{1} << 16U;  // bytes

int find_descriptor(hid_t file) {
  void* handle = nullptr;
  check(H5Fget_vfd_handle(file, H5P_DEFAULT, &handle), "the file's descriptor cannot be had");
  return *static_cast<int*>(handle);
}

Failure cannot_be_written(int reason) {
  return Failure(fmt::format("cannot be written: {}", std::strerror(reason)));
}

struct Descriptor {
  Descriptor(const fs::path& path, int flags) : value(::open(path.c_str(), flags | O_CLOEXEC)) {
    if (value < 0) throw cannot_be_written(errno);
  }
  ~Descriptor() { ::close(value); }
  Descriptor(const Descriptor&) = delete;
  int value;
};

// Copies from where the descriptors are, within the system. @return the bytes copied, -1 for an error
ssize_t copy_part(int source, int target) {
  constexpr std::size_t kMost = std::size_t{1} << 30U;
  const ssize_t count = ::copy_file_range(source, nullptr, target, nullptr, kMost, 0);
  if (count >= 0 || errno == ENOSPC || errno == EDQUOT || errno == EFBIG || errno == EIO) return count;
  return ::sendfile(target, source, nullptr, kMost);
}

void copy_content(const fs::path& file, int source, int target) {
  std::error_code error;
  auto left = fs::file_size(file, error);
  if (error) throw cannot_be_written(error.value());
  const auto space = fs::space(file, error);
  if (!error && space.available / 2 < left) throw cannot_be_written(ENOSPC);
  while (left > 0) {
    const ssize_t count = copy_part(source, target);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw cannot_be_written(count < 0 ? errno : EIO);
    left -= static_cast<std::uintmax_t>(count);
  }
}

void reserve(int descriptor, off_t begin, off_t end) {
  if (::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, begin, end - begin) == 0) return;
  if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG) throw cannot_be_written(errno);
}

}  // namespace

// Only where there is none yet: some file systems ask for the space of all, also of what is there.
void reserve_space(std::int64_t file, const fs::path& path) {
  haddr_t allocated = 0;
  check(H5Fget_eoa(file, &allocated), "the end of the file cannot be had");
  const off_t end = static_cast<off_t>(allocated) + kStructureOfFlush;
  const Descriptor own(path, O_RDWR);
  off_t hole = ::lseek(own.value, 0, SEEK_HOLE);  // at the end of the file there is one
  while (hole >= 0 && hole < end) {
    const off_t data = ::lseek(own.value, hole, SEEK_DATA);  // -1 behind the last data
    reserve(own.value, hole, data < 0 ? end : std::min(data, end));
    if (data < 0) return;
    hole = ::lseek(own.value, data, SEEK_HOLE);
  }
}

void keep_as_flushed(std::int64_t file, std::uintmax_t size) {
  const int descriptor = find_descriptor(file);
  if (::ftruncate(descriptor, static_cast<off_t>(size)) != 0) throw cannot_be_written(errno);
  clear_open_mark(descriptor);
  const Descriptor nowhere("/dev/null", O_RDWR);
  if (::dup2(nowhere.value, descriptor) < 0) throw cannot_be_written(errno);
}

void copy_flushed(const fs::path& file, const fs::path& copy) {
  const Descriptor source(file, O_RDONLY), target(copy, O_RDWR | O_TRUNC);
  // Some file systems have both files share their content from then on, which takes no space.
  if (::ioctl(target.value, FICLONE, source.value) != 0) copy_content(file, source.value, target.value);
  clear_open_mark(target.value);
}

}  // namespace sprung::support::hdf5
