#include "reduce/inspection/certificate_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reduce/reduction/inertia_invariants.h"
#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/terminal/text_table.h"

namespace sprung::reduce {

namespace {

using support::TextTable;

constexpr Eigen::Index kMostRows = 20;  // of the free modes shown

// A bound as percent with two digits, rounded up. Below the rounding floor it says no more than that.
std::string format_share(double share, double floor) {
  if (share >= kUnbounded) return "none";
  if (share < floor) return fmt::format("< {:.0e}", 100.0 * floor);
  if (!(share > 0.0)) return "0";
  const double digit = std::pow(10.0, std::floor(std::log10(100.0 * share)) - 1.0);
  const double above = digit * std::ceil(100.0 * share / digit * (1.0 - 1e-12));
  return fmt::format("{:.2g}", above);
}

std::string format_freedom(const Superelement& s, const InterfaceError& one) {
  return fmt::format("{} {}", s.points[static_cast<std::size_t>(one.point)].name, freedom_name(one.freedom));
}

// The free mode in the band whose frequency in the basis is the most wrong; of those missing the lowest.
std::string format_worst_mode(const Certificate& certificate) {
  const Eigen::Index in_band = (certificate.free_hz.array() <= certificate.highest_hz).count();
  Eigen::Index worst = 0;
  const double largest = in_band > 0 ? certificate.free_error.head(in_band).maxCoeff(&worst) : 0.0;
  if (largest <= certificate.rounding_floor) return "the basis holds no free mode exactly";
  return fmt::format("the free mode at {:.6g} Hz is {}", certificate.free_hz(worst),
                     largest >= kUnbounded ? "missing" : fmt::format("{:.2g} % off", 100.0 * largest)) +
         (in_band > 1 ? ", the most in the band" : "");
}

}  // namespace

std::string format_basis(const Superelement& s) {
  const auto last_mode = [&](const char* kind) {
    int last = -1;
    for (int i = 0; i < s.num_modes(); ++i) last = s.kind_of(i) == kind ? i : last;
    return last;
  };
  const auto count = [&](const char* kind) {
    int number = 0;
    for (int i = 0; i < s.num_modes(); ++i) number += s.kind_of(i) == kind ? 1 : 0;
    return number;
  };
  if (!s.has_free_basis()) {
    return fmt::format("{} modes from {:.4f} to {:.4f} Hz", s.num_modes(), s.frequency_hz(0),
                       s.frequency_hz(s.num_modes() - 1));
  }
  const int constraint = count(kConstraintVector), fixed = count(kFixedInterfaceVector);
  if (constraint + fixed > 0) {
    return fmt::format("{} vectors of fixed interface, mainly {} constraint and {} held at the interface",
                       s.num_modes(), constraint, fixed);
  }
  const int num_free = count(kFreeVector), last = last_mode(kFreeVector);
  const std::string free =
      num_free == 0 ? "no free mode"
                    : fmt::format("{} free mode{} from {:.4f} to {:.4f} Hz", num_free,
                                  num_free == 1 ? "" : "s", s.frequency_hz(0), s.frequency_hz(last));
  const int num_residual = count(kResidualVector);
  return fmt::format("{}, {} residual vector{}", free, num_residual, num_residual == 1 ? "" : "s");
}

std::string format_certificate_line(const Superelement& s) {
  if (!s.certificate || s.certificate->interface.empty()) return "";
  const Certificate& certificate = *s.certificate;
  const InterfaceError& worst = certificate.interface[static_cast<std::size_t>(certificate.find_worst())];
  if (certificate.is_bounded()) {
    return fmt::format(
        "interface flexibility within {} % up to {:g} Hz (proved, of {}); worst: {} at {:.3g} Hz",
        format_share(worst.error, certificate.rounding_floor), certificate.highest_hz,
        s.elements.cols() > 0 ? "this mesh" : "these matrices", format_freedom(s, worst), worst.worst_hz);
  }
  return fmt::format(
      "interface flexibility without a bound up to {:.3g} Hz: {}; at rest within {} %, worst: {}",
      certificate.highest_hz, format_worst_mode(certificate),
      format_share(worst.static_error, certificate.rounding_floor), format_freedom(s, worst));
}

std::string format_certificate(const Superelement& s) {
  if (!s.certificate) return "";
  const Certificate& certificate = *s.certificate;
  std::string text =
      fmt::format("Certificate: 0 to {:g} Hz, {} free modes counted below {:.4g} Hz", certificate.highest_hz,
                  certificate.free_hz.size(), 1.5 * certificate.highest_hz);
  text += certificate.cutoff_hz > 0.0
              ? fmt::format(", none left out below {:.4f} Hz\n", certificate.cutoff_hz)
              : ", none left out\n";
  if (const std::string line = format_certificate_line(s); !line.empty()) text += line + "\n";
  if (!certificate.is_bounded()) {
    text +=
        "No number can bound the band: where the basis has a free mode at another frequency, the error "
        "grows\n"
        "without limit near both. How good it is, the errors of the frequencies and those at rest tell.\n";
  }
  TextTable modes({"free mode", "frequency Hz", "error of the basis %"});
  const Eigen::Index shown = std::min(certificate.free_hz.size(), kMostRows);
  for (Eigen::Index i = 0; i < shown; ++i) {
    modes.add_row({fmt::format("{}", i + 1), fmt::format("{:.4f}", certificate.free_hz(i)),
                   certificate.free_error(i) >= kUnbounded
                       ? "missing"
                       : format_share(certificate.free_error(i), certificate.rounding_floor)});
  }
  if (shown > 0) text += fmt::format("\n{}", modes.str());
  if (shown < certificate.free_hz.size())
    text += fmt::format("and {} more\n", certificate.free_hz.size() - shown);
  TextTable interface(
      {"interface", "static flexibility", "error at rest %", "error in the band %", "worst at Hz"});
  for (const InterfaceError& one : certificate.interface) {
    interface.add_row(
        {format_freedom(s, one),
         fmt::format("{:.4g} {}", one.static_flexibility, one.freedom == 2 ? "rad/(N·m)" : "m/N"),
         format_share(one.static_error, certificate.rounding_floor),
         format_share(one.error, certificate.rounding_floor),
         one.error >= kUnbounded ? "" : fmt::format("{:.3g}", one.worst_hz)});
  }
  if (!certificate.interface.empty()) text += fmt::format("\n{}", interface.str());
  if (certificate.is_bounded() && !certificate.interface.empty())
    text += "The errors are those of the undamped body.\n";
  return text;
}

std::optional<FreeModes> calc_free_modes(const Superelement& s) {
  const Eigen::MatrixXd whole = calc_mass_matrix(s.inertia);
  const Eigen::MatrixXd momenta = whole.topRightCorner(3, s.num_modes());
  const Eigen::MatrixXd mass = s.inertia.M_ff - momenta.transpose() * support::solve_positive_definite(
                                                                          whole.topLeftCorner(3, 3), momenta);
  const auto pairs = support::solve_undamped(s.stiffness, 0.5 * (mass + mass.transpose()));
  if (!pairs || !(pairs->values.minCoeff() > 0.0)) return std::nullopt;
  const Eigen::VectorXd omega = pairs->values.cwiseSqrt();
  const Eigen::VectorXd damping = (pairs->vectors.transpose() * s.damping * pairs->vectors).diagonal();
  return FreeModes{.frequency_hz = omega / (2.0 * std::numbers::pi),
                   .damping_ratio = 0.5 * damping.cwiseQuotient(omega)};
}

std::string format_free_damping(const Superelement& s) {
  if (s.has_free_basis()) return "";
  const std::optional<FreeModes> free = calc_free_modes(s);
  if (!free) return "";
  TextTable table({"free mode", "frequency Hz", "damping %"});
  const Eigen::Index shown = std::min<Eigen::Index>(free->frequency_hz.size(), 6);
  for (Eigen::Index i = 0; i < shown; ++i) {
    table.add_row({fmt::format("{}", i + 1), fmt::format("{:.4f}", free->frequency_hz(i)),
                   fmt::format("{:.3g}", 100.0 * free->damping_ratio(i))});
  }
  return "What the damping of the clamped modes is on the free body, as a modal test measures it:\n" +
         table.str();
}

}  // namespace sprung::reduce
