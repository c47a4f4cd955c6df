#include "softforce/pipeline/run.h"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/stdout_color_sinks.h>

#include <Eigen/QR>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "pipeline/mesh_correction.h"
#include "pipeline/open_recording.h"
#include "pipeline/overlay_video.h"
#include "pipeline/refusals.h"
#include "pipeline/registration.h"
#include "pipeline/result_tables.h"
#include "pipeline/stage_clock.h"
#include "pipeline/summary_file.h"
#include "pipeline/vtu_series.h"
#include "softforce/base/input_error.h"
#include "softforce/base/progress.h"
#include "softforce/scene/rig_file.h"

namespace softforce::pipeline {
namespace {

constexpr int kMaxFrameWarnings = 20;  // about single frames; the rest is counted

// I_w = ‖W_ef⁺‖₁ of the paper (VI.A) for the body at rest: how much an error of the markers can be
// amplified.
double IndexW(const World& world) {
  estimation::ForceEstimator estimator(world.solver.get(), world.sites);
  if (!estimator.Advance(fem::NoActuation(world.solver->body())).ok()) return NAN;
  Eigen::MatrixXd W(3 * world.markers.size(), estimator.num_components());
  for (size_t m = 0; m < world.markers.size(); ++m) {
    W.middleRows<3>(3 * static_cast<Eigen::Index>(m)) =
        estimator.Compliance(world.markers[m].weights);
  }
  if (W.rows() < W.cols()) return NAN;
  const Eigen::MatrixXd inverse = W.completeOrthogonalDecomposition().pseudoInverse();
  return inverse.cwiseAbs().colwise().sum().maxCoeff();
}

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

// A run in progress: what is known before the first frame, and what the frames add up to.
class Job {
 public:
  Job(const std::filesystem::path& scene_file, const RunOptions& options)
      : options_(options),
        scene_(scene::LoadScene(scene_file)),
        rig_(scene::LoadRig(scene_.cameras.rig)),
        sources_(SourcesOf(scene_, options.sources)),
        recording_(Open()),
        correction_(CorrectionFor(scene_, options)),
        world_(correction_ ? BuildWorld(correction_->scene, correction_->mesh)
                           : BuildWorld(scene_)),
        detector_(scene_),
        standing_(FindRig(scene_, rig_, detector_, options.registration_frames, &recording_)),
        index_w_(IndexW(world_)),
        tracker_(scene_, world_, rig_, standing_.T_rig_robot, standing_.covariance,
                 Corrected(options.tracker, correction_)) {}

  RunReport Finish();

 private:
  vision::Recording Open() const;
  void ProcessFrames(ResultTables* tables, OverlayVideo* overlay, VtuSeries* series);
  FrameResult ProcessFrame(const vision::FrameSet& frame);
  void Judge();
  void LogSetUp() const;
  void WriteSummaryFile();

  const RunOptions& options_;
  const scene::Scene scene_;
  const camera::Rig rig_;
  const std::vector<vision::Recording::Source> sources_;
  vision::Recording recording_;
  const std::optional<MeshCorrection> correction_;
  const World world_;
  const Detector detector_;
  const Standing standing_;
  const double index_w_;
  Tracker tracker_;

