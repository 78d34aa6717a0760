#include "dynamics/analysis/neglect_measure.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <utility>

namespace sprung::dynamics {

namespace {

using Kind = WatchedQuantity::Kind;

constexpr double kLongestSettling = 20.0;    // s
constexpr double kHighest = 1.5;             // frequencies looked at, of the vehicle's highest
constexpr Eigen::Index kMostLines = 1 << 12;
constexpr Eigen::Index kEveryLine = 1000;    // up to here the search for the highest line looks at each, then at
                                             // every second, third, …
constexpr std::size_t kMostValues = 1 << 24; // complex numbers held at once
constexpr double kLeastSize = 0.01;          // of the largest quantity of its kind
constexpr double kRounding = 1e-6;           // torque that is none, of force times length
constexpr double kStatic = 0.01;             // of the lowest frequency: slow enough to be static

double omega_of(const ForcingSpectrum& forcing, Eigen::Index line) {
  return 2.0 * std::numbers::pi * forcing.frequency(line);
}

double calc_highest_frequency(const LinearVehicle& vehicle) {
  return vehicle.solver().eigenvalues().cwiseAbs().maxCoeff() / (2.0 * std::numbers::pi);
}

// Σ of squares of a quantity's rows.
double square(const WatchedQuantity& quantity, const Eigen::VectorXcd& outputs, double omega) {
  const double factor = quantity.kind == Kind::kAcceleration ? omega * omega : 1.0;
  double sum = 0.0;
  for (const int row : quantity.rows) sum += std::norm(factor * outputs[row]);
  return sum;
}

// Sizes of small quantities raised to a share of the largest of the same kind.
Eigen::VectorXd raise(const WatchedQuantities& watched, Eigen::VectorXd sizes, double length) {
  std::array<double, 4> largest{};
  for (std::size_t i = 0; i < watched.size(); ++i) {
    double& one = largest[static_cast<std::size_t>(watched.list[i].kind)];
    one = std::max(one, sizes[static_cast<Eigen::Index>(i)]);
  }
  double& torque = largest[static_cast<std::size_t>(Kind::kTorque)];
  torque = std::max(torque, kRounding / kLeastSize * length * largest[static_cast<std::size_t>(Kind::kForce)]);
  for (std::size_t i = 0; i < watched.size(); ++i) {
    double& size = sizes[static_cast<Eigen::Index>(i)];
    size = std::max(size, kLeastSize * largest[static_cast<std::size_t>(watched.list[i].kind)]);
  }
  return sizes;
}

Eigen::VectorXd divide(const Eigen::VectorXd& change, const Eigen::VectorXd& size) {
  return change.binaryExpr(size, [](double a, double b) { return b > 0.0 ? a / b : 0.0; });
}

}  // namespace

NeglectedShares::Worst NeglectedShares::worst() const {
  Worst worst;
  const auto consider = [&](const Eigen::VectorXd& shares, const char* measure) {
    for (Eigen::Index i = 0; i < shares.size(); ++i) {
      if (shares[i] > worst.value) worst = {shares[i], static_cast<std::size_t>(i), measure};
    }
  };
  consider(rms, "r.m.s.");
  consider(peak, "peak");
  consider(weight, "static");
  return worst;
}

NeglectMeasure::NeglectMeasure(const LinearVehicle& vehicle, const WatchedQuantities& watched,
                               std::vector<int> coordinates, const KnownForcing& forcing, double accuracy)
    : vehicle_(&vehicle),
      watched_(&watched),
      coordinates_(std::move(coordinates)),
      speed_(forcing.speed),
      solver_(vehicle, watched.outputs, coordinates_),
      forcing_(calc_forcing_spectrum(vehicle, forcing, calc_settling_time(vehicle, kLongestSettling),
                                     kHighest * calc_highest_frequency(vehicle))) {
  choose_num_lines(accuracy);
  calc_references();
}

NeglectMeasure::Action NeglectMeasure::calc_action(Eigen::Index line) const {
  Action action{forcing_.gains * forcing_.applied.col(line),
                Eigen::VectorXcd::Zero(vehicle_->channel_rows().back())};
  if (!(speed_ > 0.0) || vehicle_->inputs().empty()) return action;
  const RoadWave wave = make_road_wave(forcing_.frequency(line), speed_);
  const RoadAction road = vehicle_->calc_road_action(wave);
  const Eigen::VectorXcd heights = forcing_.road[line] * vehicle_->calc_delays(wave);
  action.force += road.forces * heights;
  action.channels += road.channels * heights;
  return action;
}

void NeglectMeasure::choose_num_lines(double accuracy) {
  const auto w = static_cast<Eigen::Index>(watched_->size());
  std::vector<Eigen::Index> ends;                   // behind each group of lines
  std::vector<Eigen::VectorXd> squares;             // of each group
  Eigen::VectorXd total = Eigen::VectorXd::Zero(w);
  for (Eigen::Index line = 0; line < forcing_.num_lines();) {
    const Eigen::Index stride = std::min(std::max<Eigen::Index>(1, line / kEveryLine), forcing_.num_lines() - line);
    const Action action = calc_action(line);
    const double omega = omega_of(forcing_, line);
    const Eigen::VectorXcd outputs = solver_.calc_outputs(omega, action.force, action.channels);
    Eigen::VectorXd one(w);
    for (std::size_t i = 0; i < watched_->size(); ++i) {
      one[static_cast<Eigen::Index>(i)] = static_cast<double>(stride) * square(watched_->list[i], outputs, omega);
    }
    total += one;
    squares.push_back(std::move(one));
    line += stride;
    ends.push_back(line);
  }
  // From above, as long as what is left out stays small.
  Eigen::VectorXd above = Eigen::VectorXd::Zero(w);
  const Eigen::VectorXd rms = raise(*watched_, total.cwiseSqrt(), vehicle_->model().length_scale);
  const Eigen::VectorXd allowed = accuracy * accuracy * rms.cwiseAbs2();
  num_lines_ = 1;
  for (std::size_t g = ends.size(); g-- > 0;) {
    above += squares[g];
    if ((above.array() <= allowed.array()).all()) continue;
    num_lines_ = ends[g];
    break;
  }
  if (num_lines_ <= kMostLines) return;
  num_lines_ = kMostLines;
  above.setZero();
  for (std::size_t g = ends.size(); g-- > 0 && ends[g] > num_lines_;) above += squares[g];
  share_above_ = divide(above.cwiseSqrt(), rms).maxCoeff();
}

HeldResponse NeglectMeasure::calc_static_response() const {
  const Eigen::VectorXcd eigenvalues = vehicle_->solver().eigenvalues();
  const double largest = eigenvalues.cwiseAbs().maxCoeff();
  double lowest = largest;
  for (const std::complex<double>& s : eigenvalues) {
    if (std::abs(s) > 1e-6 * largest) lowest = std::min(lowest, std::abs(s));
  }
  HeldResponse response =
      solver_.solve(kStatic * lowest, Eigen::VectorXcd::Zero(vehicle_->model().num_coordinates),
                    Eigen::VectorXcd::Zero(vehicle_->channel_rows().back()));
  response.amplitudes = vehicle_->positions()(coordinates_).cast<std::complex<double>>();
  return response;
}

void NeglectMeasure::calc_references() {
  Eigen::MatrixXcd lines(watched_->outputs.size(), num_lines_);
  for (Eigen::Index line = 0; line < num_lines_; ++line) {
    const Action action = calc_action(line);
    lines.col(line) = solver_.calc_outputs(omega_of(forcing_, line), action.force, action.channels);
  }
  const Sizes sizes = calc_sizes(lines);
  std::vector<int> all(coordinates_.size());
  std::iota(all.begin(), all.end(), 0);
  const Eigen::VectorXcd flexible = calc_change(calc_static_response(), all);
  weight_ = sizes.peak;
  for (std::size_t i = 0; i < watched_->size(); ++i) {
    double& weight = weight_[static_cast<Eigen::Index>(i)];
    weight = std::max(weight, std::sqrt(square(watched_->list[i], flexible, 0.0)));
  }
  const double length = vehicle_->model().length_scale;
  rms_ = raise(*watched_, sizes.rms, length);
  peak_ = raise(*watched_, sizes.peak, length);
  weight_ = raise(*watched_, weight_, length);
}

NeglectMeasure::Sizes NeglectMeasure::calc_sizes(const Eigen::MatrixXcd& lines) const {
  const auto w = static_cast<Eigen::Index>(watched_->size());
  const auto num_times = static_cast<Eigen::Index>(std::bit_ceil(static_cast<std::size_t>(2 * lines.cols() + 1)));
  Sizes sizes{Eigen::VectorXd::Zero(w), Eigen::VectorXd::Zero(w)};
  Eigen::RowVectorXd squared_omega(lines.cols());
  for (Eigen::Index line = 0; line < lines.cols(); ++line) {
    const double omega = omega_of(forcing_, line);
    squared_omega[line] = omega * omega;
  }
  for (Eigen::Index i = 0; i < w; ++i) {
    const WatchedQuantity& quantity = watched_->list[static_cast<std::size_t>(i)];
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(num_times);
    for (const int row : quantity.rows) {
      Eigen::RowVectorXcd values = lines.row(row);
      if (quantity.kind == Kind::kAcceleration) values = -values.cwiseProduct(squared_omega);
      sizes.rms[i] += 2.0 * values.squaredNorm();
      squares += calc_history(values, num_times).cwiseAbs2();
    }
    sizes.rms[i] = std::sqrt(sizes.rms[i]);
    sizes.peak[i] = std::sqrt(squares.maxCoeff());
  }
  return sizes;
}

std::vector<NeglectedShares> NeglectMeasure::measure(const Changes& changes, std::size_t num_sets) const {
  const Eigen::Index p = watched_->outputs.size();
  const Eigen::MatrixXcd at_rest = changes(calc_static_response());
  const std::size_t at_once =
      std::max<std::size_t>(1, kMostValues / static_cast<std::size_t>(std::max<Eigen::Index>(1, p * num_lines_)));
  std::vector<NeglectedShares> shares;
  for (std::size_t first = 0; first < num_sets; first += at_once) {
    const std::size_t count = std::min(at_once, num_sets - first);
    std::vector<Eigen::MatrixXcd> lines(count, Eigen::MatrixXcd(p, num_lines_));
    for (Eigen::Index line = 0; line < num_lines_; ++line) {
      const Action action = calc_action(line);
      const Eigen::MatrixXcd change =
          changes(solver_.solve(omega_of(forcing_, line), action.force, action.channels));
      for (std::size_t i = 0; i < count; ++i) lines[i].col(line) = change.col(static_cast<Eigen::Index>(first + i));
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Sizes sizes = calc_sizes(lines[i]);
      Eigen::VectorXd weight(sizes.rms.size());
      for (Eigen::Index k = 0; k < weight.size(); ++k) {
        weight[k] = std::sqrt(square(watched_->list[static_cast<std::size_t>(k)],
                                     at_rest.col(static_cast<Eigen::Index>(first + i)), 0.0));
      }
      shares.push_back({divide(sizes.rms, rms_), divide(sizes.peak, peak_), divide(weight, weight_)});
    }
  }
  return shares;
}

std::vector<NeglectedShares> NeglectMeasure::measure(const std::vector<std::vector<int>>& sets) const {
  const auto changes = [&](const HeldResponse& response) {
    Eigen::MatrixXcd all(watched_->outputs.size(), static_cast<Eigen::Index>(sets.size()));
    for (std::size_t i = 0; i < sets.size(); ++i) {
      all.col(static_cast<Eigen::Index>(i)) = calc_change(response, sets[i]);
    }
    return all;
  };
  return measure(changes, sets.size());
}

std::vector<NeglectedShares> NeglectMeasure::measure_nested(const std::vector<int>& order,
                                                            const std::vector<int>& sizes) const {
  const auto changes = [&](const HeldResponse& response) {
    const Eigen::MatrixXcd all = calc_nested_changes(response, order);
    Eigen::MatrixXcd picked(all.rows(), static_cast<Eigen::Index>(sizes.size()));
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      picked.col(static_cast<Eigen::Index>(i)) = all.col(sizes[i] - 1);
    }
    return picked;
  };
  return measure(changes, sizes.size());
}

}  // namespace sprung::dynamics
