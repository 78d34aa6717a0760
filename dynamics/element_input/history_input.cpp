#include "dynamics/element_input/history_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "tools/support/files/read_text_file.h"

namespace sprung::dynamics {

namespace {

constexpr double kShortestSpacing = 1e-9;  // s
constexpr double kLargestValue = 1e15;     // in SI units, so that slopes and curvatures are finite
constexpr double kRoundedTime = 1e-9;      // s
constexpr double kCloseSamples = 0.1;      // of the mean distance
constexpr double kWideSwing = 1.0;         // of the range of the samples

struct Samples {
  std::vector<double> time, value;  // [s], in the channel's unit
  Signal channel;
};

std::size_t find_channel(const support::TomlValue& wanted, std::span<const Signal> signals) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i].name != wanted.string()) continue;
    if (found) {
      throw wanted.error(
          fmt::format("is the name of the channels {} and {} of the file; write CHAN_{} or CHAN_{}",
                      *found + 1, i + 1, *found + 1, i + 1));
    }
    found = i;
  }
  if (found) return *found;
  std::vector<std::string> names;
  for (const Signal& signal : signals) names.push_back(signal.name);
  throw wanted.error(fmt::format("is in no column or channel of the file, '{}'{}; it has {}", wanted.string(),
                                 support::nearest_name_hint(wanted.string(), names), list_names(signals)));
}

// The factor to SI units.
double find_factor(const support::TomlValue& at, const std::string& unit, std::string_view si_unit,
                   std::string_view advice) {
  if (unit.empty()) return 1.0;
  const std::optional<KnownUnit> known = find_unit(unit);
  if (known && (si_unit.empty() || known->si_unit == si_unit)) return known->factor;
  throw at.error(fmt::format("is in '{}', expected one of {}{}", unit, list_units(si_unit), advice));
}

Samples read_samples(const ColumnFile& file, const support::TomlTable& table) {
  const std::optional<support::TomlValue> wanted_time = table.find("time");
  const std::size_t time = wanted_time ? find_channel(*wanted_time, file.columns()) : 0;
  const std::size_t channel = find_channel(table.at("channel"), file.columns());
  if (channel == time) throw table.at("channel").error("must not be the column of the times");
  Samples samples{file.read_column(time), file.read_column(channel), file.columns()[channel]};
  const Signal& clock = file.columns()[time];
  const double factor = find_factor(wanted_time.value_or(table.at("file")), clock.unit, "s",
                                    ", as it is the column of the times");
  for (double& t : samples.time) t *= factor;
  for (std::size_t i = 1; i < samples.time.size(); ++i) {
    if (samples.time[i] - samples.time[i - 1] >= kShortestSpacing) continue;
    throw support::InputError(
        file.locate(time, i),
        fmt::format("'{}' must ascend by at least {:g} s, got {:.12g} s after {:.12g} s", clock.name,
                    kShortestSpacing, samples.time[i], samples.time[i - 1]));
  }
  return samples;
}

// CHAN_1, CHAN_2, … name the channels as well.
Samples read_samples(const Rpc3File& file, const support::TomlTable& table) {
  if (const std::optional<support::TomlValue> time = table.find("time")) {
    throw time->error("must be left out: an RPC III file has equal time steps");
  }
  const support::TomlValue wanted = table.at("channel");
  std::size_t channel = file.channels().size();
  for (std::size_t i = 0; i < file.channels().size(); ++i) {
    if (wanted.string() == fmt::format("CHAN_{}", i + 1)) channel = i;
  }
  for (std::size_t i = 0; i < file.channels().size() && channel < file.channels().size(); ++i) {
    if (i == channel || file.channels()[i].name != wanted.string()) continue;
    throw wanted.error(
        fmt::format("is channel {} by its number, but also the name of channel {}", channel + 1, i + 1));
  }
  if (channel == file.channels().size()) channel = find_channel(wanted, file.channels());
  Samples samples{{}, file.read_channel(channel), file.channels()[channel]};
  for (std::size_t i = 0; i < samples.value.size(); ++i) {
    samples.time.push_back(static_cast<double>(i) * file.time_step());
  }
  if (samples.time.size() < 2 || !(file.time_step() >= kShortestSpacing)) {
    throw wanted.error(fmt::format("must have at least 2 samples, {:g} s apart or more; got {}, {:g} s apart",
                                   kShortestSpacing, samples.time.size(), file.time_step()));
  }
  return samples;
}

