#include "dynamics/mode_choice/small_sets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/support/dense/dense_solvers.h"

namespace sprung::dynamics {

namespace {

constexpr double kMostSpacing = 0.02;  // of lines, relative to their frequency
constexpr double kLeastSpacing = 0.005;
constexpr double kOscillates = 0.5;           // damping ratio up to which a resonance is resolved
constexpr std::size_t kMostValues = 1 << 23;  // complex numbers in memory at once

// The watched outputs and, below them, the modal coordinates.
DrivenSystem add_amplitudes(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                            const std::vector<int>& modes) {
  DrivenSystem system = make_held_system(vehicle, outputs, {});
  const Eigen::Index p = outputs.size(), n = static_cast<Eigen::Index>(modes.size()), f = system.mass.rows();
  system.by_position.conservativeResize(p + n, f);
  system.by_velocity.conservativeResize(p + n, f);
  system.by_position.bottomRows(n) = vehicle.system().directions(modes, Eigen::all);
  system.by_velocity.bottomRows(n).setZero();
  return system;
}

// Half the width of the narrowest resonance, relative to its frequency.
double find_spacing(const LinearVehicle& vehicle) {
  const Eigen::VectorXcd eigenvalues = vehicle.solver().eigenvalues();
  const double rounding = calc_eigenvalue_rounding(eigenvalues);
  double least = kMostSpacing;
  for (const std::complex<double>& s : eigenvalues) {
    const double ratio = -s.real() / std::abs(s);
    if (std::abs(s) > rounding && ratio < kOscillates) least = std::min(least, ratio);
  }
  return std::max(least, kLeastSpacing);
}

}  // namespace

SmallSets::SmallSets(const Scene& scene, const std::vector<int>& coordinates)
    : scene_(scene),
      p_(scene.watched.outputs.size()),
      n_(static_cast<Eigen::Index>(coordinates.size())),
      direct_(scene.watched.outputs.by_force(Eigen::all, coordinates)),
      thinned_(thin_lines(scene.amplitudes, find_spacing(scene.vehicle))),
      sweep_(add_amplitudes(scene.vehicle, scene.watched.outputs, coordinates)) {
  const Eigen::MatrixXd modal = scene.vehicle.system().directions(coordinates, Eigen::all).transpose();
  projected_ = sweep_.project(modal.cast<std::complex<double>>());
}

void SmallSets::calc_node(Eigen::Index line, Node& node) const {
  HarmonicInputs::Gains gains;
  const double omega = scene_.omega[line];
  scene_.inputs.calc_gains(omega / (2.0 * std::numbers::pi), gains);
  RowsXcd projected(projected_.rows(), n_ + gains.forces.cols());
  projected << projected_, sweep_.project(gains.forces);
  node.states = sweep_.calc_states(Eigen::VectorXd::Constant(1, omega), projected);
  node.outputs_by_force =
      multiply_real_complex(sweep_.state_outputs().topRows(p_), node.states.leftCols(n_)) + direct_;
  node.amplitudes = multiply_real_complex(sweep_.state_outputs().bottomRows(n_),
                                          node.states.rightCols(gains.forces.cols()));
}

Eigen::MatrixXcd SmallSets::calc_change(const Node& node, const std::vector<int>& set) const {
  const auto count = static_cast<Eigen::Index>(set.size());
  Eigen::MatrixXcd receptance(count, count), by_force(p_, count), amplitudes(count, node.amplitudes.cols());
  for (Eigen::Index i = 0; i < count; ++i) {
    const int mode = set[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < count; ++k) {
      receptance(i, k) =
          sweep_.state_outputs().row(p_ + mode) * node.states.col(set[static_cast<std::size_t>(k)]);
    }
    by_force.col(i) = node.outputs_by_force.col(mode);
    amplitudes.row(i) = node.amplitudes.row(mode);
  }
  if (count == 1) return -by_force * (amplitudes / receptance(0, 0));
  return -by_force * support::solve_lu(receptance, amplitudes);
}

std::vector<QuantitySizes> SmallSets::measure(const std::vector<std::vector<int>>& sets,
                                              const FindShown& find_shown) const {
  std::vector<QuantitySizes> sizes;
  const auto values = static_cast<std::size_t>(p_ * scene_.amplitudes.rows()) * thinned_.size();
  const std::size_t at_once = std::max<std::size_t>(1, kMostValues / std::max<std::size_t>(1, values));
  Node node;
  for (std::size_t first = 0; first < sets.size(); first += at_once) {
    const std::size_t count = std::min(at_once, sets.size() - first);
    std::vector<std::vector<Eigen::MatrixXcd>> changes(count);
    for (const Eigen::Index line : thinned_.lines) {
      calc_node(line, node);
      for (std::size_t i = 0; i < count; ++i) changes[i].push_back(calc_change(node, sets[first + i]));
    }
    for (const std::vector<Eigen::MatrixXcd>& one : changes) sizes.push_back(calc_sizes(one, find_shown));
  }
  return sizes;
}

QuantitySizes SmallSets::calc_sizes(const std::vector<Eigen::MatrixXcd>& changes,
                                    const FindShown& find_shown) const {
  const std::vector<WatchedQuantity>& list = scene_.watched.list;
  const auto w = static_cast<Eigen::Index>(list.size());
  QuantitySizes sizes{Eigen::VectorXd::Zero(w), Eigen::VectorXd::Zero(w)};
  for (std::size_t k = 0; k < thinned_.size(); ++k) {
    const Eigen::VectorXd squares = calc_powers(changes[k], thinned_.powers[k]);
    for (Eigen::Index i = 0; i < w; ++i) {
      const WatchedQuantity& quantity = list[static_cast<std::size_t>(i)];
      const double factor = calc_factor(quantity, scene_.omega[thinned_.lines[k]]);
      for (const int row : quantity.rows) sizes.rms[i] += 2.0 * factor * factor * squares[row];
    }
  }
  sizes.rms = sizes.rms.cwiseMax(0.0).cwiseSqrt();

  const std::vector<std::size_t> shown = find_shown(sizes.rms);
  std::vector<int> rows;
  for (const std::size_t i : shown) rows.insert(rows.end(), list[i].rows.begin(), list[i].rows.end());
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  RowsXcd lines(p_, scene_.omega.size());  // only the rows of `rows` are set
  for (const int row : rows) {
    for (std::size_t k = 0; k < thinned_.size(); ++k) {
      const Eigen::Index begin = thinned_.lines[k];
      lines(row, begin) = (changes[k].row(row) * scene_.amplitudes.col(begin)).value();
      if (k + 1 == thinned_.size()) break;
      const Eigen::Index end = thinned_.lines[k + 1];
      const Eigen::RowVectorXcd slope =
          (changes[k + 1].row(row) - changes[k].row(row)) / static_cast<double>(end - begin);
      for (Eigen::Index line = begin + 1; line < end; ++line) {
        lines(row, line) =
            ((changes[k].row(row) + static_cast<double>(line - begin) * slope) * scene_.amplitudes.col(line))
                .value();
      }
    }
  }
  const Eigen::VectorXd peaks = calc_peaks(scene_.watched, lines, scene_.omega, shown);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    sizes.peak[static_cast<Eigen::Index>(shown[i])] = peaks[static_cast<Eigen::Index>(i)];
  }
  return sizes;
}

}  // namespace sprung::dynamics
