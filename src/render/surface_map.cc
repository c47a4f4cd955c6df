#include "softforce/render/surface_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "render/brush.h"
#include "render/colour_scale.h"
#include "render/easel_state.h"
#include "render/text.h"
#include "softforce/mesh/surface_walk.h"

namespace softforce::render {
namespace {

constexpr int kPanelWidth = 720, kPanelHeight = 560;  // px
constexpr int kTitle = 44, kMargin = 24, kScaleWidth = 200;
constexpr int kFiner = 2;        // the body is drawn so many times as large, and scaled down
constexpr double kCrease = 0.6;  // rad, between faces that a line parts
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
const cv::Vec3b kGrey(150, 150, 150), kPaper(255, 255, 255), kInk(40, 40, 40);

void Write(cv::Mat3b* picture, const std::string& text, const cv::Point& at, double size) {
  cv::putText(*picture, text, at, kFont, size, cv::Scalar(kInk), 1, cv::LINE_AA);
}

// The same view with the body as large as it fits in a picture of this size.
View FillPicture(const MapView& from, const mesh::Surface& surface, const Eigen::Matrix3Xd& x,
                 const cv::Size& size, camera::Camera* zoomed) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (const int node : surface.triangles.reshaped()) {
    const camera::Projection seen =
        camera::Project(from.camera.lens, from.T_camera_robot * x.col(node));
    if (!seen.visible) continue;
    low = low.cwiseMin(seen.pixel);
    high = high.cwiseMax(seen.pixel);
  }
  *zoomed = from.camera;
  zoomed->width = size.width;
  zoomed->height = size.height;
  if (low.x() < high.x() && low.y() < high.y()) {
    const double scale =
        0.92 * std::min(size.width / (high.x() - low.x()), size.height / (high.y() - low.y()));
    const Eigen::Vector2d middle = (low + high) / 2;
    camera::Lens& lens = zoomed->lens;
    lens.cx = scale * (lens.cx - middle.x()) + (size.width - 1) / 2.0;
    lens.cy = scale * (lens.cy - middle.y()) + (size.height - 1) / 2.0;
    lens.fx *= scale;
    lens.fy *= scale;
  }
  return {zoomed, from.T_camera_robot, size, kFiner};
}

// Which sides (i to i + 1) of each triangle are drawn as lines: those where the body has an edge.
std::vector<std::array<bool, 3>> LinesOf(const mesh::Surface& surface, const Eigen::Matrix3Xd& x) {
  const std::vector<int> face = mesh::SmoothFaces(surface, x, kCrease);
  std::map<std::pair<int, int>, std::vector<int>> sides;
  const auto side = [&](int t, int i) {
    return std::minmax(surface.triangles(i, t), surface.triangles((i + 1) % 3, t));
  };
  for (int t = 0; t < surface.num_triangles(); ++t) {
    for (int i = 0; i < 3; ++i) sides[side(t, i)].push_back(t);
  }
  std::vector<std::array<bool, 3>> lines(surface.num_triangles(), {false, false, false});
  for (int t = 0; t < surface.num_triangles(); ++t) {
    for (int i = 0; i < 3; ++i) {
      for (const int other : sides[side(t, i)]) lines[t][i] |= face[other] != face[t];
    }
  }
  return lines;
}

// Far triangles first, so that near ones are painted over them.
void PaintBody(cv::Mat3b* picture, const mesh::Surface& surface, const BodyPicture& body,
               const std::vector<std::array<bool, 3>>& lines, const Eigen::VectorXd& values,
               const MapScale& scale) {
  std::vector<int> order;
  std::vector<double> nearness(surface.num_triangles(), 0);  // 1/m
  for (int t = 0; t < surface.num_triangles(); ++t) {
    if (!body.faces_camera[t]) continue;
    order.push_back(t);
    for (int i = 0; i < 3; ++i) {
      nearness[t] += body.nodes[surface.triangles(i, t)].inverse_depth / 3;
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return nearness[a] < nearness[b]; });
  for (const int t : order) {
    std::vector<cv::Point> outline;
    for (int i = 0; i < 3; ++i) {
      outline.emplace_back(body.nodes[surface.triangles(i, t)].pixel);
      if (surface.order() == 2) outline.emplace_back(body.nodes[surface.triangles(3 + i, t)].pixel);
    }
    const cv::Vec3b colour = std::isfinite(values(t)) ? MapColour(values(t), scale) : kGrey;
    cv::fillPoly(*picture, std::vector<std::vector<cv::Point>>{outline}, cv::Scalar(colour));
    for (int i = 0; i < 3; ++i) {
      if (!lines[t][i]) continue;
      cv::line(*picture, body.nodes[surface.triangles(i, t)].pixel,
               body.nodes[surface.triangles((i + 1) % 3, t)].pixel, cv::Scalar(kInk), kFiner,
               cv::LINE_AA);
    }
  }
}

void PaintMarkers(cv::Mat3b* picture, const View& view, const BodyPicture& body, const MapRow& row,
                  Easel* easel) {
  Brush brush(*picture, easel);
  constexpr double kRadius = 11 * kFiner;  // px
  for (size_t i = 0; i < row.markers.size(); ++i) {
    const Sight sight = See(view, row.markers[i]);
    if (!sight.visible || body.depth.Hides(sight.pixel, sight.inverse_depth)) continue;
    brush.Disc(sight.pixel, kRadius + 1.5 * kFiner);
    brush.Paint(kInk, 1);
    brush.Disc(sight.pixel, kRadius);
    brush.Paint(kPaper, 1);
    const std::string& label = row.labels[i];
    const TextStyle style{0.45 * kFiner, kFiner};
    const TextExtent extent = MeasureText(label, style);
    brush.Text(label, sight.pixel + cv::Point2d(-extent.width, extent.above) / 2, style.scale,
               style.width);
    brush.Paint(kInk, 1);
  }
}

cv::Mat3b Panel(const mesh::Surface& surface, const Eigen::Matrix3Xd& x, const MapView& from,
                const MapRow& row, const std::vector<std::array<bool, 3>>& lines,
                const MapScale& scale) {
  const cv::Size size(kFiner * kPanelWidth, kFiner * kPanelHeight);
  camera::Camera zoomed;
  const View view = FillPicture(from, surface, x, size, &zoomed);
  Easel easel;
  BodyPicture& body = easel.state().body;
  PictureBody(view, surface, x, &body);
  cv::Mat3b large(size, kPaper);
  PaintBody(&large, surface, body, lines, row.values, scale);
  PaintMarkers(&large, view, body, row, &easel);
  cv::Mat3b panel;
  cv::resize(large, panel, {kPanelWidth, kPanelHeight}, 0, 0, cv::INTER_AREA);
  return panel;
}

// 1, 2 and 5 of every power of ten within the scale.
std::vector<double> Ticks(const MapScale& scale) {
  std::vector<double> ticks;
  const int first = static_cast<int>(std::floor(std::log10(scale.low)));
  const int last = static_cast<int>(std::ceil(std::log10(scale.high)));
  for (int power = first; power <= last; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double tick = digit * std::pow(10.0, power);
      if (tick >= scale.low * (1 - 1e-9) && tick <= scale.high * (1 + 1e-9)) ticks.push_back(tick);
    }
  }
  return ticks;
}

