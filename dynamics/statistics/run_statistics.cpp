#include "dynamics/statistics/run_statistics.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "dynamics/section_loads/body_remarks.h"

namespace sprung::dynamics {

namespace {

double calc_rms(double sum_of_squares, long count) {
  return count == 0 ? 0.0 : std::sqrt(sum_of_squares / static_cast<double>(count));
}

}  // namespace

void RunStatistics::Accumulator::add(double value) {
  minimum = std::min(minimum, value);
  maximum = std::max(maximum, value);
  sum_of_squares += value * value;
}

SampleStatistics RunStatistics::Accumulator::result(long count) const {
  if (count == 0) return {};
  return {minimum, maximum, calc_rms(sum_of_squares, count)};
}

namespace {

// A motion below the resolution of a usual tolerance [natural sizes].
constexpr double kUnresolved = 1e-7;

// Sum of the works of all weights, strains and force elements over the natural sizes [J].
double calc_work_of_loads(const SystemTerms& terms) {
  const Model& model = terms.model();
  double work = 0.0;
  for (const Body& body : model.bodies) {
    work += body.mass * model.gravity.norm() * model.length_scale;
    for (int k = 0; k < body.num_modes(); ++k) {
      const double strain =
          body.stiffness.col(k).dot(terms.q().segment(body.first_coordinate + 3, body.num_modes()));
      work += std::abs(strain) * model.coordinate_scale(body.first_coordinate + 3 + k);
    }
  }
  for (const int marker : model.acting_markers) {
    const Wrench& load = terms.force_loads()[static_cast<std::size_t>(marker)];
    work += load.force.norm() * model.length_scale + std::abs(load.torque);
  }
  return work;
}

}  // namespace

RunStatistics::RunStatistics(const Model& model, const std::vector<std::string>& points,
                             const Eigen::VectorXd& reference_q, const StatisticsWindow& window,
                             const Vehicle& vehicle, const VehicleSections& sections)
    : model_(&model),
      window_(window),
      sections_(sections),
      phi_(Eigen::VectorXd::Zero(model.num_constraints)),
      first_kinetic_(Eigen::VectorXd::Zero(2 + 3 * static_cast<Eigen::Index>(model.bodies.size()))) {
  SystemTerms terms(model);
  terms.update_positions(0.0, reference_q);
  for (const std::string& name : points) {
    const int marker = model.find_marker(name);
    if (marker < 0) throw std::invalid_argument(fmt::format("RunStatistics: there is no point '{}'", name));
    points_.push_back(
        {marker, terms.markers()[static_cast<std::size_t>(marker)].r.y(), {}, {}, {}, 0.0, 0.0});
  }
  std::vector<int> reported;
  for (const Point& point : points_) reported.push_back(point.marker);
  bending_ = make_body_bending(vehicle, model, sections);
  const std::vector<VehiclePoint> of_vehicle = list_points(vehicle);
  for (const BodySections& body : sections.bodies()) {
    moments_.emplace_back(body);
    if (!body.has_modes()) continue;
    const reduce::Superelement& superelement = *vehicle.superelement_of(vehicle.bodies[body.body()]);
    const std::optional<reduce::Certificate>& certificate = superelement.certificate;
    if (!certificate || certificate->interface.empty()) continue;
    certified_.emplace_back(model, static_cast<int>(body.body()), superelement, of_vehicle, reported,
                            window.output_step);
  }
}

void RunStatistics::add(const Snapshot& snapshot) {
  const SystemTerms& terms = snapshot.terms();
  if (model_->num_constraints > 0) {
    terms.calc_residual(phi_);
    constraint_violation_ = std::max(constraint_violation_, phi_.lpNorm<Eigen::Infinity>());
  }
  const Energy& now = snapshot.energy.stored;
  if (!has_first_) {
    first_ = now;
    calc_kinetic_parts(terms, first_kinetic_);
    has_first_ = true;
  }
  add_to_energy_size(now, terms);
  // Term by term, so that a large potential far from the origin causes no cancellation.
  const double imbalance = (now.kinetic - first_.kinetic) + (now.strain - first_.strain) +
                           (now.gravity - first_.gravity) + (now.spring - first_.spring) +
                           snapshot.energy.dissipated - snapshot.energy.input;
  largest_imbalance_ = std::max(largest_imbalance_, std::abs(imbalance));

  add_to_bending(sections_.sections(), snapshot.time, snapshot.q, bending_);
  check_bending(bending_);
  add_to_certified(snapshot);

  const bool is_stored = num_outputs_++ % window_.stored_every == 0;
  if (!is_counted(snapshot.time)) return;
  ++num_samples_;
  if (snapshot.acceleration_error != nullptr) ++num_estimates_;
  sections_.add(snapshot.time);
  const std::vector<BodySections>& bodies = sections_.sections().bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) moments_[b].add_output(bodies[b]);
  for (Point& point : points_) {
    const auto marker = static_cast<std::size_t>(point.marker);
    point.displacement.add(terms.markers()[marker].r.y() - point.reference_height);
    const Eigen::Vector2d acceleration = snapshot.calc_acceleration(marker);
    point.acceleration.add(acceleration.y());
    point.squared_acceleration += acceleration.squaredNorm();
    point.squared_error += snapshot.calc_acceleration_error(marker).squaredNorm();
    for (Eigen::Index i = 0; i < 2; ++i) {
      SampleDensity& density = point.density[static_cast<std::size_t>(i)];
      if (is_stored) {
        density.add_sample(acceleration[i]);
      } else {
        density.add_between(acceleration[i]);
      }
    }
  }
}

