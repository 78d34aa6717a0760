#include "tools/support/terminal/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "tools/support/terminal/print.h"

namespace sprung::support {

namespace {

constexpr auto kDrawInterval = std::chrono::milliseconds(100);
constexpr double kSecondsOfSilence = 1.0;
constexpr int kWidth = 30;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

ProgressBar::ProgressBar(std::string label, bool quiet, std::FILE* stream)
    : label_(std::move(label)),
      stream_(stream),
      quiet_(quiet),
      is_terminal_(isatty(fileno(stream)) == 1),
      start_(std::chrono::steady_clock::now()),
      last_drawn_(start_) {}

void ProgressBar::update(double fraction) {
  if (quiet_) return;
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (is_terminal_) {
    if (is_time_to_draw()) draw(fraction);
  } else if (static_cast<int>(10.0 * fraction) > tenths_) {
    tenths_ = static_cast<int>(10.0 * fraction);
    print(stream_, "{}: {} %\n", label_, 10 * tenths_);
  }
}

void ProgressBar::update(const std::string& state) {
  if (quiet_ || !is_terminal_ || seconds_since(start_) < kSecondsOfSilence || !is_time_to_draw()) return;
  print(stream_, "\r{}: {}\x1b[K", label_, state);
  std::fflush(stream_);
  drawn_ = true;
}

bool ProgressBar::is_time_to_draw() {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_drawn_ < kDrawInterval) return false;
  last_drawn_ = now;
  return true;
}

void ProgressBar::draw(double fraction) {
  const int filled = static_cast<int>(kWidth * fraction);
  std::string bar;
  for (int i = 0; i < kWidth; ++i) bar += i < filled ? "█" : "░";
  const double elapsed = seconds_since(start_);
  const std::string left =
      fraction > 0.01 ? fmt::format("{:.0f} s left", elapsed * (1.0 - fraction) / fraction) : std::string{};
  print(stream_, "\r{} {} {:3.0f} %  {}\x1b[K", label_, bar, 100.0 * fraction, left);
  std::fflush(stream_);
  drawn_ = true;
}

void ProgressBar::finish() {
  if (drawn_) print(stream_, "\r\x1b[K");
  drawn_ = false;
}

}  // namespace sprung::support
