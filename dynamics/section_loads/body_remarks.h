#pragma once

#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/section_loads/body_bending.h"
#include "dynamics/section_loads/certified_error.h"
#include "dynamics/section_loads/section_statistics.h"

namespace sprung::dynamics {

/// A doubt about the numbers of a body; the text names it.
struct BodyRemark {
  std::string body, text;
};

/// A remark on each body of whose largest deflection, if points are judged, or bending moment, if moments
/// are, the modes miss more than a twentieth.
std::vector<BodyRemark> list_missing_parts(const SectionStatistics& statistics,
                                           const JudgedQuantities& judged);
/// A remark on each body for which linear bending without axial forces does not hold: one that deflects by
/// more than a tenth of its length, or whose bending axial forces change by more than 3 %.
std::vector<BodyRemark> list_large_bending(const std::vector<BodyBending>& bodies);
/// @throws support::NumericalError where a body deflects by more than ten times its length: a motion that
/// grows
///         without bounds, which would take ever shorter steps
void check_bending(const std::vector<BodyBending>& bodies);

/// A remark on each body whose basis may miss more than a twentieth of an acceleration within the band of its
/// certificate.
std::vector<BodyRemark> list_missed_by_bases(const std::vector<CertifiedError>& bodies);

}  // namespace sprung::dynamics
