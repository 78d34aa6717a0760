#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/adaptivity/missing_motion.h"
#include "dynamics/adaptivity/mode_indicator.h"

namespace sprung::dynamics {

/// What all modes left out together would add to the acceleration of a point, over a run.
struct MissingAcceleration {
  int point = -1;          ///< place among the points asked for; −1: no mode was left out, or not estimated
  int direction = 0;       ///< 0: most of it is along x, 1: along y
  double rms_share = 0.0;  ///< r.m.s. of what is missing over that of the point's acceleration
  double peak_change = 0.0;  ///< change of the point's largest acceleration, as a share of it
  double growth = 0.0;       ///< > 0: not estimated, because small motion grows at this rate [1/s]
  double worst() const { return rms_share > peak_change ? rms_share : peak_change; }
};

/// Records what all modes that a run leaves out would add to the acceleration of each point asked for
/// (adaptivity, eq. 8). Checked by tests/verification/left_out_test.py and left_out_changes_test.py
class MissingAccelerationRecord {
 public:
  /// @param points    markers asked for, those of the indicator
  /// @param start     of the run   @param from, to  span of time that is judged [s]
  MissingAccelerationRecord(const ModeIndicator& indicator, std::vector<int> points,
                            const MissingStart& start, double from, double to);

  /// Takes the indicator's last update into account. @param forces  that the run leaves unbalanced on each
  /// mode [N/√kg]   @param q, v  of the full model
  void add(const ModeIndicator& indicator, const Eigen::VectorXd& forces, const Eigen::VectorXd& q,
           const Eigen::VectorXd& v);
  /// As MissingMotion::add_rates.
  void add_rates(const Eigen::VectorXd& change) { motion_.add_rates(change); }
  /// At the point for which the larger of both shares is the largest.
  MissingAcceleration find_worst(const ModeIndicator& indicator) const;

  struct Point {
    Eigen::Array2d missing = Eigen::Array2d::Zero();  ///< squares along x and y, at the last update [m²/s⁴]
    double present = 0.0;                             ///< square, at the last update
    Eigen::Array2d missing_sum = Eigen::Array2d::Zero();  ///< integrals of the squares over time [m²/s³]
    double present_sum = 0.0;
    double start_angle = 0.0;               ///< of its body
    double peak = 0.0, changed_peak = 0.0;  ///< of the run, and with what is missing [m/s²]
  };
  struct Sums {
    bool has_begun = false, has_left_out = false;
    double time = 0.0, length = 0.0;  ///< of the last update; of all [s]
    std::vector<Point> points;
  };
  /// All that an update changes.
  struct State {
    Sums sums;
    MissingMotion::State motion;
  };
  /// @param[out] state  its memory is used again
  void get_state(State& state) const { state.sums = sums_, state.motion = motion_.state(); }
  /// Goes back to an earlier instant.
  void set_state(const State& state) { sums_ = state.sums, motion_.set_state(state.motion); }

  void save(support::ByteWriter& bytes) const { transfer(bytes, *this); }
  void restore(support::ByteReader& bytes);  ///< @throws support::DamagedBytes

 private:
  template <class Bytes, class Record>
  static void transfer(Bytes& bytes, Record& record) {
    bytes.transfer(record.sums_.has_begun);
    bytes.transfer(record.sums_.has_left_out);
    bytes.transfer(record.sums_.time);
    bytes.transfer(record.sums_.length);
    MissingMotion::transfer(bytes, record.motion_);
    bytes.transfer_items(record.sums_.points, [&](auto& point) {
      bytes.transfer(point.start_angle);
      for (Eigen::Index i = 0; i < 2; ++i) {
        bytes.transfer(point.missing[i]);
        bytes.transfer(point.missing_sum[i]);
      }
      for (auto* value : {&point.present, &point.present_sum, &point.peak, &point.changed_peak})
        bytes.transfer(*value);
    });
  }

  double find_angle(std::size_t point, const ModeIndicator& indicator, const Eigen::VectorXd& q) const;

  MissingMotion motion_;
  std::vector<int> markers_;
  double from_, to_;
  double growth_;  // as that of MissingAcceleration
  Sums sums_;
};

}  // namespace sprung::dynamics
