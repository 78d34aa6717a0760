#include "dynamics/functions/detail_lengths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace sprung::dynamics {

namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kEqualLengths = 1e-6;  // relative difference that counts as rounding of the times
// A detail ahead is approached by this share of the way to it. Some methods take steps 2.3 times as long as
// they are allowed here, because they evaluate within the step: these still end before the detail.
constexpr double kApproachShare = 0.4;

}  // namespace

void DetailLengths::add(double start, double length) {
  const double before = lengths_.back();
  if (length == before || std::abs(length - before) <= kEqualLengths * std::min(length, before)) return;
  starts_.push_back(start);
  lengths_.push_back(length);
}

DetailLengths DetailLengths::between(std::span<const double> times) {
  DetailLengths details;
  for (std::size_t i = 1; i < times.size(); ++i) details.add(times[i - 1], times[i] - times[i - 1]);
  details.add(times.back(), kForever);
  return details;
}

DetailLengths DetailLengths::shorter(const DetailLengths& a, const DetailLengths& b) {
  DetailLengths both(std::min(a.lengths_.front(), b.lengths_.front()));
  std::size_t i = 0, j = 0;
  while (i < a.starts_.size() || j < b.starts_.size()) {
    const double next_a = i < a.starts_.size() ? a.starts_[i] : kForever;
    const double next_b = j < b.starts_.size() ? b.starts_[j] : kForever;
    if (next_a <= next_b) ++i;
    if (next_b <= next_a) ++j;
    both.add(std::min(next_a, next_b), std::min(a.lengths_[i], b.lengths_[j]));
  }
  return both;
}

DetailLengths DetailLengths::join(std::span<const double> ends, std::span<const DetailLengths> parts) {
  DetailLengths joined(parts.front().lengths_.front());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const double from = k == 0 ? -kForever : ends[k - 1], to = k == ends.size() ? kForever : ends[k];
    const DetailLengths& part = parts[k];
    const auto inside = std::upper_bound(part.starts_.begin(), part.starts_.end(), from);
    auto i = static_cast<std::size_t>(inside - part.starts_.begin());
    if (k > 0) joined.add(from, part.lengths_[i]);
    for (; i < part.starts_.size() && part.starts_[i] < to; ++i)
      joined.add(part.starts_[i], part.lengths_[i + 1]);
  }
  return joined;
}

double DetailLengths::shortest() const {
  return *std::min_element(lengths_.begin(), lengths_.end());
}

double DetailLengths::calc_longest_step(double time) const {
  const auto ahead = std::upper_bound(starts_.begin(), starts_.end(), time);
  auto i = static_cast<std::size_t>(ahead - starts_.begin());
  double longest = lengths_[i];
  for (; i < starts_.size(); ++i) {
    const double way = kApproachShare * (starts_[i] - time);
    if (way >= longest) break;
    longest = std::min(longest, std::max(way, lengths_[i + 1]));
  }
  return longest;
}

}  // namespace sprung::dynamics
