#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/system/system_terms.h"
#include "tools/support/files/bytes.h"

namespace sprung::dynamics {

/// What the basis of a superelement misses at most of an acceleration in a run.
struct CertifiedShare {
  std::string point;     ///< "chassis.front_spring"; empty: no bound, or no run yet
  int direction = 0;     ///< 0: x, 1: y of the body
  double missing = 0.0;  ///< bound, up to the end of the band, over the r.m.s. acceleration of the point
  double above = 0.0;    ///< share of this r.m.s. above the band, about which nothing is proved
  std::string loudest;   ///< the reported point with the largest share above the band
  double loudest_above = 0.0;  ///< this share
  std::string uncovered;       ///< a point with loads that are not in the interface, "" for none
};

/// Holds the interface loads of a run, by frequency, against the certificate of a body's superelement
/// (section_loads, eq. 6). A certificate without a bound has the errors at rest in its place. Loads and
/// accelerations of the outputs are transformed block by block. Checked by
/// tests/verification/bound_of_run_test.py
class CertifiedError {
 public:
  /// @param body         0-based, of the model; with a superelement that has a certificate
  /// @param points       of the vehicle, in the order of the model's markers
  /// @param reported     markers of the points whose motion is asked for
  /// @param output_step  > 0 [s]
  CertifiedError(const Model& model, int body, const reduce::Superelement& superelement,
                 const std::vector<VehiclePoint>& points, const std::vector<int>& reported,
                 double output_step);

  const std::string& name() const { return name_; }
  bool is_proved() const { return is_proved_; }      ///< whether the certificate has a bound
  bool is_whole() const { return is_whole_; }        ///< whether all vectors of the basis take part
  double highest_hz() const { return highest_hz_; }  ///< the end of the band
  /// Adds an output.
  /// @param loads         force and torque on each marker of the model, world axes
  /// @param q             of the model
  /// @param acceleration  of each marker of markers(), world axes [m/s²]
  void add(std::span<const Wrench> loads, const Eigen::VectorXd& q, const Eigen::Matrix2Xd& acceleration);
  const std::vector<int>& markers() const { return markers_; }  ///< of interface and reported points
  /// For the interface point and direction of which most may be missing; a direction in which a point does
  /// not move, as where the ground holds it, has no share.
  CertifiedShare find_worst() const;

  template <class Bytes, class Error>
  static void transfer(Bytes& bytes, Error& error) {
    bytes.transfer(error.num_samples_);
    if (error.num_samples_ < 0 || error.num_samples_ > error.samples_.rows()) throw support::DamagedBytes();
    bytes.transfer(error.num_blocks_);
    bytes.transfer(error.missing_);
    bytes.transfer(error.uncovered_);
    for (auto* values : {&error.total_, &error.above_}) {
      for (Eigen::Index i = 0; i < values->size(); ++i) bytes.transfer(values->data()[i]);
    }
    for (Eigen::Index i = 0; i < error.samples_.size(); ++i) bytes.transfer(error.samples_.data()[i]);
  }

 private:
  struct Load {
    std::size_t marker;
    Eigen::Vector2d offset;   // from the node
    std::array<int, 3> rows;  // of the interface, −1: not in it
  };
  void add_block(Eigen::Index length, double& missing, Eigen::Matrix2Xd& total,
                 Eigen::Matrix2Xd& above) const;

  std::string name_;
  bool is_proved_, is_whole_;
  double highest_hz_, step_;
  int first_;
  std::vector<std::string> point_names_;  // of each marker of the vehicle
  std::vector<Load> loads_;
  Eigen::VectorXd weights_;                // √(error · static flexibility) of each interface freedom
  std::vector<std::pair<int, int>> rows_;  // place in markers_ and direction of each; rotations: −1
  std::vector<int> markers_;
  std::vector<Eigen::Index> reported_;  // places in markers_
  // Of the present block: interface loads, then x and y of each marker.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> samples_;
  Eigen::Index num_samples_ = 0;
  int uncovered_ = -1;  // marker with a load that is not in the interface
  long num_blocks_ = 0;
  double missing_ = 0.0;            // sum over blocks of the mean square of Σ w |F|, ω²-weighted
  Eigen::Matrix2Xd total_, above_;  // of each marker's acceleration, and of its part above the band
};

}  // namespace sprung::dynamics
