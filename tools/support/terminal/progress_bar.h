#pragma once

#include <chrono>
#include <string>

namespace sprung::support {

/// How far long work has come, on stderr: a bar with the time left on a terminal, a plain line for every
/// tenth elsewhere, nothing when quiet.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ~ProgressBar() { finish(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param fraction  done, from 0 to 1
  void update(double fraction);
  /// Ends the line. Called by the destructor too.
  void finish();

 private:
  void draw(double fraction);

  std::string label_;
  bool quiet_, is_terminal_;
  bool drawn_ = false;
  int tenths_ = 0;
  std::chrono::steady_clock::time_point start_, last_drawn_;
};

}  // namespace sprung::support
