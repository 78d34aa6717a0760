#include "dynamics/input/superelement_cache.h"

#include <sys/stat.h>

#include <ctime>

namespace sprung::dynamics {

namespace {

constexpr std::size_t kMostEntries = 64;

std::int64_t to_nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

reduce::Superelement SuperelementCache::read(const std::filesystem::path& path) {
  struct stat status = {};
  timespec now = {};
  if (stat(path.c_str(), &status) != 0 || clock_gettime(CLOCK_REALTIME, &now) != 0)
    return reduce::read_superelement(path);
  const FileId id{status.st_dev, status.st_ino};
  const auto size = static_cast<std::uint64_t>(status.st_size);
  const std::int64_t modified = to_nanoseconds(status.st_mtim), changed = to_nanoseconds(status.st_ctim);
  const auto found = entries_.find(id);
  if (found != entries_.end()) {
    const Entry& entry = found->second;
    if (entry.size == size && entry.modified == modified && entry.changed == changed)
      return entry.superelement;
    entries_.erase(found);
  }
  ++num_reads_;
  reduce::Superelement superelement = reduce::read_superelement(path);
  if (to_nanoseconds(now) - changed < age_) return superelement;
  if (entries_.size() >= kMostEntries) entries_.clear();
  return entries_.emplace(id, Entry{size, modified, changed, std::move(superelement)})
      .first->second.superelement;
}

}  // namespace sprung::dynamics