  StageClock clock_;
  RunReport report_;
  std::map<std::string, int> frame_statuses_, marker_statuses_;
  bool stopped_ = false;              // from outside, before the end
  std::vector<double> reduced_chi2_;  // of each frame with forces
};

vision::Recording Job::Open() const {
  RefuseToOverwrite(FilesOf(scene_, sources_), options_.out);
  return OpenRecording(scene_, rig_, sources_, options_.first_frame, "--frames");
}

FrameResult Job::ProcessFrame(const vision::FrameSet& frame) {
  const auto detections = clock_.Measure("detect", [&] { return detector_.Markers(frame); });
  FrameResult result = clock_.Measure(
      "estimate", [&] { return tracker_.Process(frame.frame, frame.time_s, detections); });
  ++report_.frames;
  ++frame_statuses_[estimation::Name(result.status)];
  for (const MarkerResult& marker : result.markers) ++marker_statuses_[Name(marker.status)];
  if (!result.forces.empty()) {
    ++report_.usable_frames;
    report_.last = result;
  } else if (report_.frames - report_.usable_frames <= kMaxFrameWarnings) {
    report_.warnings.push_back(fmt::format("frame {}: {}: {}", result.frame,
                                           estimation::Name(result.status), result.reason));
  }
  if (!result.forces.empty() && result.degrees_of_freedom > 0) {
    reduced_chi2_.push_back(result.chi2 / result.degrees_of_freedom);
  }
  return result;
}

void Job::ProcessFrames(ResultTables* tables, OverlayVideo* overlay, VtuSeries* series) {
  const int last = std::min(options_.end_frame, recording_.announced_frames());
  base::Progress progress("frames", last - options_.first_frame);
  while (true) {
    stopped_ = options_.stop != nullptr && *options_.stop;
    if (stopped_) break;
    const auto frame = clock_.Measure("decode", [&] { return recording_.Next(); });
    if (!frame || frame->frame >= options_.end_frame) break;
    if (frame->frame < options_.first_frame) continue;
    const FrameResult result = ProcessFrame(*frame);
    clock_.Measure("write", [&] { tables->Add(result); });
    if (overlay != nullptr) {
      clock_.Measure("overlay", [&] { overlay->Add(*frame, result, tracker_.state().u); });
    }
    if (series != nullptr) {
      clock_.Measure("vtu", [&] {
        series->Add(frame->frame, frame->time_s, world_.mesh(), tracker_.state().u);
      });
    }
    if (options_.show_progress) progress.Update(report_.frames);
  }
  if (options_.show_progress) progress.Finish();
}

void Job::Judge() {
  const int untold = report_.frames - report_.usable_frames - kMaxFrameWarnings;
  if (untold > 0) report_.warnings.push_back(fmt::format("{} more frames without forces", untold));
  if (!recording_.truncation().empty()) report_.warnings.push_back(recording_.truncation());
  if (stopped_) report_.warnings.push_back("stopped before the end of the recording");
  if (report_.frames == 0) report_.warnings.push_back("no frame was processed");
  const bool mostly = 2 * report_.usable_frames > report_.frames;
  if (!mostly && report_.frames > 0) {
    report_.warnings.push_back(fmt::format("forces were found in only {} of {} frames",
                                           report_.usable_frames, report_.frames));
  }
  report_.usable = mostly && !stopped_ && recording_.truncation().empty();
}

void Job::WriteSummaryFile() {
  RunFacts facts{scene_,          options_,         report_,
                 world_,          correction_,      standing_.from_fiducials,
                 frame_statuses_, marker_statuses_, index_w_,
                 reduced_chi2_,   clock_.Report(),  InputsOf(scene_, sources_)};
  WriteSummary(facts, options_.out / "summary.json");
}

void Job::LogSetUp() const {
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

RunReport Job::Finish() {
  const auto start = std::chrono::steady_clock::now();
  PrepareFolder(options_.out);
  LogSetUp();
  const fem::Body& body = world_.solver->body();
  ResultTables tables(options_.out, {!body.cables.empty(), !body.chambers.empty()});
  std::optional<OverlayVideo> overlay;
  if (options_.overlay) {
    overlay.emplace(options_.out / "overlay.mp4", scene_, world_, rig_, standing_.T_rig_robot,
                    options_.overlay_width);
  }
  std::optional<VtuSeries> series;
  if (options_.vtu) series.emplace(options_.out);

  ProcessFrames(&tables, overlay ? &*overlay : nullptr, series ? &*series : nullptr);

  report_.out = options_.out;
  report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Judge();
  tables.Commit();
  if (overlay) overlay->Commit();
  if (series) series->Commit();
  WriteSummaryFile();
  return report_;
}

}  // namespace

void RunOptions::Check() const {
  if (first_frame < 0 || end_frame <= first_frame) {
    throw base::InputError("--frames",
                           fmt::format("{}:{} is no range of frames", first_frame, end_frame),
                           "Give A:B with 0 <= A < B: frames A up to but not including B.");
  }
  if (registration_frames < 1) {
    throw base::InputError("--registration-frames", "must be 1 or more");
  }
  if (overlay_width < 64) throw base::InputError("--overlay-width", "must be 64 px or more");
  tracker.Check();
}

RunReport Run(const std::filesystem::path& scene_file, const RunOptions& options) {
  options.Check();
  Job job(scene_file, options);
  return job.Finish();
}

}  // namespace softforce::pipeline
