#include "pipeline/live_state.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace softforce::pipeline {
namespace {

using nlohmann::json;

// Name; x, y, z, norm; their standard deviations.
json ForceJson(const ForceResult& force) {
  const auto sd = [&](int i) { return std::sqrt(force.covariance(i, i)); };
  return {ForceName(force),   force.force.x(), force.force.y(), force.force.z(),
          force.force.norm(), sd(0),           sd(1),           sd(2),
          force.NormSd()};
}

json ControlsJson(const RunControls* controls) {
  if (controls == nullptr) {
    return {
        {"tares", 0}, {"tared", 0}, {"recording", false}, {"paused", false}, {"canRecord", false}};
  }
  return {{"tares", controls->tares.load()},
          {"tared", controls->tared.load()},
          {"recording", controls->recording.load()},
          {"paused", controls->pause.load()},
          {"canRecord", controls->can_record.load()}};
}

std::string Dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

void LiveHistory::Add(const FrameResult& result) {
  points_.push_back({result.time_s, result.forces});
  while (points_.front().time_s < result.time_s - kSpan) points_.pop_front();
  if (points_.size() <= kMost) return;
  std::deque<LivePoint> kept;
  for (size_t i = (points_.size() + 1) % 2; i < points_.size(); i += 2) {  // the newest among them
    kept.push_back(std::move(points_[i]));
  }
  points_ = std::move(kept);
}

std::string LiveStateJson(const LiveFacts& facts, const FrameResult& result,
                          const RunControls* controls) {
  json state{{"scene", facts.scene},
             {"run", facts.run},
             {"live", facts.live},
             {"expected", facts.expected},
             {"processed", facts.processed},
             {"rate", facts.rate},
             {"latency", facts.latency_ms},
             {"dropped", facts.dropped},
             {"pictures", facts.pictures},
             {"ended", facts.ended},
             {"usable", facts.usable},
             {"frame", result.frame},
             {"time", std::isfinite(result.time_s) ? result.time_s : 0},
             {"reason", result.frame < 0 || result.ok() ? "" : result.reason},
             {"statuses", MarkerStatusNames()},
             {"forces", json::array()},
             {"markers", json::array()},
             {"stages", json::array()},
             {"controls", ControlsJson(controls)}};
  for (const ForceResult& force : result.forces) state["forces"].push_back(ForceJson(force));
  for (const MarkerResult& marker : result.markers) {
    state["markers"].push_back({marker.id, static_cast<int>(marker.status)});
  }
  for (const StageTimes& stage : facts.stages) {
    state["stages"].push_back(
        {stage.stage, stage.median_ms, stage.p95_ms, stage.max_ms, stage.queue_mean});
  }
  return Dump(state);
}

std::string LiveHistoryJson(const std::deque<LivePoint>& points) {
  std::string text = "{\"points\":[";
  for (const LivePoint& point : points) {
    text += fmt::format("{}[{:.10g},[", text.back() == '[' ? "" : ",", point.time_s);
    for (const ForceResult& force : point.forces) {
      const Eigen::Vector3d sd = force.covariance.diagonal().cwiseSqrt();
      text += fmt::format("{}[\"{}\",{:.5g},{:.5g},{:.5g},{:.5g},{:.3g},{:.3g},{:.3g},{:.3g}]",
                          text.back() == '[' ? "" : ",", ForceName(force), force.force.x(),
                          force.force.y(), force.force.z(), force.force.norm(), sd.x(), sd.y(),
                          sd.z(), force.NormSd());
    }
    text += "]]";
  }
  return text + "]}";
}

}  // namespace softforce::pipeline
