#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "reduce/export/frame_matrices.h"
#include "reduce/program/commands.h"
#include "reduce/sensitivity/sensitivity_tables.h"
#include "reduce/sensitivity/sweep_tables.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/terminal/print.h"
#include "tools/support/terminal/program.h"

namespace sprung::reduce {

namespace {

constexpr int kMostSteps = 10'000;

[[noreturn]] void reject_range(const std::string& text) {
  throw support::InputError({.path = "--vary"},
                            fmt::format("'{}' is not of the form key.path=FROM:TO:STEPS, two numbers and "
                                        "1 … {} steps between them",
                                        text, kMostSteps));
}

double read_end(const std::string& text, const std::string& whole) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) reject_range(whole);
  return number;
}

// KEY=FROM:TO:STEPS as values at equal distances, the ends included.
SweepOptions read_sweep(const SweepCommand& command) {
  const std::string& text = command.vary;
  const std::size_t equals = text.rfind('='), first = text.find(':', equals == text.npos ? 0 : equals);
  const std::size_t second = first == text.npos ? text.npos : text.find(':', first + 1);
  if (equals == text.npos || equals == 0 || second == text.npos) reject_range(text);
  const double from = read_end(text.substr(equals + 1, first - equals - 1), text);
  const double to = read_end(text.substr(first + 1, second - first - 1), text);
  const double steps = read_end(text.substr(second + 1), text);
  if (!(steps >= 1.0 && steps <= kMostSteps) || steps != std::floor(steps)) reject_range(text);
  SweepOptions options{.design = command.design,
                       .key = text.substr(0, equals),
                       .values = {},
                       .num_modes = command.num_modes,
                       .is_preview = command.preview};
  for (int i = 0; i <= static_cast<int>(steps); ++i) options.values.push_back(from + (to - from) * i / steps);
  return options;
}

}  // namespace

int run_sensitivity(const SensitivityOptions& options) {
  const support::TomlDocument document = read_document(options.design);
  if (const auto matrices = document.root().find("matrices"))
    throw matrices->error("gives the body; sensitivities are those of beams");
  const Design design = read_design(options.design);
  std::vector<LeftOutNumber> left_out;
  const DesignSensitivity sensitivity =
      calc_sensitivity(design, list_parameters(options.design, design, &left_out), options.num_modes);
  support::print(stdout, "{}",
                 options.json ? format_sensitivity_json(design, sensitivity, left_out)
                              : format_sensitivity(design, sensitivity) + format_left_out(left_out));
  return support::kGood;
}

int run_sweep(const SweepCommand& command) {
  const SweepOptions options = read_sweep(command);
  const std::vector<SweepPoint> points = calc_sweep(options);
  support::print(stdout, "{}",
                 command.json ? format_sweep_json(options, points) : format_sweep(options, points));
  return support::kGood;
}

int run_matrices(const MatricesOptions& options) {
  const Design design = read_design(options.design);
  for (const std::filesystem::path& path : write_frame_matrices(design, options.design.path, options.prefix))
    support::print(stdout, "{}\n", path.string());
  return support::kGood;
}

}  // namespace sprung::reduce
