#include "pipeline/run_tally.h"

#include <fmt/format.h>

namespace softforce::pipeline {
namespace {

constexpr int kMaxFrameWarnings = 20;   // about single frames; the rest is counted
constexpr double kWithoutDoubt = 0.99;  // probability
constexpr double kAlone = 0.02;         // share of a camera's pictures that is worth a warning

}  // namespace

void RunTally::Add(const FrameResult& result) {
  ++report.frames;
  ++frame_statuses[estimation::Name(result.status)];
  for (const MarkerResult& marker : result.markers) {
    ++marker_statuses[Name(marker.status)];
    const bool hidden = marker.status == MarkerStatus::kHidden;
    if (hidden && marker.expected_absent) ++markers_expected_absent;
  }
  if (result.ok()) {
    ++report.usable_frames;
    if (!result.forces.empty()) report.last = result;
    if (result.probability < kWithoutDoubt) ++frames_in_doubt;
    if (result.degrees_of_freedom > 0) {
      reduced_chi2.push_back(result.chi2 / result.degrees_of_freedom);
    }
  } else if (report.frames - report.usable_frames <= kMaxFrameWarnings) {
    report.warnings.push_back(fmt::format("frame {}: {}: {}", result.frame,
                                          estimation::Name(result.status), result.reason));
  }
}

void RunTally::WarnOfCameras() {
  const vision::SourceReport& source = report.source;
  if (source.dropped > 0) {
    report.warnings.push_back(fmt::format(
        "{} of {} sets of pictures were dropped: they came faster than they could be processed",
        source.dropped, source.dropped + source.delivered));
  }
  for (const vision::CameraReport& camera : source.cameras) {
    const auto alone = static_cast<double>(camera.unpaired + camera.unsure);
    if (alone <= kAlone * static_cast<double>(camera.received)) continue;
    report.warnings.push_back(
        fmt::format("camera \"{}\": of {} pictures {} had no partner, and {} came at a time too "
                    "uncertain to find one",
                    camera.camera, camera.received, camera.unpaired, camera.unsure));
  }
}

void RunTally::Judge(const std::vector<std::string>& messages,
                     const std::vector<std::string>& short_of) {
  const int untold = report.frames - report.usable_frames - kMaxFrameWarnings;
  if (untold > 0) report.warnings.push_back(fmt::format("{} more frames without forces", untold));
  if (frames_in_doubt > 0) {
    report.warnings.push_back(fmt::format(
        "in {} of {} frames another number of forces, or another face of the body, explains the "
        "markers nearly as well: see probability and alternatives in locations.csv",
        frames_in_doubt, report.usable_frames));
  }
  report.warnings.insert(report.warnings.end(), messages.begin(), messages.end());
  if (report.live) WarnOfCameras();
  report.warnings.insert(report.warnings.end(), short_of.begin(), short_of.end());
  if (report.frames == 0) report.warnings.push_back("no frame was processed");
  const bool mostly = 2 * report.usable_frames > report.frames;
  if (!mostly && report.frames > 0) {
    report.warnings.push_back(fmt::format("forces were found in only {} of {} frames",
                                          report.usable_frames, report.frames));
  }
  report.usable = mostly && short_of.empty();
}

}  // namespace softforce::pipeline