void read_outside(const support::TomlTable& table, std::string_view key, std::string_view unit,
                  std::string& outside) {
  constexpr std::string_view kHold = "hold";
  const std::optional<support::TomlValue> value = table.find(key);
  if (!value) return;
  if (!value->is_number() && value->string() != kHold)
    throw value->error(fmt::format("must be \"hold\" or a number, got '{}'", value->string()));
  outside = value->is_number() ? fmt::format("{}", value->number(support::any(unit))) : std::string(kHold);
}

// Takes the samples from the unit of the history to that of the function.
void scale_samples(const support::TomlTable& table, std::string_view unit, const HistoryUse& history,
                   std::vector<double>& values) {
  const support::TomlValue place = table.has("unit") ? table.at("unit") : table.at("channel");
  const double factor = find_factor(place, history.unit, unit, "; 'unit' says in which unit to take it");
  for (double& value : values) {
    value = history.offset + history.scale * (factor * value);
    if (std::abs(value) <= kLargestValue) continue;
    throw table.error(fmt::format("must stay within ±{:g} {}, got {:g}", kLargestValue, unit, value));
  }
}

// Moves the samples to their times in the run. Late times are rounded, so that samples may fall into one.
void place_samples(const support::TomlTable& table, HistoryUse& history, std::vector<double>& times) {
  const std::optional<support::TomlValue> start = table.find("start");
  const double shift = start ? start->number(support::any("s")) - times.front() : 0.0;
  for (double& time : times) time += shift;
  history.shortest_spacing = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool ascends = i == 0 || times[i] > times[i - 1];
    if (!ascends || !(std::abs(times[i]) <= kLargestValue)) {
      throw table.error(fmt::format("must have times that ascend, within ±{:g} s, got {:.17g} s in sample {}",
                                    kLargestValue, times[i], i + 1));
    }
    if (i > 0) history.shortest_spacing = std::min(history.shortest_spacing, times[i] - times[i - 1]);
  }
  history.from = times.front();
  history.to = times.back();
  history.mean_spacing = (history.to - history.from) / static_cast<double>(times.size() - 1);
}

// Replaces the constants outside of the samples by the numbers that are asked for.
TimeFunction replace_outside(const TimeFunction& f, const HistoryUse& use) {
  const auto outside = [](const std::string& text, const TimeFunction& held) {
    const std::optional<double> number = parse_number(text);
    return number ? TimeFunction(*number) : held;
  };
  const std::array ends{use.from, use.to};
  if (!parse_number(use.before) && !parse_number(use.after)) return f;
  return TimeFunction::pieces(ends, std::array{outside(use.before, f), f, outside(use.after, f)});
}

// Between two samples a cubic that swings out is far out in the middle, too.
double calc_swing(const TimeFunction& curve, const Samples& samples) {
  const auto [least, greatest] = std::minmax_element(samples.value.begin(), samples.value.end());
  double beyond = 0.0;
  for (std::size_t i = 1; i < samples.time.size(); ++i) {
    const double between = curve.value(0.5 * (samples.time[i - 1] + samples.time[i]));
    beyond = std::max({beyond, *least - between, between - *greatest});
  }
  return *greatest > *least ? beyond / (*greatest - *least) : 0.0;
}

bool has_close_samples(const HistoryUse& history) {
  return history.shortest_spacing < kCloseSamples * history.mean_spacing;
}

// The times of a run at which a history counts.
struct Need {
  Need(const HistoryUse& history, double run_end)
      : from(history.needed_from), to(std::min(run_end, history.needed_to)) {}
  bool exists() const { return from <= to; }
  double from, to;
};

}  // namespace

const HistoryFiles::File& HistoryFiles::open(const support::TomlValue& file) {
  const std::filesystem::path path = folder_ / file.string();
  std::unique_ptr<File>& known = files_[path.string()];
  if (known) return *known;
  if (!support::is_regular_file(path)) {
    throw file.error(fmt::format("names no file, {}", path.string()));
  }
  known = std::make_unique<File>(Rpc3File::is_one(path) ? File(Rpc3File::read(path))
                                                        : File(ColumnFile::read(path)));
  return *known;
}

