#include "pipeline/capture_source.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/camera_source.h"
#include "pipeline/open_recording.h"
#include "pipeline/refusals.h"
#include "softforce/base/input_error.h"
#include "softforce/scene/place_rig.h"

namespace softforce::pipeline {
namespace {

void RefuseCameraOptions(const RunOptions& options) {
  const auto refuse_if = [](bool given, const char* option, const char* advice) {
    if (!given) return;
    throw base::InputError(option, "goes with cameras, but the scene has motion capture", advice);
  };
  refuse_if(!options.sources.empty(), "--camera", "Name the file under \"measured\" in the scene.");
  refuse_if(!options.record.empty(), "--record", "The file is the recording.");
  refuse_if(!options.time_offsets_s.empty(), "--time-offset", "Leave it out.");
  refuse_if(options.overlay_width != RunOptions().overlay_width, "--overlay-width",
            "There are no pictures to draw on; --vtu shows the body in ParaView.");
}

}  // namespace

Standing PlaceOfCapture(const scene::Measured& measured) {
  Standing standing;
  standing.T_rig_robot = measured.T_rig_robot.value_or(Eigen::Isometry3d::Identity());
  standing.from = measured.T_rig_robot ? "scene" : "measured in the robot's frame";
  if (measured.rig.empty()) return standing;
  const scene::RigPlace place = scene::LoadPlace(measured.rig);
  standing.T_rig_robot = place.T_rig_robot;
  standing.covariance = place.covariance;
  standing.from = "rig_file";
  return standing;
}

CaptureSource::CaptureSource(const scene::Scene& scene, const RunOptions& options)
    : scene_(scene),
      options_(options),
      points_(scene::ReadMeasuredPoints(*scene.measured, scene.markers)) {
  RefuseCameraOptions(options);
  if (!options.out.empty()) RefuseToOverwrite(FilesOf(scene, {}), options.out);
  const int last = points_.frames.back().frame;
  if (options.first_frame > last) {
    throw base::InputError(
        "--frames", fmt::format("asks for frame {}, but the last in {} is {}", options.first_frame,
                                scene.measured->file.filename().string(), last));
  }
}

Standing CaptureSource::Start(const Tell&) {
  standing_ = PlaceOfCapture(*scene_.measured);
  return standing_;
}

bool CaptureSource::IsAskedFor(int frame) const {
  return frame >= options_.first_frame && frame < options_.end_frame &&
         (frame - options_.first_frame) % options_.every == 0;
}

bool CaptureSource::Next(FrameInWork* frame) {
  for (; next_ < points_.frames.size(); ++next_) {
    stopped_ = options_.stop != nullptr && *options_.stop;
    const scene::MeasuredFrame& next = points_.frames[next_];
    if (stopped_ || next.frame >= options_.end_frame ||
        next.time_s - points_.frames.front().time_s >= options_.duration_s) {
      return false;
    }
    if (!IsAskedFor(next.frame)) continue;
    frame->set.frame = next.frame;
    frame->set.time_s = next.time_s;
    frame->detections = {{{}, {}, next.points}};
    ++next_;
    return true;
  }
  return false;
}

// The points are what there is.
void CaptureSource::Detect(FrameInWork*) {}

void CaptureSource::Estimate(const World&, FrameInWork* frame, Tracker* tracker) {
  frame->result = tracker->Process(frame->set.frame, frame->set.time_s, frame->detections);
  frame->T_rig_robot = standing_.T_rig_robot;
  frame->u = tracker->state().u;
}

int CaptureSource::expected_frames() const {
  return static_cast<int>(
      std::count_if(points_.frames.begin(), points_.frames.end(),
                    [&](const scene::MeasuredFrame& frame) { return IsAskedFor(frame.frame); }));
}

std::vector<std::filesystem::path> CaptureSource::Inputs() const { return InputsOf(scene_, {}); }

std::vector<std::string> CaptureSource::ShortOf() const {
  if (!stopped_) return {};
  return {"stopped before the end of the recording"};
}

std::unique_ptr<MarkerSource> OpenMarkerSource(const scene::Scene& scene,
                                               const RunOptions& options) {
  if (scene.measured) return std::make_unique<CaptureSource>(scene, options);
  return std::make_unique<CameraSource>(scene, options);
}

}  // namespace softforce::pipeline
