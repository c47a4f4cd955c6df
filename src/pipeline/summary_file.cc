#include "pipeline/summary_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipeline/result_tables.h"
#include "softforce/base/sha256.h"
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

Json Registration(const vision::RigPose& pose) {
  const Eigen::VectorXd sd = pose.covariance.diagonal().cwiseSqrt();
  return {{"T_rig_robot", Matrix(pose.T_rig_robot.matrix())},
          {"points", pose.num_points},
          {"reprojection_rms_px", pose.rms_px},
          {"sd_translation_mm", {1e3 * sd(0), 1e3 * sd(1), 1e3 * sd(2)}},
          {"sd_rotation_mrad", {1e3 * sd(3), 1e3 * sd(4), 1e3 * sd(5)}}};
}

}  // namespace

void WriteSummary(const RunFacts& facts, const std::filesystem::path& file) {
  Json json;
  json["softforce"] = base::kVersion;
  json["scene"] = facts.scene.name;
  json["usable"] = facts.report.usable;
  json["frames"] = {{"processed", facts.report.frames},
                    {"with_forces", facts.report.usable_frames},
                    {"by_status", facts.frame_statuses}};
  json["markers_by_status"] = facts.marker_statuses;
  json["warnings"] = facts.report.warnings;
  json["model"] = {{"nodes", facts.world.mesh().num_nodes()},
                   {"cells", facts.world.mesh().num_elements()},
                   {"order", facts.world.mesh().order()}};
  if (std::isfinite(facts.index_w)) json["model"]["I_w_N_per_mm"] = 1e-3 * facts.index_w;
  if (facts.correction) {
    const MeshCorrection& correction = *facts.correction;
    const bool refined = facts.options.mesh_aim == MeshAim::kRefined;
    json["mesh_correction"] = {{"to", refined ? "refined" : "converged"},
                               {"cells_given", correction.given_cells},
                               {"bias_to_refined_percent", 100 * correction.bias.refined},
                               {"bias_to_converged_percent", 100 * correction.bias.converged},
                               {"youngs_modulus_factor", correction.modulus_factor},
                               {"model_error_factor", correction.model_error_factor}};
  }
  if (facts.registration) json["registration"] = Registration(*facts.registration);

  if (!facts.reduced_chi2.empty()) {
    std::vector<double> sorted = facts.reduced_chi2;
    std::sort(sorted.begin(), sorted.end());
    json["chi2_per_degree_of_freedom"] = {{"median", sorted[sorted.size() / 2]},
                                          {"max", sorted.back()}};
  }

  json["seconds"] = facts.report.seconds;
  for (const StageClock::Percentiles& stage : facts.stages) {
    json["stages_ms"][stage.stage] = {{"count", stage.count}, {"median", stage.median_ms},
                                      {"p90", stage.p90_ms},  {"p95", stage.p95_ms},
                                      {"p99", stage.p99_ms},  {"max", stage.max_ms}};
  }
  const RunOptions& options = facts.options;
  json["options"] = {{"first_frame", options.first_frame},
                     {"registration_frames", options.registration_frames},
                     {"overlay", options.overlay},
                     {"vtu", options.vtu},
                     {"method", estimation::Name(options.tracker.estimator.method)},
                     {"common_model_error", options.tracker.estimator.common_model_error},
                     {"local_model_error", options.tracker.estimator.local_model_error},
                     {"motion_share", options.tracker.motion_share}};
  if (options.end_frame != std::numeric_limits<int>::max()) {
    json["options"]["end_frame"] = options.end_frame;
  }
  if (std::isfinite(options.tracker.estimator.force_walk)) {
    json["options"]["force_walk_N"] = options.tracker.estimator.force_walk;
  }
  for (const std::filesystem::path& input : facts.inputs) {
    json["inputs"].push_back(
        {{"file", input.filename().string()}, {"sha256", base::Sha256OfFile(input)}});
  }
  PendingTable out(file, "");
  out.stream() << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  out.Commit();
}

}  // namespace softforce::pipeline