void PaintScale(cv::Mat3b* picture, const MapScale& scale, const cv::Rect& bar) {
  for (int y = 0; y < bar.height; ++y) {
    const double share = 1 - (y + 0.5) / bar.height;
    const double value = scale.low * std::pow(scale.high / scale.low, share);
    (*picture)(cv::Rect(bar.x, bar.y + y, bar.width, 1)).setTo(cv::Scalar(MapColour(value, scale)));
  }
  cv::rectangle(*picture, bar, cv::Scalar(kInk), 1);
  for (const double tick : Ticks(scale)) {
    const double share = std::log(tick / scale.low) / std::log(scale.high / scale.low);
    const int y = bar.y + static_cast<int>(std::lround((1 - share) * bar.height));
    cv::line(*picture, {bar.br().x, y}, {bar.br().x + 6, y}, cv::Scalar(kInk), 1);
    Write(picture, fmt::format("{:g}", tick), {bar.br().x + 12, y + 5}, 0.5);
  }
  const cv::Point grey(bar.x, bar.br().y + 24);
  (*picture)(cv::Rect(grey, cv::Size(bar.width, 16))).setTo(cv::Scalar(kGrey));
  Write(picture, "held", {bar.br().x + 12, grey.y + 13}, 0.5);
}

}  // namespace

