#include "pipeline/run_advice.h"

#include <fmt/format.h>

#include <algorithm>

namespace softforce::pipeline {
namespace {

using report::RunAdvice;
using Status = estimation::ForceEstimate::Status;

constexpr double kPoorFit = 3;  // chi2 per degree of freedom; with 20 degrees 3 is one in 10⁵
constexpr double kOften = 0.5;  // of the frames: a marker that gives trouble in more stands wrong
constexpr double kManyHidden = 0.25;  // of all markers in all frames

// What to do when frames have no forces for a reason.
const char* Remedy(Status status) {
  switch (status) {
    case Status::kTooFewObservations:
      return "Add markers, or a camera that sees those that are hidden; or give candidates a "
             "direction, which leaves fewer unknowns.";
    case Status::kUnobservable:
      return "Use fewer candidates, give them directions, or put markers near each of them.";
    case Status::kInconsistent:
      return "See in the pictures whether the net lies on the body. If it does not: check the unit "
             "of the mesh, the rig and its place (softforce register). If it does: check the "
             "markers' positions in the scene, the supports and the material.";
    case Status::kNotConverged:
      return "The warnings say how far the load was reached. Check unit, supports and Young's "
             "modulus; record with a higher frame rate if the body moves far between frames.";
    case Status::kInvalidInput:
      return "Check the actuation table and the bounds of the forces.";
    default:
      return "The warnings say why.";
  }
}

void AboutFrames(const RunTally& tally, std::vector<RunAdvice>* advice) {
  for (const Status status :
       {Status::kInconsistent, Status::kNotConverged, Status::kUnobservable,
        Status::kTooFewObservations, Status::kInvalidInput, Status::kNotRun}) {
    const auto counted = tally.frame_statuses.find(estimation::Name(status));
    if (counted == tally.frame_statuses.end()) continue;
    advice->push_back({fmt::format("{} of {} frames have no forces: {}", counted->second,
                                   tally.report.frames, counted->first),
                       Remedy(status)});
  }
}

void AboutFit(const RunTally& tally, std::vector<RunAdvice>* advice) {
  std::vector<double> sorted = tally.reduced_chi2;
  if (sorted.empty()) return;
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[sorted.size() / 2];
  if (median < kPoorFit) return;
  advice->push_back(
      {fmt::format("The forces explain the markers badly: median χ² per degree of freedom {:.1f}",
                   median),
       "The bands are too narrow. Calibrate or register again, check material and supports, see "
       "with softforce mesh whether the mesh is fine enough, or raise --local-model-error."});
}

void AboutDoubt(const RunTally& tally, std::vector<RunAdvice>* advice) {
  if (tally.frames_in_doubt == 0) return;
  advice->push_back(
      {fmt::format("In {} of {} frames the number of forces, or the face they act on, is in doubt",
                   tally.frames_in_doubt, tally.report.usable_frames),
       "Put more markers near where forces act (softforce design says where), leave out candidates "
       "on faces that nothing touches, or give candidates a direction."});
}

void AboutMarkers(const RunTally& tally, const ReportLog& log, std::vector<RunAdvice>* advice) {
  constexpr auto kHidden = static_cast<size_t>(MarkerStatus::kHidden);
  constexpr auto kRejected = static_cast<size_t>(MarkerStatus::kRejected);
  const double frames = tally.report.frames;
  int hidden = 0;
  std::string rejected_ids;
  for (size_t m = 0; m < log.marker_ids().size(); ++m) {
    hidden += log.marker_frames()[m][kHidden];
    if (log.marker_frames()[m][kRejected] < kOften * frames) continue;
    rejected_ids += fmt::format("{}{}", rejected_ids.empty() ? "" : ", ", log.marker_ids()[m]);
  }
  if (!rejected_ids.empty()) {
    advice->push_back({"Rejected in most frames: marker " + rejected_ids,
                       "Check its position in the scene, and that its id stands on it."});
  }
  const double share = hidden / (frames * static_cast<double>(log.marker_ids().size()));
  if (share > kManyHidden) {
    advice->push_back({fmt::format("{:.0f} % of the markers were hidden", 100 * share),
                       "Move a camera or the light, or add a camera; the timeline shows which "
                       "markers and when."});
  }
}

}  // namespace

std::vector<RunAdvice> AdviceFor(const RunTally& tally, const ReportLog& log) {
  std::vector<RunAdvice> advice;
  AboutFrames(tally, &advice);
  AboutFit(tally, &advice);
  AboutDoubt(tally, &advice);
  AboutMarkers(tally, log, &advice);
  return advice;
}

}  // namespace softforce::pipeline
