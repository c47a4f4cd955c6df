#include "pipeline/run_job.h"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/stdout_color_sinks.h>

#include <algorithm>
#include <chrono>

#include "pipeline/error_index.h"
#include "pipeline/refusals.h"
#include "pipeline/summary_file.h"
#include "softforce/scene/rig_file.h"

namespace softforce::pipeline {
namespace {

// Of a recording; enough that the threads go on drawing while one frame takes long to estimate.
constexpr int kFramesPerThread = 4;
constexpr int kLiveFramesWaiting = 2;
constexpr char kMoved[] = "the rig or the body has moved, and no fiducials are in view";

std::optional<MeshCorrection> CorrectionFor(const scene::Scene& scene, const RunOptions& options) {
  if (options.mesh_aim == MeshAim::kGiven) return std::nullopt;
  return CorrectMesh(scene, options.mesh_aim, options.show_progress);
}

TrackerOptions Corrected(TrackerOptions options, const std::optional<MeshCorrection>& correction) {
  if (!correction) return options;
  options.estimator.common_model_error *= correction->model_error_factor;
  options.estimator.local_model_error *= correction->model_error_factor;
  return options;
}

}  // namespace

// The cameras are opened when all else is ready, for they do not wait.
RunJob::RunJob(const std::filesystem::path& scene_file, const RunOptions& options)
    : options_(options),
      scene_(scene::LoadScene(scene_file)),
      rig_(scene::LoadRig(scene_.cameras.rig)),
      feed_(scene_, rig_, options),
      correction_(CorrectionFor(scene_, options)),
      world_(correction_ ? BuildWorld(correction_->scene, correction_->mesh) : BuildWorld(scene_)),
      index_w_(IndexW(world_)),
      detector_(scene_),
      standing_(PlaceRig()),
      tracker_(scene_, world_, rig_, standing_.T_rig_robot, standing_.covariance,
               Corrected(options.tracker, correction_)),
      watch_(scene_, rig_, standing_, options.registration_frames,
             options.show_progress ? base::TellBesideProgress : SourceWatch::Tell()) {}

Standing RunJob::PlaceRig() {
  feed_.Start(options_.show_progress ? base::TellBesideProgress : SourceWatch::Tell());
  return FindRig(scene_, rig_, Detector(scene_), feed_.FirstFrames());
}

// A function of the frame alone: the places are those of the first frames, also after a bump.
void RunJob::Detect(FrameInWork* frame) {
  frame->detections = detector_.Markers(frame->set);
  if (options_.watch_rig == 0 || frame->set.frame % options_.watch_rig != 0) return;
  frame->fiducials = detector_.FiducialsNear(frame->set, frame->detections, watch_.places());
}

void RunJob::Estimate(FrameInWork* frame) {
  const int number = frame->set.frame;
  const RigWatch::Verdict verdict = watch_.Look(number, frame->fiducials);
  const Standing& standing = watch_.standing();
  if (verdict.placed_anew) tracker_.PlaceRig(standing.T_rig_robot, standing.covariance);
  const bool worth_it = options_.watch_rig == 0 || watch_.WorthATry(frame->detections);
  const double time_s = frame->set.time_s;
  frame->result = !verdict.trusted ? tracker_.Skip(number, time_s, verdict.reason)
                  : !worth_it      ? tracker_.Skip(number, time_s, kMoved)
                                   : tracker_.Process(number, time_s, frame->detections);
  frame->T_rig_robot = standing.T_rig_robot;
  frame->u = tracker_.state().u;
  if (options_.watch_rig == 0 || !verdict.trusted || !worth_it) return;
  watch_.LookAtMarkers({number, frame->result.status == estimation::ForceEstimate::Status::kOk,
                        frame->detections, tracker_.observations(), world_.mesh().nodes, frame->u,
                        options_.tracker.estimator.common_model_error, standing});
}

std::vector<Stage> RunJob::Stages(RunOutputs* outputs, base::Progress* progress) {
  using Order = Stage::Order;
  std::vector<Stage> stages{
      {"detect", Order::kAny, [this](FrameInWork* frame) { Detect(frame); }},
      {"estimate", Order::kInOrder, [this](FrameInWork* frame) { Estimate(frame); }}};
  for (Stage& stage : outputs->Stages()) stages.push_back(std::move(stage));
  stages.push_back({"report", Order::kInOrder, [this, progress](FrameInWork* frame) {
                      tally_.Add(frame->result);
                      if (progress != nullptr) progress->Update(tally_.report.frames, Note());
                    }});
  return stages;
}

std::string RunJob::Note() const {
  if (!feed_.live()) return "";
  const vision::SourceReport source = feed_.Report();
  return fmt::format("{} waiting, {} dropped", source.queued, source.dropped);
}

void RunJob::ProcessFrames(RunOutputs* outputs) {
  base::Progress progress("frames", feed_.expected_frames());
  const FrameInput input{feed_.live() ? "capture" : "decode", [this](FrameInWork* frame) {
                           std::optional<vision::FrameSet> set = feed_.Next();
                           if (set) frame->set = std::move(*set);
                           return set.has_value();
                         }};
  const std::vector<Stage> stages = Stages(outputs, options_.show_progress ? &progress : nullptr);
  const int threads = options_.threads > 0 ? options_.threads : DefaultThreads();
  if (feed_.live()) {
    // One more, which mostly waits for the cameras; and no more frames than are at work, for what
    // waits here is old when its turn comes.
    RunStages(input, stages, threads + 1, threads + kLiveFramesWaiting, &clock_);
  } else {
    RunStages(input, stages, threads, kFramesPerThread * threads, &clock_);
  }
  if (options_.show_progress) progress.Finish();
}

void RunJob::WriteSummaryFile() {
  RunFacts facts{scene_,    options_, tally_,         world_,         correction_,
                 standing_, index_w_, feed_.Inputs(), watch_.events()};
  WriteSummary(facts, options_.out / "summary.json");
}

void RunJob::LogSetUp() const {
  if (!options_.show_progress) return;
  spdlog::logger log("softforce", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  log.set_pattern("%n: %v");
  log.info("{}: {} cells of order {}, {} nodes; {} markers, {} forces, {} cables", scene_.name,
           world_.mesh().num_elements(), world_.mesh().order(), world_.mesh().num_nodes(),
           world_.markers.size(), world_.sites.size(), scene_.actuators.size());
  if (!standing_.from_fiducials) return;
  const vision::RigPose& pose = *standing_.from_fiducials;
  log.info("the rig is placed by {} corners of fiducials, which fit to {:.3f} px", pose.num_points,
           pose.rms_px);
}

RunReport RunJob::Finish() {
  const auto start = std::chrono::steady_clock::now();
  PrepareFolder(options_.out);
  LogSetUp();
  RunOutputs outputs(options_, scene_, world_, rig_);

  ProcessFrames(&outputs);
  feed_.Finish();

  RunReport& report = tally_.report;
  report.out = options_.out;
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.stages = clock_.Report();
  report.live = feed_.live();
  report.source = feed_.Report();
  report.recorded = feed_.Recorded();
  std::vector<std::string> messages = feed_.Messages();
  for (const RigEvent& event : watch_.events()) messages.push_back(event.text);
  tally_.Judge(messages, feed_.ShortOf());
  outputs.Commit();
  WriteSummaryFile();
  return report;
}

}  // namespace softforce::pipeline
