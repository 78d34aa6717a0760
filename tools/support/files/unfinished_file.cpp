#include "tools/support/files/unfinished_file.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>

namespace sprung::support {

namespace {

// In static memory, as a signal handler reads them.
struct Slot {
  std::atomic<bool> is_taken{false}, is_ready{false};
  std::array<char, 4096> path{};
};
std::array<Slot, 8> slots;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler reads it");

}  // namespace

UnfinishedFile::UnfinishedFile(const std::filesystem::path& path) {
  if (path.native().size() >= slots.front().path.size()) return;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].is_taken.exchange(true)) continue;
    std::strcpy(slots[i].path.data(), path.c_str());
    slots[i].is_ready = true;
    slot_ = i;
    return;
  }
}

UnfinishedFile::~UnfinishedFile() {
  if (!slot_) return;
  slots[*slot_].is_ready = false;
  slots[*slot_].is_taken = false;
}

void remove_unfinished_files() noexcept {
  for (const Slot& slot : slots)
    if (slot.is_ready) ::unlink(slot.path.data());
}

}  // namespace sprung::support
