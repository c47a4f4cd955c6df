#include <fmt/format.h>

#include "softforce/pipeline/run.h"

namespace softforce::pipeline {
namespace {

std::string StageTable(const std::vector<StageTimes>& stages, double seconds) {
  std::string text = fmt::format("\n  {:<9}  {:>10}  {:>8}  {:>8}  {:>6}  {:>14}\n", "stage",
                                 "median, ms", "95 %, ms", "max, ms", "busy", "waiting, mean");
  for (const StageTimes& stage : stages) {
    text += fmt::format("  {:<9}  {:>10.1f}  {:>8.1f}  {:>8.1f}  {:>4.0f} %", stage.stage,
                        stage.median_ms, stage.p95_ms, stage.max_ms,
                        seconds > 0 ? 100 * stage.total_s / seconds : 0);
    if (stage.queued) text += fmt::format("  {:>6.1f} (max {})", stage.queue_mean, stage.queue_max);
    text += "\n";
  }
  return text;
}

}  // namespace

std::string RunReport::BriefReport() const {
  return fmt::format("{} of {} frames with forces, {:.1f} s, {:.1f} frames/s{}", usable_frames,
                     frames, seconds, seconds > 0 ? frames / seconds : 0,
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
  if (frames > 0) text += StageTable(stages, seconds);
  if (live) text += "\n" + source.FullReport();
  if (recorded) text += "\nRecorded: " + recorded->BriefReport() + "\n";
  if (!has_pictures) text += "\nThe scene has no cameras, so there is no overlay.mp4.\n";
  return text + "\nResults: " + out.string() + "\n";
}

}  // namespace softforce::pipeline
