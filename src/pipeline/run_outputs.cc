#include "pipeline/run_outputs.h"

#include <algorithm>

namespace softforce::pipeline {
namespace {

TableKinds KindsOf(const scene::Scene& scene, const World& world) {
  const fem::Body& body = world.solver->body();
  return {!body.cables.empty(), !body.chambers.empty(), !scene.forces.known_locations};
}

}  // namespace

RunOutputs::RunOutputs(const RunOptions& options, const scene::Scene& scene, const World& world,
                       const camera::Rig& rig)
    : world_(world), tables_(options.out, KindsOf(scene, world)) {
  if (options.overlay && !rig.cameras.empty()) {
    overlay_.emplace(options.out / "overlay.mp4", scene, world, rig, options.overlay_width,
                     options.layers);
  }
  if (options.frames && !rig.cameras.empty()) {
    frames_.emplace(options.out / kFrameFile, world.mesh().num_nodes());
  }
  if (options.vtu) series_.emplace(options.out);
  if (options.report) log_.emplace(world);
}

std::vector<Stage> RunOutputs::Stages() {
  using Order = Stage::Order;
  std::vector<Stage> stages;
  stages.push_back({"write", Order::kInOrder, [this](FrameInWork* frame) {
                      tables_.Add(frame->result);
                      largest_displacement_ =
                          std::max(largest_displacement_, frame->u.colwise().norm().maxCoeff());
                      frame->largest_displacement = largest_displacement_;
                      if (frames_) frames_->Add(*frame);
                    }});
  if (overlay_ && overlay_->wants_stress()) {
    stages.push_back(
        {"stress", Order::kInOrder, [this](FrameInWork* frame) { overlay_->AddStress(frame); }});
  }
  if (overlay_) {
    stages.push_back({"draw", Order::kAny,
                      [this](FrameInWork* frame) { frame->overlay = overlay_->Draw(*frame); }});
    stages.push_back(
        {"overlay", Order::kInOrder, [this](FrameInWork* frame) { overlay_->Add(*frame); }});
  }
  if (series_) {
    stages.push_back({"vtu", Order::kInOrder,
                      [this](FrameInWork* frame) { series_->Add(*frame, world_.solver->body()); }});
  }
  if (log_) {
    stages.push_back({"page", Order::kInOrder, [this](FrameInWork* frame) { log_->Add(*frame); }});
  }
  return stages;
}

void RunOutputs::Commit() {
  tables_.Commit();
  if (frames_) frames_->Commit();
  if (overlay_) overlay_->Commit();
  if (series_) series_->Commit();
}

}  // namespace softforce::pipeline
