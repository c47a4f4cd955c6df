#include "pipeline/camera_source.h"

#include "softforce/scene/rig_file.h"

namespace softforce::pipeline {
namespace {

constexpr char kMoved[] = "the rig or the body has moved, and no fiducials are in view";

}  // namespace

CameraSource::CameraSource(const scene::Scene& scene, const RunOptions& options)
    : scene_(scene),
      options_(options),
      rig_(scene::LoadRig(scene.cameras.rig)),
      feed_(scene_, rig_, options),
      detector_(scene_, rig_),
      oddities_(scene_, rig_) {}

Standing CameraSource::Start(const Tell& tell) {
  feed_.Start(tell);
  Standing standing = FindRig(scene_, rig_, Detector(scene_, rig_), feed_.FirstFrames());
  watch_.emplace(scene_, rig_, standing, options_.registration_frames, tell);
  return standing;
}

bool CameraSource::Next(FrameInWork* frame) {
  std::optional<vision::FrameSet> set = feed_.Next();
  if (set) frame->set = std::move(*set);
  return set.has_value();
}

// Tags are followed from frame to frame; dots are a function of the frame alone.
Stage::Order CameraSource::DetectOrder() const {
  return scene_.markers.type == scene::MarkerType::kDot ? Stage::Order::kAny
                                                        : Stage::Order::kInOrder;
}

// The places are those of the first frames, also after a bump.
void CameraSource::Detect(FrameInWork* frame) {
  frame->detections = detector_.Markers(frame->set);
  if (options_.watch_rig == 0 || frame->set.frame % options_.watch_rig != 0) return;
  frame->fiducials = detector_.FiducialsNear(frame->set, frame->detections, watch_->places());
}

void CameraSource::Estimate(const World& world, FrameInWork* frame, Tracker* tracker) {
  const int number = frame->set.frame;
  const RigWatch::Verdict verdict = watch_->Look(number, frame->fiducials);
  const Standing& standing = watch_->standing();
  if (verdict.placed_anew) tracker->PlaceRig(standing.T_rig_robot, standing.covariance);
  const bool worth_it = options_.watch_rig == 0 || watch_->WorthATry(frame->detections);
  const double time_s = frame->set.time_s;
  frame->result = !verdict.trusted ? tracker->Skip(number, time_s, verdict.reason)
                  : !worth_it      ? tracker->Skip(number, time_s, kMoved)
                                   : tracker->Process(number, time_s, frame->detections);
  oddities_.Add(frame->detections);
  frame->T_rig_robot = standing.T_rig_robot;
  frame->u = tracker->state().u;
  if (options_.watch_rig == 0 || !verdict.trusted || !worth_it) return;
  watch_->LookAtMarkers({number, frame->result.status == estimation::ForceEstimate::Status::kOk,
                         frame->detections, tracker->observations(), world.mesh().nodes, frame->u,
                         options_.tracker.estimator.common_model_error, standing});
}

std::vector<RigEvent> CameraSource::RigEvents() const {
  return watch_ ? watch_->events() : std::vector<RigEvent>();
}

std::vector<std::string> CameraSource::Messages() const {
  std::vector<std::string> messages = feed_.Messages();
  for (const RigEvent& event : RigEvents()) messages.push_back(event.text);
  for (std::string& message : oddities_.Messages()) messages.push_back(std::move(message));
  return messages;
}

}  // namespace softforce::pipeline
