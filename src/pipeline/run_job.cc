#include "pipeline/run_job.h"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/stdout_color_sinks.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "pipeline/candidate_count.h"
#include "pipeline/error_index.h"
#include "pipeline/refusals.h"
#include "pipeline/run_page.h"
#include "pipeline/source_watch.h"
#include "pipeline/summary_file.h"

namespace softforce::pipeline {
namespace {

// Of a recording; enough that the threads go on drawing while one frame takes long to estimate.
constexpr int kFramesPerThread = 4;
constexpr int kLiveFramesWaiting = 2;
constexpr std::chrono::milliseconds kPausePoll{20};

spdlog::logger Logger() {
  spdlog::logger log("softforce", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  log.set_pattern("%n: %v");
  return log;
}

// To the screen alone: who reads it may stop the run.
void TellAddress(const LiveView& view) {
  Logger().info("live page: {}#token={}", view.Url(), view.token());
}

}  // namespace

// Cameras are opened when all else is ready, for they do not wait.
RunJob::RunJob(const std::filesystem::path& scene_file, const RunOptions& options)
    : options_(options),
      scene_(scene::LoadScene(scene_file)),
      source_(OpenMarkerSource(scene_, options)),
      correction_(CorrectMesh(scene_, options.mesh_aim, options.show_progress)),
      world_(BuildWorld(scene_, correction_)),
      index_w_(IndexW(world_)),
      standing_(
          source_->Start(options.show_progress ? base::TellBesideProgress : SourceWatch::Tell())),
      tracker_(scene_, world_, source_->rig(), standing_.T_rig_robot, standing_.covariance,
               Corrected(options.tracker, correction_)),
      tare_(options.controls) {}

std::vector<Stage> RunJob::Stages(RunOutputs* outputs, base::Progress* progress) {
  using Order = Stage::Order;
  std::vector<Stage> stages{
      {"detect", source_->DetectOrder(), [this](FrameInWork* frame) { source_->Detect(frame); }},
      {"estimate", Order::kInOrder, [this](FrameInWork* frame) {
         source_->Estimate(world_, frame, &tracker_);
         tare_.Apply(&frame->result);
       }}};
  for (Stage& stage : outputs->Stages()) stages.push_back(std::move(stage));
  stages.push_back({"report", Order::kInOrder, [this, progress](FrameInWork* frame) {
                      tally_.Add(frame->result);
                      if (live_view_) live_view_->Show(*frame);
                      if (live_window_) live_window_->Show(*frame);
                      if (progress != nullptr) progress->Update(tally_.report.frames, Note());
                    }});
  return stages;
}

std::string RunJob::Note() const {
  if (!source_->live()) return "";
  const vision::SourceReport source = source_->Report();
  return fmt::format("{} waiting, {} dropped", source.queued, source.dropped);
}

bool RunJob::Next(FrameInWork* frame) {
  const auto stopped = [&] { return options_.stop != nullptr && *options_.stop; };
  while (options_.controls != nullptr && options_.controls->pause && !stopped()) {
    std::this_thread::sleep_for(kPausePoll);
  }
  const bool more = source_->Next(frame);
  frame->taken_up = std::chrono::steady_clock::now();
  return more;
}

void RunJob::ProcessFrames(RunOutputs* outputs) {
  base::Progress progress("frames", source_->expected_frames());
  const FrameInput input{source_->StageName(), [this](FrameInWork* frame) { return Next(frame); }};
  const std::vector<Stage> stages = Stages(outputs, options_.show_progress ? &progress : nullptr);
  const int threads = options_.threads > 0 ? options_.threads : DefaultThreads();
  if (source_->live()) {
    // One more, which mostly waits for the cameras; and no more frames than are at work, for what
    // waits here is old when its turn comes.
    RunStages(input, stages, threads + 1, threads + kLiveFramesWaiting, &clock_);
  } else {
    RunStages(input, stages, threads, kFramesPerThread * threads, &clock_);
  }
  if (options_.show_progress) progress.Finish();
}

void RunJob::WriteSummaries(const RunOutputs& outputs) {
  const RunFacts facts{scene_,
                       options_,
                       tally_,
                       world_,
                       correction_,
                       standing_,
                       index_w_,
                       DescribeInputs(source_->Inputs()),
                       source_->RigEvents()};
  WriteSummary(facts, options_.out / "summary.json");
  if (outputs.log()) WriteRunPage(facts, *outputs.log(), options_.out / "report.html");
}

void RunJob::LogSetUp() const {
  if (!options_.show_progress) return;
  spdlog::logger log = Logger();
  log.info("{}: {} cells of order {}, {} nodes; {} markers, {} forces, {} cables", scene_.name,
           world_.mesh().num_elements(), world_.mesh().order(), world_.mesh().num_nodes(),
           world_.markers.size(), world_.sites.size(), scene_.actuators.size());
  if (!scene_.forces.known_locations) {
    const CandidateCount count = CountCandidates(world_);
    log.info("{}", count.Brief());
    if (!count.enough()) log.warn("{}", count.Warning());
  }
  if (!standing_.from_fiducials) return;
  const vision::RigPose& pose = *standing_.from_fiducials;
  log.info("the rig is placed by {} corners of fiducials, which fit to {:.3f} px", pose.num_points,
           pose.rms_px);
}

RunReport RunJob::Finish() {
  const auto start = std::chrono::steady_clock::now();
  if (options_.serve_port) {
    live_view_.emplace(options_, scene_, world_, *source_, clock_);
    TellAddress(*live_view_);
  }
  if (options_.view) live_window_.emplace(options_, scene_, world_, *source_);
  PrepareFolder(options_.out);
  LogSetUp();
  const CandidateCount count = CountCandidates(world_);
  if (!scene_.forces.known_locations && !count.enough()) {
    tally_.report.warnings.push_back(count.Warning());
  }
  RunOutputs outputs(options_, scene_, world_, source_->rig());

  ProcessFrames(&outputs);
  live_window_.reset();
  source_->Finish();

  RunReport& report = tally_.report;
  report.out = options_.out;
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.stages = clock_.Report();
  report.live = source_->live();
  report.source = source_->Report();
  report.recorded = source_->Recorded();
  report.has_pictures = !source_->rig().cameras.empty();
  std::vector<std::string> messages = source_->Messages();
  messages.insert(messages.end(), tare_.messages().begin(), tare_.messages().end());
  tally_.Judge(messages, source_->ShortOf());
  outputs.Commit();
  WriteSummaries(outputs);
  if (live_view_) live_view_->End(report);
  return report;
}

}  // namespace softforce::pipeline