void RunStatistics::add_between(double time, const ConstrainedEquations& equations, const Energy& stored) {
  if (has_first_) add_to_energy_size(stored, equations.terms());
  if (!is_counted(time)) return;
  for (Point& point : points_) {
    const Eigen::Vector2d acceleration = calc_acceleration(equations, static_cast<std::size_t>(point.marker));
    point.density[0].add_between(acceleration.x());
    point.density[1].add_between(acceleration.y());
  }
  const std::vector<BodySections>& bodies = sections_.sections().bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) moments_[b].add_between(bodies[b]);
}

bool RunStatistics::is_counted(double time) const {
  const double tolerance = 1e-6 * window_.output_step;
  return window_.from - tolerance <= time && time <= window_.to + tolerance;
}

void RunStatistics::add_to_energy_size(const Energy& now, const SystemTerms& terms) {
  calc_kinetic_parts(terms, kinetic_);
  const double change = (kinetic_ - first_kinetic_).lpNorm<1>() + std::abs(now.strain - first_.strain) +
                        std::abs(now.gravity - first_.gravity) + std::abs(now.spring - first_.spring);
  // Lower bounds: almost at rest, the changes are rounding errors of the terms; in steady rotation they are
  // errors of the integration.
  const double size =
      std::abs(now.kinetic) + std::abs(now.strain) + std::abs(now.gravity) + std::abs(now.spring);
  largest_change_ = std::max(
      {largest_change_, change, 1e-9 * size, 0.01 * now.kinetic, kUnresolved * calc_work_of_loads(terms)});
}

void RunStatistics::add_to_certified(const Snapshot& snapshot) {
  for (CertifiedError& body : certified_) {
    const auto num_markers = static_cast<Eigen::Index>(body.markers().size());
    Eigen::Matrix2Xd acceleration(2, num_markers);
    for (Eigen::Index i = 0; i < num_markers; ++i) {
      const auto marker = static_cast<std::size_t>(body.markers()[static_cast<std::size_t>(i)]);
      acceleration.col(i) = snapshot.calc_acceleration(marker);
    }
    body.add(sections_.sections().loads(), snapshot.q, acceleration);
  }
}

std::vector<PointStatistics> RunStatistics::point_statistics() const {
  std::vector<PointStatistics> all;
  for (const Point& point : points_) {
    all.push_back({model_->markers[static_cast<std::size_t>(point.marker)].name,
                   point.displacement.result(num_samples_), point.acceleration.result(num_samples_),
                   point.density, calc_rms(point.squared_acceleration, num_samples_),
                   calc_rms(point.squared_error, num_estimates_)});
  }
  return all;
}

double RunStatistics::energy_closure() const {
  return largest_change_ > 0.0 ? largest_imbalance_ / largest_change_ : 0.0;
}

template <class Bytes, class Statistics>
void RunStatistics::transfer(Bytes& bytes, Statistics& statistics) {
  for (auto& point : statistics.points_) {
    for (auto* sample : {&point.displacement, &point.acceleration}) {
      bytes.transfer(sample->minimum);
      bytes.transfer(sample->maximum);
      bytes.transfer(sample->sum_of_squares);
    }
    for (auto& density : point.density) SampleDensity::transfer(bytes, density);
    bytes.transfer(point.squared_acceleration);
    bytes.transfer(point.squared_error);
  }
  SectionStatistics::transfer(bytes, statistics.sections_);
  for (auto& body : statistics.moments_) MomentDensity::transfer(bytes, body);
  for (auto& body : statistics.bending_) BodyBending::transfer(bytes, body);
  for (auto& body : statistics.certified_) CertifiedError::transfer(bytes, body);
  bytes.transfer(statistics.num_samples_);
  bytes.transfer(statistics.num_outputs_);
  bytes.transfer(statistics.num_estimates_);
  bytes.transfer(statistics.constraint_violation_);
  bytes.transfer(statistics.has_first_);
  auto& first = statistics.first_;
  for (auto* energy : {&first.kinetic, &first.strain, &first.gravity, &first.spring}) bytes.transfer(*energy);
  bytes.transfer(statistics.first_kinetic_);
  bytes.transfer(statistics.largest_imbalance_);
  bytes.transfer(statistics.largest_change_);
}

void RunStatistics::save(support::ByteWriter& bytes) const {
  transfer(bytes, *this);
}

void RunStatistics::restore(support::ByteReader& bytes) {
  const Eigen::Index num_parts = first_kinetic_.size();
  transfer(bytes, *this);
  if (first_kinetic_.size() != num_parts) throw support::DamagedBytes();
}

}  // namespace sprung::dynamics