cv::Vec3b MapColour(double value, const MapScale& scale) {
  static const ColourScale colours;
  return colours.At(std::log(value / scale.low) / std::log(scale.high / scale.low));
}

MapView PlainView(const std::string& name, const Eigen::Matrix3Xd& x,
                  const Eigen::Vector3d& direction) {
  const Eigen::Vector3d low = x.rowwise().minCoeff(), high = x.rowwise().maxCoeff();
  const Eigen::Vector3d middle = (low + high) / 2;
  const Eigen::Vector3d z = -direction;  // away from the eye
  const Eigen::Vector3d up =
      std::abs(z.z()) > 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d right = z.cross(up).normalized();
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear() << right, z.cross(right), z;
  T_robot_camera.translation() = middle + 4 * (high - low).norm() * direction;
  MapView view;
  view.name = name;
  view.camera.name = name;
  view.camera.width = view.camera.height = 1000;
  view.camera.lens = {3000, 3000, 499.5, 499.5, {}, camera::LensModel::kBrownConrady};
  view.T_camera_robot = T_robot_camera.inverse();
  return view;
}

cv::Mat DrawSurfaceMaps(const mesh::Surface& surface, const Eigen::Matrix3Xd& x,
                        const std::vector<MapView>& views, const std::vector<MapRow>& rows,
                        const MapScale& scale) {
  assert(scale.low > 0 && scale.high > scale.low);
  const int columns = static_cast<int>(views.size());
  const int height = static_cast<int>(rows.size()) * (kTitle + kPanelHeight) + 2 * kMargin;
  cv::Mat3b picture(height, columns * (kPanelWidth + kMargin) + kMargin + kScaleWidth, kPaper);
  const std::vector<std::array<bool, 3>> lines = LinesOf(surface, x);
  int top = kMargin;
  for (const MapRow& row : rows) {
    assert(row.values.size() == surface.num_triangles());
    assert(row.labels.size() == row.markers.size());
    Write(&picture, row.title, {kMargin, top + 24}, 0.7);
    for (int c = 0; c < columns; ++c) {
      const cv::Point corner(kMargin + c * (kPanelWidth + kMargin), top + kTitle);
      Panel(surface, x, views[c], row, lines, scale)
          .copyTo(picture(cv::Rect(corner, cv::Size(kPanelWidth, kPanelHeight))));
      Write(&picture, views[c].name, corner + cv::Point(4, kPanelHeight - 6), 0.5);
    }
    top += kTitle + kPanelHeight;
  }
  const int left = kMargin + columns * (kPanelWidth + kMargin);
  int line = kMargin + 24;
  for (size_t start = 0; start < scale.title.size(); line += 22) {
    const size_t end = std::min(scale.title.find('\n', start), scale.title.size());
    Write(&picture, scale.title.substr(start, end - start), {left, line}, 0.55);
    start = end + 1;
  }
  PaintScale(&picture, scale, {left, line + 10, 32, kPanelHeight - 120});
  return picture;
}

}  // namespace softforce::render
