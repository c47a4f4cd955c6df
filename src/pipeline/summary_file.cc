#include "pipeline/summary_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipeline/frame_pipeline.h"
#include "pipeline/input_paths.h"
#include "pipeline/open_recording.h"
#include "pipeline/result_tables.h"
#include "softforce/base/version.h"

namespace softforce::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json Matrix(const Eigen::MatrixXd& m) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < m.cols(); ++c) row.push_back(m(r, c));
    rows.push_back(row);
  }
  return rows;
}

// "from": what told it.
Json Place(const char* from, const Eigen::Isometry3d& T_rig_robot,
           const geometry::Matrix6d& covariance) {
  const Eigen::VectorXd sd = covariance.diagonal().cwiseSqrt();
  return {{"from", from},
          {"T_rig_robot", Matrix(T_rig_robot.matrix())},
          {"sd_translation_mm", {1e3 * sd(0), 1e3 * sd(1), 1e3 * sd(2)}},
          {"sd_rotation_mrad", {1e3 * sd(3), 1e3 * sd(4), 1e3 * sd(5)}}};
}

Json Registration(const vision::RigPose& pose) {
  Json json = Place("fiducials", pose.T_rig_robot, pose.covariance);
  json["points"] = pose.num_points;
  json["reprojection_rms_px"] = pose.rms_px;
  return json;
}

Json Registration(const Standing& standing) {
  if (standing.from_fiducials) return Registration(*standing.from_fiducials);
  return Place(standing.from.c_str(), standing.T_rig_robot, standing.covariance);
}

Json Event(const RigEvent& event) {
  Json json{{"event", Name(event.kind)}, {"frame", event.frame}, {"told_in_frame", event.told}};
  if (event.pose) json["registration"] = Registration(*event.pose);
  return json;
}

Json Live(const vision::SourceReport& source) {
  Json live{{"sets_delivered", source.delivered}, {"sets_dropped", source.dropped}};
  for (const vision::CameraReport& camera : source.cameras) {
    live["cameras"][camera.camera] = {{"received", camera.received}, {"paired", camera.paired},
                                      {"unpaired", camera.unpaired}, {"unsure", camera.unsure},
                                      {"missed", camera.missed},     {"reopened", camera.reopened}};
  }
  return live;
}

// Where the inputs are, for `render`. Of live cameras the recording that was made, if one was.
Json Files(const RunFacts& facts) {
  Json files{{"scene", PathToKeep(facts.scene.file, facts.options.out)}};
  if (facts.scene.measured) return files;
  const bool recorded = facts.tally.report.live && facts.tally.report.recorded;
  for (const vision::Recording::Source& source : SourcesOf(facts.scene, facts.options.sources)) {
    if (facts.tally.report.live && !recorded) {
      files["cameras"][source.camera] = {{"live", source.file.string()}};
    } else {
      files["cameras"][source.camera] = PathToKeep(
          recorded ? facts.options.record / source.camera : source.file, facts.options.out);
    }
  }
  return files;
}

void AddStages(const std::vector<StageTimes>& stages, Json* json) {
  for (const StageTimes& stage : stages) {
    (*json)["stages_ms"][stage.stage] = {{"count", stage.count}, {"median", stage.median_ms},
                                         {"p90", stage.p90_ms},  {"p95", stage.p95_ms},
                                         {"p99", stage.p99_ms},  {"max", stage.max_ms}};
  }
  for (const StageTimes& stage : stages) {
    if (!stage.queued) continue;
    (*json)["queues"][stage.stage] = {{"mean", stage.queue_mean}, {"max", stage.queue_max}};
  }
}

}  // namespace

