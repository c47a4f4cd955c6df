#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "softforce/pipeline/identify.h"

namespace softforce::pipeline {
namespace {

// χ² per degree of freedom. Below the first the model errors allowed for are more than enough;
// above the second they do not explain what is left.
constexpr double kComfortable = 0.5, kUnexplained = 1.5;
constexpr double kForcesAgree = 0.02;  // share; a run's own standard deviation is about that

struct Shown {
  double factor;
  const char* unit;
};

Shown UnitOf(const estimation::IdentifiedValue& value) {
  const std::string unit = value.unit;
  if (unit == "Pa") return {1e-3, "kPa"};
  if (unit == "m") return {1e3, "mm"};
  return {1, value.unit};
}

std::string Values(const estimation::Identification& found) {
  std::string text;
  for (const estimation::IdentifiedValue& value : found.values) {
    const Shown shown = UnitOf(value);
    text += fmt::format("{:<28} {:>9.4g} -> {:<9.5g} sd {:<8.2g} {}\n", value.name,
                        shown.factor * value.start, shown.factor * value.value,
                        shown.factor * value.sd, shown.unit);
  }
  for (int a = 0; a < static_cast<int>(found.values.size()); ++a) {
    for (int b = 0; b < a; ++b) {
      if (std::abs(found.Correlation(a, b)) < 0.9) continue;
      text += fmt::format("  {} and {} are hardly told apart: correlation {:+.2f}\n",
                          found.values[b].name, found.values[a].name, found.Correlation(a, b));
    }
  }
  return text;
}

std::string States(const std::vector<estimation::StateFit>& states) {
  std::string text =
      fmt::format("\n{:<18} {:>7} {:>9} {:>9} {:>10} {:>9} {:>12}\n", "state", "points", "rejected",
                  "moved mm", "offset mm", "left mm", "of movement");
  for (const estimation::StateFit& state : states) {
    const bool moved = state.rms_offset < state.displacement;
    const std::string share =
        moved ? fmt::format("{:.2f} %", 100 * state.rms_offset / state.displacement) : "-";
    text += fmt::format("{:<18} {:>7} {:>9} {:>9.3f} {:>10.3f} {:>9.3f} {:>12}\n", state.name,
                        state.observations, state.rejected, 1e3 * state.displacement,
                        1e3 * state.offset.translation.norm(), 1e3 * state.rms_offset, share);
  }
  return text;
}

std::string Forces(const std::vector<KnownForce>& forces) {
  if (forces.empty()) return "";
  std::string text =
      fmt::format("\nWith these values a run finds\n{:<18} {:>10} {:>9} {:>9} {:>8}\n", "state",
                  "candidate", "known N", "found N", "error %");
  for (const KnownForce& force : forces) {
    const double norm = force.known.norm();
    const double error = norm > 0 ? 100 * (force.estimated - force.known).norm() / norm : NAN;
    text += fmt::format("{:<18} {:>10} {:>9.4f} {:>9.4f} {:>8.2f}\n", force.state, force.candidate,
                        norm, force.estimated.norm(), error);
  }
  return text;
}

std::string Judgement(const IdentifyReport& report) {
  const estimation::Identification& found = report.found;
  const double ratio = found.chi2 / found.degrees_of_freedom;
  double worst = 0;
  for (const KnownForce& force : report.forces) {
    const double norm = force.known.norm();
    if (norm > 0) worst = std::max(worst, (force.estimated - force.known).norm() / norm);
  }
  std::string text =
      fmt::format("\nchi2 {:.1f} of {} degrees of freedom: ", found.chi2, found.degrees_of_freedom);
  if (ratio <= kComfortable) {
    text += "what is left is less than the model errors allow for. The model fits.\n";
  } else if (ratio <= kUnexplained) {
    text += "what is left is as large as the model errors allow for. The model fits.\n";
  } else {
    text +=
        "what is left is more than the model errors allow for. Before you rely on the values,\n"
        "check that the weights hung where and when you said, the supports, the places of the\n"
        "markers on the body at rest, and the material model; a finer mesh may help, too.\n";
  }
  if (worst > kForcesAgree) {
    text += fmt::format(
        "No values bring all the known forces together: one is still {:.1f} % off. If it is one\n"
        "weight among several, compare their places and masses.\n",
        100 * worst);
  }
  return text;
}

}  // namespace

std::string IdentifyReport::BriefReport() const { return found.BriefReport(); }

std::string IdentifyReport::FullReport() const {
  std::string text;
  for (const std::string& warning : warnings) text += "warning: " + warning + "\n";
  if (found.status == estimation::Identification::Status::kNotRun) {
    return text + "nothing was identified\n";
  }
  if (!found.ok()) {
    text += "not usable: " + found.BriefReport() + "\n";
    if (found.status == estimation::Identification::Status::kUnobservable) {
      if (frames_left_out > 0) {
        text += fmt::format(
            "{} frames with known forces were left out, see above: it may show in those.\n",
            frames_left_out);
      }
      text += "Add frames in which it shows, or leave it as it is.\n";
    }
    if (found.status == estimation::Identification::Status::kInconsistent) {
      text +=
          "Check that the weights hung where and when you said, the supports, and the places of "
          "the markers.\n";
    }
    return found.states.empty() ? text : text + States(found.states);
  }
  text += Values(found) + States(found.states) + Forces(forces) + Judgement(*this);
  if (mesh_aim != MeshAim::kGiven) {
    text += fmt::format("The values are for runs with --correct-mesh {}.\n", Name(mesh_aim));
  }
  return text;
}

}  // namespace softforce::pipeline
