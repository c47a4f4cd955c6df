#include <fmt/format.h>

#include "softforce/pipeline/run.h"

namespace softforce::pipeline {

std::string RunReport::BriefReport() const {
  return fmt::format("{} of {} frames with forces, {:.1f} s{}", usable_frames, frames, seconds,
                     usable ? "" : "; NOT USABLE");
}

std::string RunReport::FullReport() const {
  std::string text = BriefReport() + "\n";
  for (const std::string& warning : warnings) text += "warning: " + warning + "\n";
  if (last) {
    text += fmt::format("\nForces in frame {} ({:.3f} s)\n", last->frame, last->time_s);
    text += fmt::format("  {:>9}  {:>23}  {:>27}  {:>9}  {:>9}\n", "candidate", "place, mm",
                        "force, N", "norm, N", "sd, N");
    for (const ForceResult& force : last->forces) {
      const Eigen::Vector3d p = 1e3 * force.position;
      text += fmt::format(
          "  {:>9}  {:7.2f} {:7.2f} {:7.2f}  {:8.4f} {:8.4f} {:9.4f}  {:9.4f}  {:9.4f}\n",
          force.candidate, p.x(), p.y(), p.z(), force.force.x(), force.force.y(), force.force.z(),
          force.force.norm(), force.NormSd());
    }
  }
  return text + "\nResults: " + out.string() + "\n";
}

}  // namespace softforce::pipeline
