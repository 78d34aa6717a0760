#include "dynamics/section_loads/certified_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "dynamics/bodies/body_equations.h"

namespace sprung::dynamics {

namespace {

constexpr Eigen::Index kBlock = 512;        // outputs that are transformed together
constexpr double kLeastAcceleration = 0.1;  // m/s², r.m.s. below which no share is formed
constexpr long kLeastBlocks = 4;            // for the share of a reported point above the band
constexpr double kHeld = 1e-6;  // r.m.s., of the largest, of directions in which a joint keeps a point

int find_row(const reduce::Certificate& certificate, const reduce::Superelement& superelement, int node,
             int freedom) {
  for (std::size_t j = 0; j < certificate.interface.size(); ++j) {
    const reduce::InterfaceError& one = certificate.interface[j];
    if (one.freedom == freedom && superelement.points[static_cast<std::size_t>(one.point)].node == node)
      return static_cast<int>(j);
  }
  return -1;
}

}  // namespace

CertifiedError::CertifiedError(const Model& model, int body, const reduce::Superelement& superelement,
                               const std::vector<VehiclePoint>& points, const std::vector<int>& reported,
                               double output_step)
    : name_(model.bodies[static_cast<std::size_t>(body)].name),
      is_proved_(superelement.certificate->is_bounded()),
      is_whole_(model.bodies[static_cast<std::size_t>(body)].num_modes() == superelement.num_modes()),
      highest_hz_(superelement.certificate->highest_hz),
      step_(output_step),
      first_(model.bodies[static_cast<std::size_t>(body)].first_coordinate) {
  const reduce::Certificate& certificate = *superelement.certificate;
  const Eigen::Index reference = reduce::find_reference_node(superelement);
  for (const int i : model.acting_markers) {
    const VehiclePoint& point = points[static_cast<std::size_t>(i)];
    if (point.body != body || point.kind == VehiclePoint::Kind::kCenterOfMass) continue;
    const bool is_fixed = point.kind == VehiclePoint::Kind::kFixed;
    const int node = is_fixed ? static_cast<int>(reference) : point.node;
    Load load{
        .marker = static_cast<std::size_t>(i), .offset = is_fixed ? point.p_BP : point.offset, .rows = {}};
    for (int freedom = 0; freedom < 3; ++freedom)
      load.rows[static_cast<std::size_t>(freedom)] = find_row(certificate, superelement, node, freedom);
    loads_.push_back(load);
  }
  for (const VehiclePoint& point : points) point_names_.push_back(point.name);
  const auto add_marker = [this](int marker) {
    const auto known = std::find(markers_.begin(), markers_.end(), marker);
    const auto place = static_cast<int>(known - markers_.begin());
    if (known == markers_.end()) markers_.push_back(marker);
    return place;
  };
  const auto num_freedoms = static_cast<Eigen::Index>(certificate.interface.size());
  weights_.resize(num_freedoms);
  for (Eigen::Index j = 0; j < num_freedoms; ++j) {
    const reduce::InterfaceError& one = certificate.interface[static_cast<std::size_t>(j)];
    weights_[j] = std::sqrt((is_proved_ ? one.error : one.static_error) * one.static_flexibility);
    const std::string name = name_ + "." + superelement.points[static_cast<std::size_t>(one.point)].name;
    const int marker = model.find_marker(name);
    if (marker < 0 || one.freedom > 1) {
      rows_.emplace_back(-1, 0);
      continue;
    }
    rows_.emplace_back(add_marker(marker), one.freedom);
  }
  for (const int marker : reported) {
    const VehiclePoint& point = points[static_cast<std::size_t>(marker)];
    if (point.body == body && point.kind != VehiclePoint::Kind::kCenterOfMass)
      reported_.push_back(add_marker(marker));
  }
  const auto num_markers = static_cast<Eigen::Index>(markers_.size());
  samples_ = Eigen::MatrixXd::Zero(kBlock, num_freedoms + 2 * num_markers);
  total_ = above_ = Eigen::Matrix2Xd::Zero(2, num_markers);
}

void CertifiedError::add(std::span<const Wrench> loads, const Eigen::VectorXd& q,
                         const Eigen::Matrix2Xd& acceleration) {
  if (num_samples_ == kBlock) {
    add_block(kBlock, missing_, total_, above_);
    ++num_blocks_;
    samples_.topRows(kBlock / 2) = samples_.bottomRows(kBlock / 2).eval();
    num_samples_ = kBlock / 2;
  }
  auto row = samples_.row(num_samples_++);
  row.setZero();
  const FrameRotation rotation = FrameRotation::from_angle(q[first_ + 2]);
  for (const Load& load : loads_) {
    const Wrench& wrench = loads[load.marker];
    const Eigen::Vector2d force = rotation.transposed_times(wrench.force);
    const Eigen::Vector3d nodal(force.x(), force.y(),
                                wrench.torque + load.offset.x() * force.y() - load.offset.y() * force.x());
    for (std::size_t freedom = 0; freedom < 3; ++freedom) {
      const double value = nodal[static_cast<Eigen::Index>(freedom)];
      if (load.rows[freedom] >= 0) {
        row[load.rows[freedom]] += value;
      } else if (value != 0.0) {
        uncovered_ = static_cast<int>(load.marker);
      }
    }
  }
  row.tail(acceleration.size()) = acceleration.reshaped().transpose();
}

// Adds the mean squares of a block of samples under a Hann window, without their means. Zeros follow on a
// shorter block: transforms of lengths with large prime factors are slow.
void CertifiedError::add_block(Eigen::Index length, double& missing, Eigen::Matrix2Xd& total,
                               Eigen::Matrix2Xd& above) const {
  using std::numbers::pi;
  const Eigen::ArrayXd window =
      0.5 - 0.5 * (2.0 * pi / static_cast<double>(length) *
                   Eigen::ArrayXd::LinSpaced(length, 0.0, static_cast<double>(length - 1)))
                      .cos();
  const double scale = 2.0 / (static_cast<double>(kBlock) * window.square().sum());
  Eigen::FFT<double> fft;
  Eigen::VectorXd windowed = Eigen::VectorXd::Zero(kBlock);
  Eigen::VectorXcd lines;
  // The squares of the lines of a column.
  const auto transform = [&](Eigen::Index column) -> Eigen::ArrayXd {
    const auto values = samples_.col(column).head(length).array();
    windowed.head(length) = (values - values.mean()) * window;
    fft.fwd(lines, windowed);
    return lines.head(kBlock / 2 + 1).cwiseAbs2();
  };
  // At most interface freedoms nothing acts.
  const auto is_zero = [&](Eigen::Index column) {
    return (samples_.col(column).head(length).array() == 0.0).all();
  };
  constexpr Eigen::Index last = kBlock / 2;  // highest line of the spectrum
  const Eigen::ArrayXd frequency = Eigen::ArrayXd::LinSpaced(last + 1, 0.0, static_cast<double>(last)) /
                                   (static_cast<double>(kBlock) * step_);
  const Eigen::ArrayXd is_inside = (frequency <= highest_hz_).cast<double>();
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(last + 1);
  for (Eigen::Index j = 0; j < weights_.size(); ++j) {
    if (!is_zero(j)) sum += weights_[j] * transform(j).sqrt();
  }
  sum *= (2.0 * pi * frequency).square();
  missing += scale * (is_inside * sum.square()).sum();
  for (Eigen::Index k = 0; k < total.size(); ++k) {
    const Eigen::ArrayXd square = transform(weights_.size() + k);
    total.reshaped()[k] += scale * square.sum();
    above.reshaped()[k] += scale * ((1.0 - is_inside) * square).sum();
  }
}

CertifiedShare CertifiedError::find_worst() const {
  CertifiedShare worst;
  if (uncovered_ >= 0) worst.uncovered = point_names_[static_cast<std::size_t>(uncovered_)];
  double missing = missing_;
  Eigen::Matrix2Xd total = total_, above = above_;
  auto blocks = static_cast<double>(num_blocks_);
  // The samples since the last block, whose second half they begin with.
  if (num_samples_ > (num_blocks_ == 0 ? 2 : kBlock / 2)) {
    add_block(num_samples_, missing, total, above);
    blocks += 1.0;
  }
  if (blocks == 0.0) return worst;
  const Eigen::VectorXd whole = total.colwise().sum(), whole_above = above.colwise().sum();
  const double largest = whole.size() > 0 ? std::sqrt(whole.maxCoeff() / blocks) : 0.0;
  for (std::size_t j = 0; j < rows_.size(); ++j) {
    if (rows_[j].first < 0) continue;
    const auto marker = static_cast<Eigen::Index>(rows_[j].first);
    if (std::sqrt(total(rows_[j].second, marker) / blocks) <= kHeld * largest) continue;
    const double rms = std::sqrt(whole[marker] / blocks);
    const double bound = weights_[static_cast<Eigen::Index>(j)] * std::sqrt(missing / blocks);
    const double share = bound / std::max(rms, kLeastAcceleration);
    if (!worst.point.empty() && share <= worst.missing) continue;
    const auto place = static_cast<std::size_t>(markers_[static_cast<std::size_t>(marker)]);
    worst.point = point_names_[place];
    worst.direction = rows_[j].second;
    worst.missing = share;
    worst.above = std::sqrt(whole_above[marker] / whole[marker]);
  }
  if (num_blocks_ < kLeastBlocks) return worst;
  for (const Eigen::Index marker : reported_) {
    if (std::sqrt(whole[marker] / blocks) <= std::max(kLeastAcceleration, kHeld * largest)) continue;
    const double share_above = std::sqrt(whole_above[marker] / whole[marker]);
    if (share_above <= worst.loudest_above) continue;
    worst.loudest = point_names_[static_cast<std::size_t>(markers_[static_cast<std::size_t>(marker)])];
    worst.loudest_above = share_above;
  }
  return worst;
}

}  // namespace sprung::dynamics
