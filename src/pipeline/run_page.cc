#include "pipeline/run_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/result_tables.h"
#include "pipeline/run_advice.h"
#include "softforce/base/version.h"

namespace softforce::pipeline {
namespace {

using Entries = std::vector<std::pair<std::string, std::string>>;

std::string Materials(const scene::Scene& scene) {
  std::string text;
  for (const auto& [region, material] : scene.materials) {
    if (!text.empty()) text += "; ";
    if (!region.empty()) text += region + ": ";
    text += fmt::format("{}, E = {:.4g} kPa, ν = {:g}", fem::Name(material.model),
                        1e-3 * material.youngs_modulus, material.poissons_ratio);
  }
  return text;
}

std::string MeshText(const RunFacts& facts) {
  const mesh::TetMesh& mesh = facts.world.mesh();
  std::string text =
      fmt::format("{}: {} cells of order {}, {} nodes", facts.scene.mesh.file.filename().string(),
                  mesh.num_elements(), mesh.order(), mesh.num_nodes());
  if (facts.correction) {
    text += fmt::format("; {} ({} cells given)", Name(facts.options.mesh_aim),
                        facts.correction->given_cells);
  }
  return text;
}

std::string Markers(const scene::Scene& scene) {
  const std::string kind = scene.measured ? "points of motion capture"
                           : scene.markers.type == scene::MarkerType::kDot ? "dots"
                                                                           : scene.markers.family;
  return fmt::format("{} {}", scene.markers.points.size(), kind);
}

std::string Actuators(const scene::Scene& scene) {
  std::string text;
  for (const scene::Actuator& actuator : scene.actuators) {
    text += (text.empty() ? "" : ", ") + actuator.name;
  }
  return text;
}

std::string Registration(const Standing& standing) {
  const Eigen::VectorXd sd = standing.covariance.diagonal().cwiseSqrt();
  std::string text = standing.from;
  if (standing.from_fiducials) {
    text = fmt::format("fiducials: {} corners, {:.3f} px RMS", standing.from_fiducials->num_points,
                       standing.from_fiducials->rms_px);
  }
  return text + fmt::format("; sd {:.3g} mm, {:.3g} mrad", 1e3 * sd.head<3>().maxCoeff(),
                            1e3 * sd.tail<3>().maxCoeff());
}

std::string Options(const RunOptions& options) {
  const estimation::EstimatorOptions& estimator = options.tracker.estimator;
  std::string text = fmt::format("method {}, common model error {:g}, local model error {:g}",
                                 estimation::Name(estimator.method), estimator.common_model_error,
                                 estimator.local_model_error);
  if (std::isfinite(estimator.force_walk)) {
    text += fmt::format(", force walk {:g} N", estimator.force_walk);
  }
  if (options.tracker.max_markers > 0) {
    text += fmt::format(", at most {} markers", options.tracker.max_markers);
  }
  if (options.first_frame > 0 || options.end_frame != std::numeric_limits<int>::max()) {
    text += fmt::format(", frames from {}", options.first_frame);
    if (options.end_frame != std::numeric_limits<int>::max()) {
      text += fmt::format(" to {}", options.end_frame - 1);
    }
  }
  if (options.every > 1) text += fmt::format(", every {}th frame", options.every);
  return text;
}

std::string Sources(const RunFacts& facts) {
  if (facts.scene.measured) return facts.scene.measured->file.filename().string();
  std::map<std::string, std::string> sources = facts.scene.cameras.sources;
  for (const auto& [camera, source] : facts.options.sources) sources[camera] = source;
  std::string text;
  for (const auto& [camera, source] : sources) {
    // Of a file its name; a folder of this machine says nothing to others.
    const bool file = source.find("://") == std::string::npos && source.rfind("/dev/", 0) != 0;
    const std::string name = file ? std::filesystem::path(source).filename().string() : source;
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", camera, name);
  }
  return text;
}

Entries Facts(const RunFacts& facts) {
  const scene::Scene& scene = facts.scene;
  Entries entries{{"softforce", base::kVersion},
                  {"scene", scene.name + " (" + scene.file.filename().string() + ")"},
                  {scene.measured ? "measured" : "cameras", Sources(facts)},
                  {"mesh", MeshText(facts)},
                  {"material", Materials(scene)},
                  {"markers", Markers(scene)},
                  {"forces", fmt::format("{} at known places, each spread over {:g} mm",
                                         scene.forces.candidates.size(), 1e3 * scene.forces.patch)},
                  {"registration", Registration(facts.standing)},
                  {"options", Options(facts.options)}};
  if (!scene.forces.known_locations) {
    entries[6].second =
        fmt::format("{} candidates, places to be found", scene.forces.candidates.size());
  }
  if (!scene.actuators.empty()) entries.push_back({"actuators", Actuators(scene)});
  if (std::isfinite(facts.index_w)) {
    entries.push_back({"I_w", fmt::format("{:.4g} N/mm", 1e-3 * facts.index_w)});
  }
  return entries;
}

Entries Cards(const RunFacts& facts, const report::RunRecord& record) {
  const RunReport& run = facts.tally.report;
  Entries cards{{fmt::format("{} / {}", run.usable_frames, run.frames), "frames with forces"}};
  double largest = 0, half_band = 0;
  for (const report::RunColumn& column : record.time.columns()) {
    for (const report::ForceExtent& force : column.forces) {
      if (!(force.value[3].high > largest)) continue;
      largest = force.value[3].high;
      half_band = force.band[3].high - largest;
    }
  }
  if (largest > 0) {
    cards.push_back({fmt::format("{:.3g} N", largest),
                     fmt::format("largest force, ± {:.2g} N (95 %)", half_band)});
  }
  if (!facts.tally.reduced_chi2.empty()) {
    std::vector<double> sorted = facts.tally.reduced_chi2;
    std::sort(sorted.begin(), sorted.end());
    cards.push_back({fmt::format("{:.2f}", sorted[sorted.size() / 2]),
                     "χ² per degree of freedom, median; 1 is as expected"});
  }
  int seen = 0, all = 0;
  for (const auto& [status, count] : facts.tally.marker_statuses) {
    all += count;
    if (status == Name(MarkerStatus::kSeen)) seen = count;
  }
  if (all > 0) cards.push_back({fmt::format("{:.1f} %", 100.0 * seen / all), "of markers seen"});
  if (run.seconds > 0) {
    cards.push_back({fmt::format("{:.1f} frames/s", run.frames / run.seconds), "rate of the run"});
  }
  return cards;
}

}  // namespace

void WriteRunPage(const RunFacts& facts, const ReportLog& log, const std::filesystem::path& file) {
  const RunReport& run = facts.tally.report;
  report::RunRecord record;
  record.scene = facts.scene.name;
  record.usable = run.usable;
  record.brief = run.BriefReport();
  record.warnings = run.warnings;
  record.advice = AdviceFor(facts.tally, log);
  log.Fill(&record);
  record.cards = Cards(facts, record);
  record.facts = Facts(facts);
  for (const InputFile& input : facts.inputs) record.inputs.push_back({input.name, input.sha256});
  for (const StageTimes& stage : run.stages) {
    record.stages.push_back({stage.stage, stage.median_ms, stage.p95_ms, stage.max_ms});
  }
  PendingTable out(file, "");
  out.stream() << report::RunPage(record);
  out.Commit();
}

}  // namespace softforce::pipeline
