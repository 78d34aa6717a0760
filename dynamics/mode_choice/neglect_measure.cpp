#include "dynamics/mode_choice/neglect_measure.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "dynamics/mode_choice/small_sets.h"
#include "dynamics/mode_choice/thinned_lines.h"

namespace sprung::dynamics {

namespace {

using Kind = WatchedQuantity::Kind;

constexpr double kLongestSettling = 20.0;  // s
constexpr double kHighest = 1.5;  // end of the search for the highest line, of the vehicle's frequencies
constexpr double kRoughSpacing = 0.02;  // of lines in this search, relative to their frequency
constexpr double kRoughSampling = 2.0;  // fineness of the forcing in this search
constexpr Eigen::Index kMostLines = (1 << 15) - 1;
constexpr double kStatic = 0.01;  // of the lowest frequency: at this frequency the response is static

double calc_highest_frequency(const LinearVehicle& vehicle) {
  return vehicle.solver().eigenvalues().cwiseAbs().maxCoeff() / (2.0 * std::numbers::pi);
}

// Displacements, accelerations, forces with torques, moments.
constexpr int kNumGroups = 4;

int group_of(Kind kind) {
  if (kind == Kind::kMoment) return kNumGroups - 1;
  return std::min(static_cast<int>(kind), static_cast<int>(Kind::kForce));
}

// Sizes that give quantities which are not judged the share 0.
Eigen::VectorXd set_unjudged(const WatchedQuantities& watched, Eigen::VectorXd sizes) {
  for (std::size_t i = 0; i < watched.size(); ++i) {
    if (!watched.list[i].is_judged)
      sizes[static_cast<Eigen::Index>(i)] = std::numeric_limits<double>::infinity();
  }
  return sizes;
}

// The quantity with the largest share in each group.
std::vector<std::size_t> find_largest(const WatchedQuantities& watched, const Eigen::VectorXd& shares) {
  std::vector<std::size_t> largest;
  for (int group = 0; group < kNumGroups; ++group) {
    std::size_t found = watched.size();
    for (std::size_t i = 0; i < watched.size(); ++i) {
      if (group_of(watched.list[i].kind) != group || !watched.list[i].is_judged) continue;
      const auto better = [&](std::size_t a, std::size_t b) {
        return shares[static_cast<Eigen::Index>(a)] > shares[static_cast<Eigen::Index>(b)];
      };
      if (found == watched.size() || better(i, found)) found = i;
    }
    if (found < watched.size()) largest.push_back(found);
  }
  return largest;
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
                               std::vector<int> coordinates, const KnownForcing& forcing, double cut)
    : vehicle_(&vehicle),
      watched_(&watched),
      coordinates_(std::move(coordinates)),
      speed_(forcing.speed),
      sweep_(make_held_system(vehicle, watched.outputs, {})),
      at_rest_(calc_static_response()) {
  const double settling = calc_settling_time(vehicle, kLongestSettling);
  KnownForcing active = forcing;
  active.duration = calc_forcing_duration(vehicle, forcing, settling);
  forcing_ = calc_forcing_spectrum(vehicle, active, settling, find_highest_frequency(active, settling, cut));
  calc_references();
}

double NeglectMeasure::find_highest_frequency(const KnownForcing& forcing, double settling, double cut) {
  const ForcingSpectrum rough = calc_forcing_spectrum(
      *vehicle_, forcing, settling, kHighest * calc_highest_frequency(*vehicle_), kRoughSampling);
  const HarmonicInputs inputs(*vehicle_, watched_->outputs, rough, forcing.speed);
  const ThinnedLines thinned = thin_lines(inputs.calc_amplitudes(rough), kRoughSpacing);
  const auto w = static_cast<Eigen::Index>(watched_->size());
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(w, static_cast<Eigen::Index>(thinned.size()));
  HarmonicInputs::Gains gains;
  for (std::size_t k = 0; k < thinned.size(); ++k) {
    const double frequency = rough.frequency(thinned.lines[k]), omega = 2.0 * std::numbers::pi * frequency;
    inputs.calc_gains(frequency, gains);
    const RowsXcd states =
        sweep_.calc_states(Eigen::VectorXd::Constant(1, omega), sweep_.project(gains.forces));
    const Eigen::MatrixXcd outputs = multiply_real_complex(sweep_.state_outputs(), states) + gains.direct;
    const Eigen::VectorXd powers = calc_powers(outputs, thinned.powers[k]);
    for (Eigen::Index i = 0; i < w; ++i) {
      const WatchedQuantity& quantity = watched_->list[static_cast<std::size_t>(i)];
      const double factor = calc_factor(quantity, omega);
      squares(i, static_cast<Eigen::Index>(k)) = factor * factor * powers(quantity.rows).sum();
    }
  }
  const Eigen::VectorXd sizes = set_unjudged(
      *watched_,
      apply_lower_bounds(*watched_, squares.rowwise().sum().cwiseSqrt(), vehicle_->model().length_scale));
  const double most = static_cast<double>(kMostLines) / rough.period;
  Eigen::VectorXd above = Eigen::VectorXd::Zero(w);
  double highest = rough.frequency(0);
  for (std::size_t k = thinned.size(); k-- > 0;) {
    const double end = rough.frequency(thinned.ends[k] - 1);
    const Eigen::VectorXd more = above + squares.col(static_cast<Eigen::Index>(k));
    const double share = calc_shares(more.cwiseSqrt(), sizes).maxCoeff();
    if (share > cut && end <= most) {
      highest = end;
      break;
    }
    share_above_ = share;
    above = more;
  }
  is_cut_short_ = share_above_ > cut;
  return highest;
}

HeldResponse NeglectMeasure::calc_static_response() const {
  const Eigen::VectorXcd eigenvalues = vehicle_->solver().eigenvalues();
  const double largest = eigenvalues.cwiseAbs().maxCoeff();
  double lowest = largest;
  for (const std::complex<double>& s : eigenvalues) {
    if (std::abs(s) > 1e-6 * largest) lowest = std::min(lowest, std::abs(s));
  }
  const HeldResponseSolver solver(*vehicle_, watched_->outputs, coordinates_);
  HeldResponse response =
      solver.solve(kStatic * lowest, Eigen::VectorXcd::Zero(vehicle_->model().num_coordinates),
                   Eigen::VectorXcd::Zero(vehicle_->channel_rows().back()));
  response.amplitudes = vehicle_->positions()(coordinates_).cast<std::complex<double>>();
  return response;
}

void NeglectMeasure::calc_references() {
  const Eigen::Index m = forcing_.num_lines();
  inputs_.emplace(*vehicle_, watched_->outputs, forcing_, speed_);
  amplitudes_ = inputs_->calc_amplitudes(forcing_);
  omega_ =
      (2.0 * std::numbers::pi / forcing_.period) * Eigen::VectorXd::LinSpaced(m, 1.0, static_cast<double>(m));
  forces_.resize(vehicle_->system().mass.rows(), m);
  whole_.resize(watched_->outputs.size(), m);
  HarmonicInputs::Gains gains;
  for (Eigen::Index line = 0; line < m; ++line) {
    inputs_->calc_gains(forcing_.frequency(line), gains);
    forces_.col(line) = gains.forces * amplitudes_.col(line);
    whole_.col(line) = gains.direct * amplitudes_.col(line);
  }
  outputs_ = sweep_.respond(omega_, forces_);
  whole_ += outputs_;
  const QuantitySizes sizes = calc_sizes(*watched_, whole_, omega_);

  std::vector<int> all(coordinates_.size());
  std::iota(all.begin(), all.end(), 0);
  // The effect of the weight refers to the largest one on any quantity of the kind, because the effects of
  // the modes may cancel at a point.
  const Eigen::VectorXcd flexible = calc_change(at_rest_, all);
  std::array<double, WatchedQuantity::kNumKinds> bending{};
  for (const WatchedQuantity& quantity : watched_->list) {
    double& largest = bending[static_cast<std::size_t>(quantity.kind)];
    largest = std::max(largest, calc_static_size(quantity, flexible));
  }
  weight_ = sizes.peak;
  for (std::size_t i = 0; i < watched_->size(); ++i) {
    double& weight = weight_[static_cast<Eigen::Index>(i)];
    weight = std::max(weight, bending[static_cast<std::size_t>(watched_->list[i].kind)]);
  }
  const double length = vehicle_->model().length_scale;
  is_excited_ = sizes.rms.size() > 0 && sizes.rms.maxCoeff() > 0.0;
  rms_ = set_unjudged(*watched_, apply_lower_bounds(*watched_, sizes.rms, length));
  peak_ = set_unjudged(*watched_, apply_lower_bounds(*watched_, sizes.peak, length));
  weight_ = set_unjudged(*watched_, apply_lower_bounds(*watched_, weight_, length));
}

Eigen::VectorXd NeglectMeasure::calc_static_shares(const std::vector<int>& set) const {
  const Eigen::VectorXcd change = calc_change(at_rest_, set);
  Eigen::VectorXd sizes(weight_.size());
  for (Eigen::Index i = 0; i < sizes.size(); ++i) {
    sizes[i] = calc_static_size(watched_->list[static_cast<std::size_t>(i)], change);
  }
  return calc_shares(sizes, weight_);
}

std::vector<int> NeglectMeasure::find_coordinates(const std::vector<int>& set) const {
  std::vector<int> coordinates;
  for (const int mode : set) coordinates.push_back(coordinates_[static_cast<std::size_t>(mode)]);
  return coordinates;
}

NeglectedShares NeglectMeasure::measure(const std::vector<int>& set) const {
  const HarmonicSweep sweep(make_held_system(*vehicle_, watched_->outputs, find_coordinates(set)));
  const QuantitySizes sizes = calc_sizes(*watched_, sweep.respond(omega_, forces_) - outputs_, omega_);
  return {calc_shares(sizes.rms, rms_), calc_shares(sizes.peak, peak_), calc_static_shares(set)};
}

std::vector<NeglectedShares> NeglectMeasure::measure_alone(const std::vector<std::vector<int>>& sets) const {
  const SmallSets modes({*vehicle_, *watched_, *inputs_, amplitudes_, omega_}, coordinates_);
  const std::vector<QuantitySizes> sizes = modes.measure(
      sets, [&](const Eigen::VectorXd& rms) { return find_largest(*watched_, calc_shares(rms, rms_)); });
  std::vector<NeglectedShares> shares;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    shares.push_back(
        {calc_shares(sizes[i].rms, rms_), calc_shares(sizes[i].peak, peak_), calc_static_shares(sets[i])});
  }
  return shares;
}

NonlinearForces NeglectMeasure::calc_nonlinear_forces() const {
  const double wanted = kHighest * calc_highest_frequency(*vehicle_) * forcing_.period;
  const auto lines =
      std::min(static_cast<Eigen::Index>(std::min(wanted, static_cast<double>(kMostLines))), kMostLines);
  return dynamics::calc_nonlinear_forces(*vehicle_, omega_, forces_, std::max(lines, omega_.size()));
}

NeglectedShares NeglectMeasure::measure_beyond_linear(const std::vector<int>& set,
                                                      const NonlinearForces& forces) const {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(watched_->size()));
  if (forces.elements.empty()) return {none, none, none};
  const HarmonicSweep sweep(make_held_system(*vehicle_, watched_->outputs, find_coordinates(set)));
  const RowsXcd change =
      sweep.respond(forces.omega, forces.forces) - sweep_.respond(forces.omega, forces.forces);
  const QuantitySizes sizes = calc_sizes(*watched_, change, forces.omega);
  return {calc_shares(sizes.rms, rms_), calc_shares(sizes.peak, peak_), none};
}

double NeglectMeasure::find_lowest(int row) const {
  const auto num_times =
      static_cast<Eigen::Index>(std::bit_ceil(static_cast<std::size_t>(2 * whole_.cols() + 1)));
  return calc_history(whole_.row(row), num_times).minCoeff();
}

RowsXcd NeglectMeasure::calc_wave_response(const std::vector<Eigen::Index>& lines) const {
  Eigen::MatrixXcd forces(forces_.rows(), static_cast<Eigen::Index>(lines.size()));
  RowsXcd direct(outputs_.rows(), forces.cols());
  HarmonicInputs::Gains gains;
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    const double frequency = forcing_.frequency(lines[static_cast<std::size_t>(i)]);
    inputs_->calc_gains(frequency, gains);
    const Eigen::VectorXcd wave = inputs_->calc_wave(frequency);
    forces.col(i) = gains.forces * wave;
    direct.col(i) = gains.direct * wave;
  }
  return sweep_.respond(omega_(lines), forces) + direct;
}

}  // namespace sprung::dynamics
