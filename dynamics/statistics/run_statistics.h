#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "dynamics/section_loads/body_bending.h"
#include "dynamics/section_loads/certified_error.h"
#include "dynamics/section_loads/section_statistics.h"
#include "dynamics/simulation/transient.h"
#include "dynamics/statistics/moment_density.h"
#include "dynamics/statistics/sample_density.h"
#include "tools/support/files/bytes.h"

namespace sprung::dynamics {

/// Smallest, largest and root mean square of a sampled quantity.
struct SampleStatistics {
  double minimum = 0.0, maximum = 0.0, rms = 0.0;
  double peak() const { return std::max(-minimum, maximum); }
};

/// Motion of one point: vertical displacement from the reference position and vertical acceleration.
struct PointStatistics {
  std::string point;
  SampleStatistics displacement;         ///< [m]
  SampleStatistics acceleration;         ///< [m/s²]
  std::array<SampleDensity, 2> density;  ///< of the stored accelerations along x and y
  double acceleration_rms = 0.0;         ///< of its length, x and y [m/s²]
  double acceleration_error_rms = 0.0;   ///< likewise of its estimated error; 0 without an estimate [m/s²]
};

/// Which outputs are counted.
struct StatisticsWindow {
  double from = 0.0, to = 0.0;  ///< for the points and sections [s]
  double output_step = 0.0;     ///< > 0 [s]
  long stored_every = 1;        ///< outputs from one stored acceleration of a point to the next
};

/// Statistics of a run over its outputs, which are added one by one.
class RunStatistics {
 public:
  /// @param points       names of markers to report, "body.point"
  /// @param reference_q  positions that displacements refer to: the equilibrium, or the given start
  /// @param sections     of the model and vehicle; has to outlive this
  RunStatistics(const Model& model, const std::vector<std::string>& points,
                const Eigen::VectorXd& reference_q, const StatisticsWindow& window, const Vehicle& vehicle,
                const VehicleSections& sections);

  /// Adds an output, at which the sections are up to date.
  /// @throws support::NumericalError where a body deflects without bounds (section_loads, "Where linear
  /// bending ends")
  void add(const Snapshot& snapshot);
  /// Takes an instant between outputs, at which all markers and the sections are up to date, into account for
  /// the density of the outputs and for the size of the energies.
  void add_between(double time, const ConstrainedEquations& equations, const Energy& stored);

  std::vector<PointStatistics> point_statistics() const;
  /// Largest |φ| at any output [m, rad].
  double constraint_violation() const { return constraint_violation_; }
  /// Relative error of the energy balance (statistics, eq. 1).
  double energy_closure() const;
  long num_samples() const { return num_samples_; }
  double output_step() const { return window_.output_step; }  ///< [s]
  /// From one stored acceleration of a point to the next [s].
  double stored_step() const { return static_cast<double>(window_.stored_every) * window_.output_step; }
  const SectionStatistics& sections() const { return sections_; }
  const std::vector<MomentDensity>& moments() const { return moments_; }  ///< of each of the sections' bodies
  const std::vector<BodyBending>& bending() const { return bending_; }    ///< of each body with modes
  /// Of each body with modes whose superelement has a bound.
  const std::vector<CertifiedError>& certified() const { return certified_; }

  /// What has been added so far, as bytes and back into statistics of the same model and points.
  void save(support::ByteWriter& bytes) const;
  void restore(support::ByteReader& bytes);  ///< @throws support::DamagedBytes

 private:
  struct Accumulator {
    double minimum = std::numeric_limits<double>::infinity();
    double maximum = -std::numeric_limits<double>::infinity();
    double sum_of_squares = 0.0;
    void add(double value);
    SampleStatistics result(long count) const;
  };
  struct Point {
    int marker;
    double reference_height;
    Accumulator displacement, acceleration;
    std::array<SampleDensity, 2> density;
    double squared_acceleration = 0.0, squared_error = 0.0;  // sums [m²/s⁴]
  };

  void add_to_energy_size(const Energy& now, const SystemTerms& terms);
  bool is_counted(double time) const;
  void add_to_certified(const Snapshot& snapshot);
  template <class Bytes, class Statistics>
  static void transfer(Bytes& bytes, Statistics& statistics);

  const Model* model_;
  StatisticsWindow window_;
  std::vector<Point> points_;
  SectionStatistics sections_;
  std::vector<MomentDensity> moments_;
  std::vector<BodyBending> bending_;
  std::vector<CertifiedError> certified_;
  long num_samples_ = 0, num_outputs_ = 0, num_estimates_ = 0;
  double constraint_violation_ = 0.0;
  Eigen::VectorXd phi_;  // constraint residual
  bool has_first_ = false;
  Energy first_;
  Eigen::VectorXd first_kinetic_, kinetic_;  // parts, see calc_kinetic_parts
  double largest_imbalance_ = 0.0, largest_change_ = 0.0;
};

}  // namespace sprung::dynamics
