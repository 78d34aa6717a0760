#include "dynamics/response/adaptive_integral.h"

#include <fmt/format.h>
#include <array>
#include <cstddef>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

// Abscissae and weights of the Kronrod rule on −1 … 1, outermost first; every second point is one of the
// Gauss rule.
constexpr std::array<double, 8> kPoints{
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691258727, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0.0};
constexpr std::array<double, 8> kKronrod{
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array<double, 4> kGauss{
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
    0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
constexpr int kMostHalvings = 40;
constexpr std::size_t kMostPanels = 200000;

struct Panel {
  double from, to;
  int halvings;
  Eigen::VectorXd value, error;
};

Panel make_panel(const std::function<Eigen::VectorXd(double)>& function, double from, double to,
                 int halvings) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  Panel panel{.from = from, .to = to, .halvings = halvings, .value = {}, .error = {}};
  Eigen::VectorXd gauss;
  for (std::size_t i = 0; i < kPoints.size(); ++i) {
    Eigen::VectorXd sum = function(middle + half * kPoints[i]);
    if (kPoints[i] > 0.0) sum += function(middle - half * kPoints[i]);
    if (i == 0) panel.value = gauss = Eigen::VectorXd::Zero(sum.size());
    panel.value += half * kKronrod[i] * sum;
    if (i % 2 == 1) gauss += half * kGauss[i / 2] * sum;
  }
  panel.error = (panel.value - gauss).cwiseAbs();
  return panel;
}

}  // namespace

AdaptiveIntegral integrate(const std::function<Eigen::VectorXd(double)>& function,
                           const std::vector<double>& breaks, double tolerance,
                           const std::function<Eigen::VectorXd(const Eigen::VectorXd& values)>& floors) {
  if (breaks.size() < 2) {
    throw std::invalid_argument(fmt::format("integrate: needs 2 breaks or more, got {}", breaks.size()));
  }
  std::vector<Panel> open;
  Eigen::VectorXd estimate;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    open.push_back(make_panel(function, breaks[i], breaks[i + 1], 0));
    if (i == 0) estimate = Eigen::VectorXd::Zero(open.front().value.size());
    estimate += open.back().value;
  }
  AdaptiveIntegral result{.value = Eigen::VectorXd::Zero(estimate.size())};
  std::size_t num_panels = open.size();
  while (!open.empty()) {
    const Panel panel = std::move(open.back());
    open.pop_back();
    const Eigen::VectorXd allowed = (tolerance * estimate).cwiseMax(floors(estimate));
    const bool is_good = (panel.error.array() <= allowed.array()).all();
    if (is_good || panel.halvings == kMostHalvings || num_panels > kMostPanels) {
      if (!is_good && result.converged) {
        result.converged = false;
        result.worst = 0.5 * (panel.from + panel.to);
      }
      result.value += panel.value;
      continue;
    }
    const double middle = 0.5 * (panel.from + panel.to);
    estimate -= panel.value;
    for (const auto& [from, to] : {std::pair{panel.from, middle}, std::pair{middle, panel.to}}) {
      open.push_back(make_panel(function, from, to, panel.halvings + 1));
      estimate += open.back().value;
    }
    estimate = estimate.cwiseMax(0.0);
    num_panels += 2;
  }
  return result;
}

}  // namespace sprung::dynamics
