// How well markers are located in rendered stereo pictures, and whether the covariances say so: a
// flat plate of dots or tags, askew, some 0.45 m before two cameras (f = 1400 px, 150 mm apart).
// Prints Markdown tables. The truth is the renderer's geometry, which shares no code with the
// detectors. PIXEL_FLOOR (px) is added to the reported covariances, as a run does; 0 unless given.
//
//   build/release/benchmarks/detection_accuracy [POSES [PIXEL_FLOOR]]
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "softforce/camera/triangulate.h"
#include "softforce/pipeline/observe.h"
#include "softforce/render/picture.h"
#include "softforce/vision/tag_cells.h"
#include "support/box_mesh.h"
#include "support/stereo_rig.h"

namespace {

using softforce::camera::PixelObservation;
using softforce::render::Sticker;
namespace camera = softforce::camera;
namespace mesh = softforce::mesh;
namespace render = softforce::render;
namespace vision = softforce::vision;

constexpr double kPlate = 0.16;      // m
constexpr double kThickness = 4e-3;  // m
constexpr double kDistance = 0.45;   // m, from the left camera

struct Setting {
  std::string name;
  double size = 6e-3;  // m
  double blur = 0.6;   // px
  double noise = 2;    // grey levels
  double tilt = 15;    // degrees
  bool dark = false;   // dots: dark on bright
};

// Squares of whitened errors over their number: 1 if the covariances are right.
struct Tally {
  long points = 0, expected = 0, pixels = 0;
  double pixel2 = 0, pixel_normalised = 0;  // px²; sums
  double place2 = 0, normalised = 0;        // m²
  double centre2 = 0;                       // m²; tags: of the mean of the corners
  long centres = 0;
};

// A feature point of a marker, on the plate.
struct Point {
  Eigen::Vector3d place;
  double diameter = 0;  // m; 0: a corner
};

class Plate {
 public:
  explicit Plate(const Setting& setting, bool tags) : setting_(setting), tags_(tags) {
    // Triangles as small as the markers: the renderer asks each ray of a triangle which of the
    // triangle's markers it meets.
    mesh_ = softforce::testing::MakeBox(16, 16, 1, {kPlate, kPlate, kThickness});
    surface_ = mesh::ExtractSurface(mesh_);
  }

  void Look(std::mt19937* random, double pixel_floor, Tally* tally) const;

 private:
  std::vector<Sticker> PutMarkers(std::mt19937* random) const;
  Eigen::Isometry3d PutPlate(std::mt19937* random) const;
  std::vector<std::optional<PixelObservation>> Detect(int c, const camera::Camera& camera,
                                                      const cv::Mat& grey,
                                                      const Eigen::Isometry3d& T_rig_plate,
                                                      const std::vector<Point>& points) const;

