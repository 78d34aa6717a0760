#include "dynamics/adaptivity/mode_adaptation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "dynamics/adaptivity/mode_change_ringing.h"

namespace sprung::dynamics {

namespace {

// Of the recall threshold: sum of the shares of modes that leave at once.
constexpr double kLeaveTogether = 0.4;
constexpr double kPeriodsToStay = 3.0;
constexpr double kRinging = 0.1;  // of the recall threshold: share that a change may leave ringing

}  // namespace

ModeAdaptation::ModeAdaptation(const AdaptivityOptions& options, const dynamics::State& start)
    : options_(options),
      indicator_(*options.full, start.time, start.q, options.points, options.linearised),
      active_(options.active),
      windows_(indicator_.num_modes()),
      last_change_(start.time) {
  if (active_.size() != static_cast<std::size_t>(options.full->num_coordinates)) {
    throw std::invalid_argument(
        "ModeAdaptation: active must have an entry for each coordinate of the full model");
  }
  indicator_.set_active(active_);
  if (options.continues) indicator_.continue_run();
  if (!options.changes && !options.missing.is_balanced) indicator_.begin_at_rest();
}

int ModeAdaptation::num_active_modes() const {
  const std::vector<int>& modal = indicator_.modal_coordinates();
  return static_cast<int>(std::count_if(modal.begin(), modal.end(),
                                        [this](int i) { return active_[static_cast<std::size_t>(i)]; }));
}

void ModeAdaptation::update(double time, const ConstrainedEquations& run, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot) {
  indicator_.update(time, run, q, v, v_dot);
  const std::vector<int>& modal = indicator_.modal_coordinates();
  for (std::size_t j = 0; j < modal.size(); ++j) {
    const double eta = q[modal[j]], acceleration = std::abs(v_dot[modal[j]]);
    if (!indicator_.active()[j]) continue;
    std::optional<Window>& window = windows_[j];
    if (!window) window = {time, eta, eta, acceleration, 0.0};
    window->low = std::min(window->low, eta);
    window->high = std::max(window->high, eta);
    window->largest_acceleration = std::max(window->largest_acceleration, acceleration);
    window->share =
        indicator_.calc_share(j, {window->high - window->low, window->largest_acceleration}).worst();
    if (window->share > options_.thresholds.drop) window = {time, eta, eta, acceleration, window->share};
  }
}

bool ModeAdaptation::misses_any() const {
  double square = 0.0;
  for (std::size_t j = 0; j < indicator_.num_modes(); ++j) {
    const double share = indicator_.calc_neglected(j).worst();
    square += share * share;
  }
  return square > options_.thresholds.recall * options_.thresholds.recall;
}

std::vector<int> ModeAdaptation::find_missed(const std::vector<ModeAmplitude>& largest) const {
  std::vector<std::pair<double, int>> left_out;
  for (const int coordinate : indicator_.modal_coordinates()) {
    if (!active_[static_cast<std::size_t>(coordinate)])
      left_out.emplace_back(share_of(coordinate, largest).worst(), coordinate);
  }
  std::sort(left_out.begin(), left_out.end());
  // The smallest stay out as long as they come to less than the threshold together.
  double square = 0.0;
  auto first = left_out.begin();
  while (first != left_out.end() &&
         (square += first->first * first->first) <= options_.thresholds.recall * options_.thresholds.recall)
    ++first;
  std::vector<int> missed;
  for (; first != left_out.end(); ++first) missed.push_back(first->second);
  std::sort(missed.begin(), missed.end());
  return missed;
}

std::vector<int> ModeAdaptation::find_idle() const {
  std::vector<int> idle;
  if (indicator_.time() - last_change_ < options_.thresholds.residence) return idle;
  std::vector<std::pair<double, int>> candidates;
  for (std::size_t j = 0; j < indicator_.num_modes(); ++j) {
    if (!indicator_.active()[j] || !windows_[j]) continue;
    const double frequency = indicator_.calc_frequency(j);
    const double stay =
        std::max(options_.thresholds.residence, frequency > 0.0 ? kPeriodsToStay / frequency : 0.0);
    if (indicator_.time() - windows_[j]->since >= stay) {
      candidates.emplace_back(windows_[j]->share, indicator_.modal_coordinates()[j]);
    }
  }
  // The motion that they stop together must not make others join.
  std::sort(candidates.begin(), candidates.end());
  double sum = 0.0;
  for (const auto& [share, coordinate] : candidates) {
    sum += share;
    if (sum > kLeaveTogether * options_.thresholds.recall) break;
    idle.push_back(coordinate);
  }
  std::sort(idle.begin(), idle.end());
  return idle;
}

std::vector<int> ModeAdaptation::find_stoppable(const std::vector<int>& idle,
                                                const Eigen::VectorXd& v) const {
  const std::vector<double> shares = calc_stopping_shares(indicator_, idle, v);
  std::vector<std::pair<double, int>> candidates;
  for (std::size_t k = 0; k < idle.size(); ++k) candidates.emplace_back(shares[k], idle[k]);
  std::sort(candidates.begin(), candidates.end());
  std::vector<int> stoppable;
  double square = 0.0;
  for (const auto& [share, coordinate] : candidates) {
    square += share * share;
    if (std::sqrt(square) > kRinging * options_.thresholds.recall) break;
    stoppable.push_back(coordinate);
  }
  std::sort(stoppable.begin(), stoppable.end());
  return stoppable;
}

ModeShare ModeAdaptation::share_of(int coordinate, const std::vector<ModeAmplitude>& largest) const {
  const std::size_t mode = indicator_.mode_of(coordinate);
  return indicator_.calc_share(mode, largest[mode]);
}

double ModeAdaptation::held_force_of(int coordinate) const {
  return indicator_.held_force(indicator_.mode_of(coordinate));
}
double ModeAdaptation::frequency_of(int coordinate) const {
  return indicator_.calc_frequency(indicator_.mode_of(coordinate));
}

void ModeAdaptation::activate(const std::vector<int>& coordinates) {
  last_change_ = indicator_.time();
  for (const int i : coordinates) active_[static_cast<std::size_t>(i)] = true;
  indicator_.set_active(active_);
}

double ModeAdaptation::calc_fading_time(const std::vector<int>& coordinates,
                                        const std::vector<double>& forces) const {
  return calc_release_time(indicator_, coordinates, forces, kRinging * options_.thresholds.recall,
                           options_.thresholds.residence);
}

void ModeAdaptation::deactivate(const std::vector<int>& coordinates) {
  last_change_ = indicator_.time();
  for (const int i : coordinates) {
    active_[static_cast<std::size_t>(i)] = false;
    windows_[indicator_.mode_of(i)].reset();
  }
  indicator_.set_active(active_);
}

void ModeAdaptation::get_state(State& state) const {
  state.indicator = indicator_.state();
  state.windows = windows_;
}

void ModeAdaptation::set_state(const State& state) {
  indicator_.set_state(state.indicator);
  windows_ = state.windows;
}

template <class Bytes, class Adaptation>
void ModeAdaptation::transfer(Bytes& bytes, Adaptation& adaptation) {
  bytes.transfer(adaptation.active_);
  bytes.transfer(adaptation.last_change_);
  bytes.transfer_items(adaptation.windows_, [&](auto& window) {
    bool has_begun = window.has_value();
    bytes.transfer(has_begun);
    if (!has_begun) return;
    Window values = window.value_or(Window{});
    for (double* value :
         {&values.since, &values.low, &values.high, &values.largest_acceleration, &values.share})
      bytes.transfer(*value);
    if constexpr (!std::is_const_v<std::remove_reference_t<decltype(window)>>) window = values;
  });
}

void ModeAdaptation::save(support::ByteWriter& bytes) const {
  transfer(bytes, *this);
  indicator_.save(bytes);
}

void ModeAdaptation::restore(support::ByteReader& bytes) {
  transfer(bytes, *this);
  const auto num_coordinates = static_cast<std::size_t>(options_.full->num_coordinates);
  if (active_.size() != num_coordinates || windows_.size() != indicator_.num_modes())
    throw support::DamagedBytes();
  indicator_.set_active(active_);
  indicator_.restore(bytes);
}

}  // namespace sprung::dynamics