TimeFunction HistoryFiles::read(const support::TomlTable& table, std::string_view unit, TimeFunctionUse use) {
  static const std::array<std::string, 2> kInterpolations{"linear", "smooth"};
  HistoryUse history;
  history.key = table.key();
  history.location = table.location();
  history.file = table.string("file");
  history.interpolation = kInterpolations[use == TimeFunctionUse::kMotion ? 1 : 0];
  if (const auto wanted = table.find("interpolation"))
    history.interpolation = wanted->one_of(kInterpolations);
  history.scale = table.number_or("scale", 1.0, support::any(""));
  history.offset = table.number_or("offset", 0.0, support::any(unit));
  read_outside(table, "before", unit, history.before);
  read_outside(table, "after", unit, history.after);
  const std::optional<support::TomlValue> wanted_unit = table.find("unit");
  for (const char* known : {"channel", "time", "start"}) table.find(known);  // they are read with the file
  table.reject_unknown_keys();

  const File& file = open(table.at("file"));
  Samples samples = std::visit([&](const auto& one) { return read_samples(one, table); }, file);
  history.hash = std::visit([](const auto& one) { return one.hash(); }, file);
  history.channel = samples.channel.name;
  history.file_unit = samples.channel.unit;
  history.unit = wanted_unit ? wanted_unit->string() : samples.channel.unit;
  if (const std::optional<KnownUnit> known = find_unit(history.unit)) history.si_unit = known->si_unit;
  scale_samples(table, unit, history, samples.value);
  place_samples(table, history, samples.time);
  const bool is_smooth = history.interpolation == kInterpolations[1];
  const TimeFunction f = is_smooth ? TimeFunction::spline(samples.time, samples.value)
                                   : TimeFunction::lines(samples.time, samples.value);
  if (is_smooth && has_close_samples(history)) history.swing = calc_swing(f, samples);
  used_.push_back(history);
  return replace_outside(f, history);
}

void HistoryFiles::limit(std::size_t first, double from, double to) {
  for (std::size_t i = first; i < used_.size(); ++i) {
    used_[i].needed_from = std::max(used_[i].needed_from, from);
    used_[i].needed_to = std::min(used_[i].needed_to, to);
  }
}

void check_histories(std::span<const HistoryUse> histories, double to) {
  for (const HistoryUse& history : histories) {
    const Need need(history, to);
    if (!need.exists()) continue;
    const bool begins_late = history.before.empty() && history.from > need.from + kRoundedTime;
    const bool ends_early = history.after.empty() && history.to < need.to - kRoundedTime;
    if (!begins_late && !ends_early) continue;
    throw support::InputError(
        history.location,
        fmt::format(
            "'{}' is known from {:.9g} s to {:.9g} s, but is needed {}; say by '{}' what holds there, "
            "\"hold\" or a number",
            history.key, history.from, history.to,
            begins_late ? fmt::format("from {:.9g} s on", need.from) : fmt::format("until {:.9g} s", need.to),
            begins_late ? "before" : "after"));
  }
}

std::vector<std::string> list_history_remarks(std::span<const HistoryUse> histories, double to) {
  std::vector<std::string> remarks;
  const auto describe = [](const std::string& outside, const char* held) {
    return outside == "hold" ? fmt::format("its {} value holds", held) : fmt::format("{} holds", outside);
  };
  for (const HistoryUse& history : histories) {
    const Need need(history, to);
    if (need.exists() && history.from > need.from + kRoundedTime) {
      remarks.push_back(fmt::format("{}: '{}' begins at {:.9g} s; until then {}",
                                    support::format_place(history.location), history.key, history.from,
                                    describe(history.before, "first")));
    }
    if (need.exists() && history.to < need.to - kRoundedTime) {
      remarks.push_back(fmt::format("{}: '{}' ends at {:.9g} s, {} at {:.9g} s; from then on {}",
                                    support::format_place(history.location), history.key, history.to,
                                    need.to < to ? "its piece" : "the run", need.to,
                                    describe(history.after, "last")));
    }
    if (!history.file_unit.empty() && history.unit != history.file_unit) {
      remarks.push_back(fmt::format("{}: '{}' is taken in {}, but its file gives it in {}",
                                    support::format_place(history.location), history.key,
                                    history.unit.empty() ? "SI units" : history.unit, history.file_unit));
    }
    if (history.interpolation == "smooth" && has_close_samples(history)) {
      remarks.push_back(fmt::format(
          "{}: '{}' has samples {:.3g} s apart, where the mean is {:.3g} s: steps near them are no "
          "longer",
          support::format_place(history.location), history.key, history.shortest_spacing,
          history.mean_spacing));
    }
    if (history.swing > kWideSwing) {
      remarks.push_back(
          fmt::format("{}: '{}' swings out beyond its samples by {:.3g} times their range, between samples "
                      "that are further apart than those beside them; a smooth curve needs samples "
                      "whose distances change little by little",
                      support::format_place(history.location), history.key, history.swing));
    }
  }
  return remarks;
}

}  // namespace sprung::dynamics