  Setting setting_;
  bool tags_;
  mesh::TetMesh mesh_;
  mesh::Surface surface_;
  camera::Rig rig_ = softforce::testing::MakeStereoRig();
};

double Uniform(double low, double high, std::mt19937* random) {
  return std::uniform_real_distribution<double>(low, high)(*random);
}

std::vector<Sticker> Plate::PutMarkers(std::mt19937* random) const {
  const double room = tags_ ? 1.6 * setting_.size : 1.9 * setting_.size;  // with a rim
  const int across = std::min(7, static_cast<int>(kPlate / (room + 2e-3)));
  const double pitch = kPlate / across;
  const double slack = 0.5 * (pitch - room);
  std::vector<Sticker> markers;
  for (int i = 0; i < across * across; ++i) {
    Sticker sticker;
    const double x = pitch * (i % across + 0.5) + Uniform(-slack, slack, random);
    const double y = pitch * (i / across + 0.5) + Uniform(-slack, slack, random);
    sticker.centre = {x, y, kThickness};
    const double turn = Uniform(0, 2 * M_PI, random);
    sticker.right = {std::cos(turn), std::sin(turn), 0};
    sticker.up = {-std::sin(turn), std::cos(turn), 0};
    sticker.size = setting_.size;
    if (tags_) {
      const vision::TagCells tag = vision::DrawTag("tag36h11", i);
      sticker.cells = tag.cells;
      sticker.margin = tag.margin;
      if (slack < 0.25 * setting_.size) {  // upright, for want of room
        sticker.right = Eigen::Vector3d::UnitX();
        sticker.up = Eigen::Vector3d::UnitY();
      }
    }
    markers.push_back(sticker);
  }
  return markers;
}

Eigen::Isometry3d Plate::PutPlate(std::mt19937* random) const {
  Eigen::Matrix3d facing;  // the plate's z towards the camera
  facing << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  const double about = Uniform(0, 2 * M_PI, random);
  const Eigen::Vector3d axis(std::cos(about), std::sin(about), 0);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(setting_.tilt * M_PI / 180, axis) * facing *
               Eigen::AngleAxisd(Uniform(0, 2 * M_PI, random), Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d centre(Uniform(-0.02, 0.02, random), Uniform(-0.02, 0.02, random),
                               kDistance + Uniform(-0.02, 0.02, random));
  T.translation() = centre - T.linear() * Eigen::Vector3d(kPlate / 2, kPlate / 2, kThickness);
  return T;
}

// The cameras with only that part of their pictures in which the plate is: rendering takes time.
camera::Rig Cut(camera::Rig rig, const Eigen::Isometry3d& T_rig_plate) {
  constexpr double kRim = 30;  // px
  for (camera::Camera& camera : rig.cameras) {
    Eigen::AlignedBox2d box;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d corner(i & 1 ? kPlate : 0, i & 2 ? kPlate : 0, i & 4 ? kThickness : 0);
      box.extend(camera::Project(camera.lens, camera.T_camera_rig * T_rig_plate * corner).pixel);
    }
    const Eigen::Vector2d low = (box.min().array() - kRim).max(0).floor();
    const Eigen::Vector2d high =
        (box.max().array() + kRim).min(Eigen::Array2d(camera.width, camera.height)).ceil();
    camera.lens.cx -= low.x();
    camera.lens.cy -= low.y();
    camera.width = static_cast<int>(high.x() - low.x());
    camera.height = static_cast<int>(high.y() - low.y());
  }
  return rig;
}

// As a run looks for tags near where they are expected.
vision::TagOptions AtFullSize() {
  vision::TagOptions options;
  options.decimate = 1;
  return options;
}

// What camera c makes of each point: the dot next to it, less the shift of its centroid, or the
// corner of the tag of that number.
std::vector<std::optional<PixelObservation>> Plate::Detect(int c, const camera::Camera& camera,
                                                           const cv::Mat& grey,
                                                           const Eigen::Isometry3d& T_rig_plate,
                                                           const std::vector<Point>& points) const {
  const Eigen::Isometry3d T = camera.T_camera_rig * T_rig_plate;
  std::vector<std::optional<PixelObservation>> seen(points.size());
  if (tags_) {
    for (const vision::Tag& tag :
         vision::TagDetector("tag36h11", AtFullSize()).Detect(grey, &camera.lens)) {
      for (size_t k = 0; k < 4; ++k) {
        const size_t i = 4 * static_cast<size_t>(tag.id) + k;
        if (i >= points.size()) continue;
        seen[i] = PixelObservation{c, tag.corners[k], tag.corner_covariances[k]};
      }
    }
    return seen;
  }
  const std::vector<vision::Dot> dots = vision::DetectDots(grey);
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = T * points[i].place;
    const Eigen::Vector3d normal = T.linear() * Eigen::Vector3d::UnitZ();
    const Eigen::Vector2d centre = camera::Project(camera.lens, p).pixel;
    const auto centroid = camera::ProjectDiscCentroid(camera.lens, p, normal, points[i].diameter);
    if (!centroid) continue;
    double nearest = 3;  // px: further off is another one
    for (const vision::Dot& dot : dots) {
      const double distance = (dot.centroid - *centroid).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      seen[i] = PixelObservation{c, dot.centroid - (*centroid - centre), dot.covariance};
    }
  }
  return seen;
}

