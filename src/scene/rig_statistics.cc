#include <cmath>

#include "scene/rig_formats.h"

namespace softforce::scene {
namespace {

// A number that the file leaves out if it is not known.
double NumberOrNan(YamlMap& map, const std::string& key) {
  const auto value = map.Optional(key);
  return value ? value->Number() : NAN;
}

std::string LineUnlessNan(const std::string& key, double number) {
  return std::isnan(number) ? "" : fmt::format("  {}: {}\n", key, number);
}

// The lower triangle, a row for each parameter.
Eigen::MatrixXd ReadCovariance(const YamlValue& value, int count) {
  Eigen::MatrixXd covariance(count, count);
  const std::vector<YamlValue> rows = value.Items({count});
  for (int i = 0; i < count; ++i) {
    const std::vector<double> row = rows[i].Numbers({i + 1});
    for (int j = 0; j <= i; ++j) covariance(i, j) = covariance(j, i) = row[j];
  }
  return covariance;
}

std::vector<RigStatistics::Camera> ReadCameras(YamlMap& map) {
  std::vector<RigStatistics::Camera> cameras;
  for (const std::string& name : map.Keys()) {
    cameras.push_back(map.Required(name).ReadMap([&](YamlMap& entry) {
      RigStatistics::Camera camera;
      camera.name = name;
      camera.pictures = entry.Required("pictures").Integer(0);
      camera.points = entry.Required("points").Integer(0);
      camera.rms_px = NumberOrNan(entry, "rms_px");
      return camera;
    }));
  }
  return cameras;
}

}  // namespace

RigStatistics ReadStatistics(YamlMap& map) {
  RigStatistics statistics;
  statistics.board = map.Required("board").Text();
  statistics.views = map.Required("views").Integer(0);
  statistics.rms_px = NumberOrNan(map, "rms_px");
  statistics.held_out_px = NumberOrNan(map, "held_out_px");
  statistics.held_out_square = NumberOrNan(map, "held_out_square_m");
  statistics.held_out_board = NumberOrNan(map, "held_out_board_m");
  if (const auto cameras = map.Optional("cameras")) {
    statistics.cameras = cameras->ReadMap(ReadCameras);
  }
  if (const auto parameters = map.Optional("parameters")) {
    for (const YamlValue& name : parameters->Items()) statistics.parameters.push_back(name.Text());
    statistics.covariance =
        ReadCovariance(map.Required("covariance"), static_cast<int>(statistics.parameters.size()));
  }
  return statistics;
}

std::string StatisticsText(const RigStatistics& statistics) {
  std::string yaml = "calibration:\n  board: " + Quoted(statistics.board) + "\n";
  yaml += fmt::format("  views: {}\n", statistics.views);
  yaml += LineUnlessNan("rms_px", statistics.rms_px);
  yaml += LineUnlessNan("held_out_px", statistics.held_out_px);
  yaml += LineUnlessNan("held_out_square_m", statistics.held_out_square);
  yaml += LineUnlessNan("held_out_board_m", statistics.held_out_board);
  if (!statistics.cameras.empty()) yaml += "  cameras:\n";
  for (const RigStatistics::Camera& camera : statistics.cameras) {
    yaml += fmt::format(
        "    {}: {{pictures: {}, points: {}{}}}\n", Quoted(camera.name), camera.pictures,
        camera.points, std::isnan(camera.rms_px) ? "" : fmt::format(", rms_px: {}", camera.rms_px));
  }
  if (statistics.parameters.empty()) return yaml;
  yaml += "  parameters:\n";
  for (const std::string& name : statistics.parameters) yaml += "    - " + Quoted(name) + "\n";
  yaml += "  covariance:  # lower triangle; px, rad, m\n";
  for (Eigen::Index i = 0; i < statistics.covariance.rows(); ++i) {
    const Eigen::VectorXd row = statistics.covariance.row(i).head(i + 1);
    yaml += "    - " + List(row) + "\n";
  }
  return yaml;
}

}  // namespace softforce::scene
