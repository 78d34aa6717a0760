#include "dynamics/section_loads/body_remarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kTooMuchMissing = 0.05;       // of the largest bending moment or deflection
constexpr double kTooMuchAbove = 0.05;         // the band, of the r.m.s. acceleration of a point
constexpr double kLargeDeflection = 0.1;       // over the length of the body
constexpr double kUnboundedDeflection = 10.0;  // likewise
constexpr double kLargeAxialEffect = 0.03;     // work of axial forces in bending over that of the stiffness

// What a body can have besides its modes.
// @param of_basis  share that all vectors of its superelement would miss
std::string advise_on_basis(const BodySections& body, double of_basis) {
  const char* const other_basis = body.is_certified()
                                      ? "reduce it with a smaller tolerance, or up to a higher frequency"
                                      : "reduce it to a certified basis, with more vectors";
  if (body.has_whole_basis()) return other_basis;
  if (of_basis > kTooMuchMissing) {
    return fmt::format("all vectors of its superelement would miss {:.3g} %, so {}", 100.0 * of_basis,
                       other_basis);
  }
  return body.is_certified() ? fmt::format("take more modes, modes.{} = \"certified\" takes all", body.name())
                             : "take more modes or a certified basis";
}

}  // namespace

std::vector<BodyRemark> list_missing_parts(const SectionStatistics& statistics,
                                           const JudgedQuantities& judged) {
  std::vector<BodyRemark> remarks;
  for (std::size_t b = 0; b < statistics.peaks().size(); ++b) {
    const BodySections& body = statistics.sections().bodies()[b];
    const SectionPeaks& peaks = statistics.peaks()[b];
    std::vector<std::string> parts;
    double of_basis = 0.0;
    if (judged.points && peaks.missing_deflection_share() > kTooMuchMissing) {
      const SectionPeak& peak = peaks.missing_deflection;
      of_basis = peaks.basis_deflection_share();
      parts.push_back(fmt::format("{:.3g} % of the largest deflection (at {} along {}, t = {:.3g} s)",
                                  100.0 * peaks.missing_deflection_share(),
                                  body.points()[static_cast<std::size_t>(peak.station / 3)],
                                  peak.station % 3 == 0 ? "x" : "y", peak.time));
    }
    if (judged.moments && peaks.missing_moment_share() > kTooMuchMissing) {
      const Eigen::RowVector2d place = body.positions().row(peaks.missing_moment.station);
      of_basis = std::max(of_basis, peaks.basis_moment_share());
      parts.push_back(
          fmt::format("{:.3g} % of the largest bending moment (at x = {:.4g} m, y = {:.4g} m, t = {:.3g} s)",
                      100.0 * peaks.missing_moment_share(), place.x(), place.y(), peaks.missing_moment.time));
    }
    if (parts.empty()) continue;
    remarks.push_back(
        {body.name(), fmt::format("{}: its modes miss {}; {}, and take moments from the loads", body.name(),
                                  fmt::join(parts, " and "), advise_on_basis(body, of_basis))});
  }
  return remarks;
}

std::vector<BodyRemark> list_missed_by_bases(const std::vector<CertifiedError>& bodies) {
  std::vector<BodyRemark> remarks;
  for (const CertifiedError& body : bodies) {
    const CertifiedShare share = body.find_worst();
    if (share.loudest_above > kTooMuchAbove) {
      remarks.push_back(
          {body.name(),
           fmt::format(
               "{}: {:.3g} % of the r.m.s. acceleration of {} is above {:.4g} Hz, where nothing is known "
               "of what its superelement misses; reduce it up to a higher frequency, or judge only what "
               "is below",
               body.name(), 100.0 * share.loudest_above, share.loudest, body.highest_hz())});
    }
    if (!(share.missing > kTooMuchMissing)) continue;
    const std::string of_point =
        fmt::format("{:.3g} % of the r.m.s. acceleration of {} along {} up to {:.4g} Hz",
                    100.0 * share.missing, share.point, share.direction == 0 ? "x" : "y", body.highest_hz());
    remarks.push_back(
        {body.name(),
         body.is_proved()
             ? fmt::format(
                   "{}: under these loads its superelement may miss {}; reduce it with a smaller tolerance",
                   body.name(), of_point)
             : fmt::format(
                   "{}: under these loads its superelement misses about {}, judged by what it misses at "
                   "rest, since its certificate has no bound; reduce it with the basis \"free\"",
                   body.name(), of_point)});
  }
  return remarks;
}

void check_bending(const std::vector<BodyBending>& bodies) {
  for (const BodyBending& body : bodies) {
    if (!(body.deflection_share() > kUnboundedDeflection)) continue;
    std::string text = fmt::format(
        "{} deflects by {:.3g} times its length at t = {:.6g} s: linear bending does not hold there, and the "
        "motion seems to grow without bounds",
        body.name(), body.deflection_share(), body.deflection_time());
    if (body.axial_effect() > kLargeAxialEffect) {
      text += fmt::format("; axial forces, which are left out, change the bending: set stiffening.{} = true",
                          body.name());
    }
    throw support::NumericalError(text);
  }
}

std::vector<BodyRemark> list_large_bending(const std::vector<BodyBending>& bodies) {
  std::vector<BodyRemark> remarks;
  for (const BodyBending& body : bodies) {
    if (body.deflection_share() > kLargeDeflection) {
      remarks.push_back(
          {body.name(),
           fmt::format("{}: the deflection is {:.3g} % of the body's length (at t = {:.3g} s); beyond "
                       "{:.0f} % linear bending does not hold",
                       body.name(), 100.0 * body.deflection_share(), body.deflection_time(),
                       100.0 * kLargeDeflection)});
    }
    if (body.axial_effect() > kLargeAxialEffect) {
      remarks.push_back(
          {body.name(),
           fmt::format("{}: axial forces change the bending by {:.3g} %: set stiffening.{} = true",
                       body.name(), 100.0 * body.axial_effect(), body.name())});
    }
  }
  return remarks;
}

}  // namespace sprung::dynamics