void Plate::Look(std::mt19937* random, double pixel_floor, Tally* tally) const {
  const std::vector<Sticker> markers = PutMarkers(random);
  const Eigen::Isometry3d T_rig_plate = PutPlate(random);
  std::vector<Point> points;
  for (const Sticker& marker : markers) {
    if (!tags_) {
      points.push_back({marker.centre, marker.size});
      continue;
    }
    const Eigen::Vector3d right = marker.size / 2 * marker.right, up = marker.size / 2 * marker.up;
    for (const Eigen::Vector3d& corner :
         {Eigen::Vector3d(up - right), Eigen::Vector3d(up + right), Eigen::Vector3d(right - up),
          Eigen::Vector3d(-right - up)}) {
      points.push_back({marker.centre + corner, 0});
    }
  }

  render::PictureOptions options;
  options.blur = setting_.blur;
  options.noise = setting_.noise;
  options.rays = 16;  // so that the picture's noise is that of the sensor alone
  if (setting_.dark) std::swap(options.body, options.white);
  options.light = T_rig_plate.linear().transpose() * Eigen::Vector3d(0.2, -0.3, -1).normalized();
  const camera::Rig rig = Cut(rig_, T_rig_plate);
  std::vector<std::vector<std::optional<PixelObservation>>> seen;
  for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
    const auto seed = static_cast<std::uint32_t>((*random)());
    const render::PictureWorld world{&surface_, &mesh_.nodes, markers, {}};
    const render::PictureMaker maker(rig.cameras[c], rig.cameras[c].T_camera_rig * T_rig_plate,
                                     world, options);
    const cv::Mat grey = maker.Take(mesh_.nodes, {}, seed).grey;
    seen.push_back(Detect(c, rig.cameras[c], grey, T_rig_plate, points));
  }

  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  int corners = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    std::vector<PixelObservation> both;
    for (size_t c = 0; c < seen.size(); ++c) {
      if (!seen[c][i]) continue;
      PixelObservation pixel = *seen[c][i];
      pixel.covariance += pixel_floor * pixel_floor * Eigen::Matrix2d::Identity();
      const camera::Camera& camera = rig.cameras[c];
      const Eigen::Vector2d truth =
          camera::Project(camera.lens, camera.T_camera_rig * T_rig_plate * points[i].place).pixel;
      const Eigen::Vector2d error = pixel.pixel - truth;
      tally->pixel2 += error.squaredNorm();
      tally->pixel_normalised += error.dot(pixel.covariance.inverse() * error);
      ++tally->pixels;
      both.push_back(pixel);
    }
    ++tally->expected;
    if (i % 4 == 0) {
      centre.setZero();
      corners = 0;
    }
    if (both.size() < seen.size()) continue;
    const camera::Triangulation found = camera::Triangulate(rig, both);
    if (!found.p_rig.allFinite()) continue;
    const Eigen::Vector3d error = found.p_rig - T_rig_plate * points[i].place;
    tally->place2 += error.squaredNorm();
    tally->normalised += error.dot(found.covariance.inverse() * error);
    ++tally->points;
    centre += 0.25 * error;
    if (tags_ && ++corners == 4) {
      tally->centre2 += centre.squaredNorm();
      ++tally->centres;
    }
  }
}

void Row(const Setting& setting, bool tags, int poses, double pixel_floor) {
  std::mt19937 random(7);
  const Plate plate(setting, tags);
  Tally tally;
  for (int pose = 0; pose < poses; ++pose) plate.Look(&random, pixel_floor, &tally);
  const auto mean = [](double sum, long count) { return sum / static_cast<double>(count); };
  fmt::print(
      "| {} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {:.1f} | {:.4f} | {:.2f} | {:.4f} | {:.2f} |",
      setting.name, 1e3 * setting.size, setting.blur, setting.noise, setting.tilt,
      100 * mean(static_cast<double>(tally.points), tally.expected),
      std::sqrt(mean(tally.pixel2, 2 * tally.pixels)),
      mean(tally.pixel_normalised, 2 * tally.pixels),
      1e3 * std::sqrt(mean(tally.place2, tally.points)), mean(tally.normalised, 3 * tally.points));
  if (tags) fmt::print(" {:.4f} |", 1e3 * std::sqrt(mean(tally.centre2, tally.centres)));
  fmt::print("\n");
  std::fflush(stdout);
}

std::vector<Setting> Settings(double size) {
  std::vector<Setting> settings;
  const auto add = [&](const std::string& name, const std::function<void(Setting*)>& change) {
    Setting setting;
    setting.size = size;
    setting.name = name;
    change(&setting);
    settings.push_back(setting);
  };
  add("usual", [](Setting*) {});
  for (const double factor : {0.35, 0.5, 1.5, 3.0}) {
    add("size", [&](Setting* s) { s->size *= factor; });
  }
  for (const double blur : {0.3, 1.2, 2.5}) add("blur", [&](Setting* s) { s->blur = blur; });
  for (const double tilt : {0.0, 45.0, 65.0}) add("tilt", [&](Setting* s) { s->tilt = tilt; });
  for (const double noise : {0.5, 4.0, 8.0}) add("noise", [&](Setting* s) { s->noise = noise; });
  return settings;
}

}  // namespace

int main(int argc, char** argv) {
  const int poses = argc > 1 ? std::atoi(argv[1]) : 10;
  const double floor = argc > 2 ? std::atof(argv[2]) : 0;
  if (poses < 1) {
    fmt::print(stderr, "detection_accuracy: got \"{}\", expected a number of poses\n", argv[1]);
    return 2;
  }
  const char* head =
      "size, mm | blur, px | noise | tilt, deg | found, % | px per axis | px normalised² | mm, 3-D "
      "| "
      "normalised² |";
  fmt::print("| dots | {}\n|---|---|---|---|---|---|---|---|---|---|\n", head);
  for (const Setting& setting : Settings(6e-3)) Row(setting, false, poses, floor);
  Setting dark;
  dark.name = "dark on bright";
  dark.dark = true;
  Row(dark, false, poses, floor);
  fmt::print("\n| tags | {} centre, mm |\n|---|---|---|---|---|---|---|---|---|---|---|\n", head);
  for (const Setting& setting : Settings(12e-3)) Row(setting, true, poses, floor);
}
