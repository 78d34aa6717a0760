#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "dynamics/functions/time_function.h"
#include "dynamics/simulation/transient.h"
#include "tests/dynamics/beam_superelement.h"

/// Beams held at their root, where modes of small motion do not feel each other: small enough to know what
/// each mode does.
namespace sprung::test::cantilevers {

constexpr int kNumModes = 4;  ///< of each beam: bending at 5, 31, 88 and 176 Hz

BeamSuperelement make_cantilever();
/// A cantilever along x, its root at `root`.
/// @return markers of its nodes, the root's first
std::vector<int> add_cantilever(dynamics::Model& model, const std::string& name, const Eigen::Vector2d& root);
void push(dynamics::Model& model, int marker, dynamics::TimeFunction force);
double frequency(int mode);  ///< of a cantilever [Hz], from 1
/// amplitude × sin² rising and falling once from start to end, × sin(2π f t).
dynamics::TimeFunction burst(double frequency_hz, double amplitude, double start, double end);

struct Change {
  double time;
  std::string mode;  // "beam.mode 2"
  bool joins;
  std::string text;
};

struct Run {
  std::vector<Change> changes;
  std::vector<double> tip, tip_acceleration;  // of the marker watched [m, m/s²]
  std::vector<int> num_active;                // modes, at each output
  std::vector<dynamics::EnergyBook> energy;
  dynamics::TransientStatistics statistics;

  long count(const std::string& mode, bool joins) const {
    return std::count_if(changes.begin(), changes.end(),
                         [&](const Change& one) { return one.mode == mode && one.joins == joins; });
  }
};

inline constexpr double kRecall = 0.08;

struct Case {
  int watched = 0;          // marker
  std::vector<int> active;  // modal coordinates at the start, by number in the whole model from 0
  bool changes = true;
  double duration = 2.0;
  double recall = kRecall, drop = 2e-3;
  double tolerance = 1e-6;  // of the integrator
  bool may_leave = false;   // where all are active at the start; else it is a run with that set
};

inline const std::vector<int> kAll{0, 1, 2, 3, 4, 5, 6, 7};

Run drive(const dynamics::Model& model, const Case& test_case);

double largest(const std::vector<double>& x);
double largest_difference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace sprung::test::cantilevers
