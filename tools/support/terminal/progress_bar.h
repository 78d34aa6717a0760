#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace sprung::support {

/// Shows the progress of a long calculation: on a terminal a bar with the time left, elsewhere a
/// line for each tenth, and nothing if quiet.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet, std::FILE* stream = stderr);
  ~ProgressBar() { finish(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param fraction  part that is done, from 0 to 1
  void update(double fraction);
  /// Of a calculation of unknown length: on a terminal what it is at, from a second after the beginning on;
  /// elsewhere nothing.
  void update(const std::string& state);
  /// Ends the line. Called by the destructor too.
  void finish();

 private:
  bool is_time_to_draw();  // on a terminal
  void draw(double fraction);

  std::string label_;
  std::FILE* stream_;
  bool quiet_, is_terminal_;
  bool drawn_ = false;
  int tenths_ = 0;
  std::chrono::steady_clock::time_point start_, last_drawn_;
};

}  // namespace sprung::support
