#include <fmt/format.h>

#include <cmath>

#include "softforce/estimation/identification.h"

namespace softforce::estimation {

const char* Name(Identification::Status status) {
  switch (status) {
    case Identification::Status::kNotRun:
      return "not_run";
    case Identification::Status::kOk:
      return "ok";
    case Identification::Status::kTooFewObservations:
      return "too_few_markers";
    case Identification::Status::kUnobservable:
      return "unobservable";
    case Identification::Status::kOutOfRange:
      return "out_of_range";
    case Identification::Status::kNotConverged:
      return "not_converged";
    case Identification::Status::kInconsistent:
      return "inconsistent";
    case Identification::Status::kStopped:
      return "stopped";
  }
  return "";
}

double Identification::Correlation(int a, int b) const {
  return covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
}

std::string Identification::BriefReport() const {
  if (!ok()) return fmt::format("{}: {}", Name(status), reason);
  return fmt::format("ok: chi2 {:.1f} of {} degrees of freedom, {} iterations, {} factorisations",
                     chi2, degrees_of_freedom, iterations, factorisations);
}

std::string Identification::FullReport() const {
  std::string text = BriefReport() + "\n";
  if (!values.empty()) {
    text += fmt::format("{:<32} {:>12} {:>12} {:>12}\n", "unknown", "start", "value", "sd");
    for (const IdentifiedValue& value : values) {
      text += fmt::format("{:<32} {:>12.6g} {:>12.6g} {:>12.3g} {}\n", value.name, value.start,
                          value.value, value.sd, value.unit);
    }
  }
  for (int a = 0; a < static_cast<int>(values.size()); ++a) {
    for (int b = 0; b < a; ++b) {
      text += fmt::format("correlation of {} and {}: {:+.2f}\n", values[a].name, values[b].name,
                          Correlation(a, b));
    }
  }
  if (states.empty()) return text;
  text += fmt::format("{:<20} {:>8} {:>8} {:>9} {:>11} {:>9} {:>12}\n", "state", "observed",
                      "rejected", "moved mm", "offset mm", "misfit mm", "and offset mm");
  for (const StateFit& state : states) {
    text +=
        fmt::format("{:<20} {:>8} {:>8} {:>9.3f} {:>11.3f} {:>9.3f} {:>12.3f}\n", state.name,
                    state.observations, state.rejected, 1e3 * state.displacement,
                    1e3 * state.offset.translation.norm(), 1e3 * state.rms_offset, 1e3 * state.rms);
  }
  return text;
}

}  // namespace softforce::estimation
