#include "dynamics/joints/relative_coordinate.h"

namespace sprung::dynamics {

Eigen::Vector2d RelativeCoordinate::world_axis(const MarkerState& a) const {
  return FrameRotation::from_angle(a.angle) * axis_;
}

double RelativeCoordinate::value(const MarkerState& a, const MarkerState& b) const {
  const Eigen::Vector2d span = b.r - a.r;
  switch (kind_) {
    case Kind::kX:
      return span.x();
    case Kind::kY:
      return span.y();
    case Kind::kAngle:
      return b.angle - a.angle;
    case Kind::kAlong:
      return world_axis(a).dot(span);
    case Kind::kDistance:
      return span.norm();
  }
  return 0.0;
}

double RelativeCoordinate::rate(const MarkerState& a, const MarkerState& b) const {
  const Gradient G = gradient(a, b);
  return G.a.dot(Eigen::RowVector3d(a.v.x(), a.v.y(), a.omega)) +
         G.b.dot(Eigen::RowVector3d(b.v.x(), b.v.y(), b.omega));
}

RelativeCoordinate::Gradient RelativeCoordinate::gradient(const MarkerState& a, const MarkerState& b) const {
  Gradient G{Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero()};
  switch (kind_) {
    case Kind::kX:
      G.b[0] = 1.0;
      break;
    case Kind::kY:
      G.b[1] = 1.0;
      break;
    case Kind::kAngle:
      G.b[2] = 1.0;
      break;
    case Kind::kAlong:
      G.b.head<2>() = world_axis(a).transpose();
      break;
    case Kind::kDistance: {
      const Eigen::Vector2d span = b.r - a.r;
      G.b.head<2>() = span.transpose() / span.norm();
      break;
    }
  }
  G.a = -G.b;
  if (kind_ == Kind::kAlong) G.a[2] = turned(world_axis(a)).dot(b.r - a.r);
  return G;
}

double RelativeCoordinate::drift(const MarkerState& a, const MarkerState& b) const {
  const Eigen::Vector2d span = b.r - a.r, span_rate = b.v - a.v;
  switch (kind_) {
    case Kind::kX:
    case Kind::kY:
    case Kind::kAngle:
      return 0.0;
    case Kind::kAlong: {
      const Eigen::Vector2d axis = world_axis(a);
      return -a.omega * a.omega * axis.dot(span) + 2.0 * a.omega * turned(axis).dot(span_rate);
    }
    case Kind::kDistance: {
      const double length = span.norm();
      const double along = span.dot(span_rate) / length;
      return (span_rate.squaredNorm() - along * along) / length;
    }
  }
  return 0.0;
}

std::string_view coordinate_kind_name(RelativeCoordinate::Kind kind) {
  switch (kind) {
    case RelativeCoordinate::Kind::kX:
      return "x";
    case RelativeCoordinate::Kind::kY:
      return "y";
    case RelativeCoordinate::Kind::kAngle:
      return "angle";
    case RelativeCoordinate::Kind::kAlong:
      return "along";
    case RelativeCoordinate::Kind::kDistance:
      return "distance";
  }
  return "";
}

}  // namespace sprung::dynamics