void WriteSummary(const RunFacts& facts, const std::filesystem::path& file) {
  Json json;
  json["softforce"] = base::kVersion;
  json["scene"] = facts.scene.name;
  json["files"] = Files(facts);
  json["usable"] = facts.tally.report.usable;
  json["frames"] = {{"processed", facts.tally.report.frames},
                    {"with_forces", facts.tally.report.usable_frames},
                    {"by_status", facts.tally.frame_statuses}};
  if (!facts.scene.forces.known_locations) {
    json["frames"]["in_doubt"] = facts.tally.frames_in_doubt;
  }
  json["markers_by_status"] = facts.tally.marker_statuses;
  json["markers_expected_absent"] = facts.tally.markers_expected_absent;
  json["warnings"] = facts.tally.report.warnings;
  json["model"] = {{"nodes", facts.world.mesh().num_nodes()},
                   {"cells", facts.world.mesh().num_elements()},
                   {"order", facts.world.mesh().order()}};
  if (std::isfinite(facts.index_w)) json["model"]["I_w_N_per_mm"] = 1e-3 * facts.index_w;
  if (facts.correction) {
    const MeshCorrection& correction = *facts.correction;
    json["mesh_correction"] = {{"to", Name(facts.options.mesh_aim)},
                               {"cells_given", correction.given_cells},
                               {"bias_to_refined_percent", 100 * correction.bias.refined},
                               {"bias_to_converged_percent", 100 * correction.bias.converged},
                               {"youngs_modulus_factor", correction.modulus_factor},
                               {"model_error_factor", correction.model_error_factor}};
  }
  json["registration"] = Registration(facts.standing);

  for (const RigEvent& event : facts.rig_events) json["rig_events"].push_back(Event(event));

  if (!facts.tally.reduced_chi2.empty()) {
    std::vector<double> sorted = facts.tally.reduced_chi2;
    std::sort(sorted.begin(), sorted.end());
    json["chi2_per_degree_of_freedom"] = {{"median", sorted[sorted.size() / 2]},
                                          {"max", sorted.back()}};
  }

  json["seconds"] = facts.tally.report.seconds;
  AddStages(facts.tally.report.stages, &json);
  if (facts.tally.report.live) json["live"] = Live(facts.tally.report.source);
  if (facts.tally.report.recorded) {
    const vision::RecorderReport& recorded = *facts.tally.report.recorded;
    json["recorded"] = {{"sets", recorded.written}, {"bytes", recorded.bytes}};
  }
  const RunOptions& options = facts.options;
  json["options"] = {{"first_frame", options.first_frame},
                     {"every", options.every},
                     {"allocation", allocation::Name(options.tracker.observe.allocation.rule)},
                     {"registration_frames", options.registration_frames},
                     {"watch_rig", options.watch_rig},
                     {"threads", options.threads > 0 ? options.threads : DefaultThreads()},
                     {"mesh_aim", Name(options.mesh_aim)},
                     {"time_offsets_s", options.time_offsets_s},
                     {"overlay", options.overlay && !facts.scene.measured},
                     {"vtu", options.vtu},
                     {"method", estimation::Name(options.tracker.estimator.method)},
                     {"common_model_error", options.tracker.estimator.common_model_error},
                     {"local_model_error", options.tracker.estimator.local_model_error},
                     {"motion_share", options.tracker.motion_share},
                     {"max_markers", options.tracker.max_markers}};
  if (facts.scene.measured) {
    json["measured"] = {{"file", facts.scene.measured->file.filename().string()},
                        {"noise_mm", 1e3 * facts.scene.measured->noise},
                        {"labels", facts.scene.measured->labels}};
  }
  if (options.end_frame != std::numeric_limits<int>::max()) {
    json["options"]["end_frame"] = options.end_frame;
  }
  if (std::isfinite(options.tracker.estimator.force_walk)) {
    json["options"]["force_walk_N"] = options.tracker.estimator.force_walk;
  }
  for (const InputFile& input : facts.inputs) {
    json["inputs"].push_back({{"file", input.name}, {"sha256", input.sha256}});
  }
  PendingTable out(file, "");
  out.stream() << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  out.Commit();
}

}  // namespace softforce::pipeline
