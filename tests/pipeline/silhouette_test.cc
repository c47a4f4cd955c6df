// The body as it was estimated, projected into the pictures from which it was: its outline must be
// where the picture has the body's. The recordings come from another solver and another renderer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "pipeline/frame_file.h"
#include "softforce/pipeline/run.h"
#include "softforce/scene/rig_file.h"
#include "softforce/scene/scene.h"

namespace softforce::pipeline {
namespace {

namespace fs = std::filesystem;

const fs::path kRecordings = fs::path(SOFTFORCE_SOURCE_DIR) / "../shared/recordings";

constexpr int kFiner = 4;       // subpixels of the mask's edge, in each direction
constexpr double kReach = 6;    // px, to either side of the outline
constexpr double kStep = 0.1;   // px
constexpr double kLeast = 0.3;  // of the body's contrast to the background: a clear edge

// 0 to 1: the share of each pixel that the body covers.
cv::Mat1f Cover(const World& world, const Eigen::Matrix3Xd& x, const camera::Camera& camera,
                const Eigen::Isometry3d& T_rig_robot, cv::Size size) {
  std::vector<cv::Point2d> pixels(static_cast<size_t>(x.cols()));
  for (Eigen::Index n = 0; n < x.cols(); ++n) {
    const Eigen::Vector2d p =
        camera::Project(camera.lens, camera.T_camera_rig * T_rig_robot * x.col(n)).pixel;
    pixels[static_cast<size_t>(n)] = {p.x(), p.y()};
  }
  cv::Mat1b fine(size * kFiner, 0);
  const mesh::Surface& surface = world.surface;
  for (int t = 0; t < surface.num_triangles(); ++t) {
    std::vector<cv::Point> corners;
    // Corners and the middles of the edges between them, which are bent with the body.
    const bool bent = surface.order() == 2;
    for (const int i : bent ? std::vector<int>{0, 3, 1, 4, 2, 5} : std::vector<int>{0, 1, 2}) {
      // Pixel centres are whole numbers; a pixel has kFiner cells to either side.
      const cv::Point2d p = pixels[static_cast<size_t>(surface.triangles(i, t))];
      corners.emplace_back(cvRound(kFiner * (p.x + 0.5) - 0.5),
                           cvRound(kFiner * (p.y + 0.5) - 0.5));
    }
    cv::fillPoly(fine, std::vector{corners}, 255);
  }
  cv::Mat cover;
  cv::resize(fine, cover, size, 0, 0, cv::INTER_AREA);
  cover.convertTo(cover, CV_32F, 1.0 / 255);
  return cover;
}

double At(const cv::Mat1f& picture, const cv::Point2d& p) {
  const int x = cvFloor(p.x), y = cvFloor(p.y);
  const double u = p.x - x, v = p.y - y;
  return (1 - v) * ((1 - u) * picture(y, x) + u * picture(y, x + 1)) +
         v * ((1 - u) * picture(y + 1, x) + u * picture(y + 1, x + 1));
}

// Where the grey value along a line crosses the middle between those at its ends, px; NaN if they
// differ too little or it crosses twice, as at a marker near the outline.
double Crossing(const cv::Mat1f& picture, const cv::Point2d& at, const cv::Point2d& normal,
                double least) {
  const auto value = [&](double s) { return At(picture, at + s * normal); };
  const double inside = value(-kReach), outside = value(kReach), middle = (inside + outside) / 2;
  if (std::abs(outside - inside) < least) return NAN;
  double found = NAN;
  for (double s = -kReach; s < kReach; s += kStep) {
    const double a = value(s) - middle, b = value(s + kStep) - middle;
    if ((a < 0) == (b < 0)) continue;
    if (std::isfinite(found)) return NAN;
    found = s + kStep * a / (a - b);
  }
  return found;
}

// Where the outline cannot be told from a fiducial beside it.
cv::Mat1b BesideFiducials(const scene::Scene& scene, const camera::Camera& camera,
                          const Eigen::Isometry3d& T_rig_robot, cv::Size size) {
  constexpr double kWithBorder = 1.5;  // widths of the code; the white border is a quarter wide
  cv::Mat1b beside(size, 0);
  for (const calibration::Fiducial& fiducial : scene.cameras.fiducials) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : fiducial.corners) centre += corner / 4;
    std::vector<cv::Point> quad;
    for (const Eigen::Vector3d& corner : fiducial.corners) {
      const Eigen::Vector3d outer = centre + kWithBorder * (corner - centre);
      const Eigen::Vector2d p =
          camera::Project(camera.lens, camera.T_camera_rig * T_rig_robot * outer).pixel;
      quad.emplace_back(cvRound(p.x()), cvRound(p.y()));
    }
    cv::fillConvexPoly(beside, quad, 255);
  }
  const int width = 2 * static_cast<int>(kReach) + 1;
  cv::dilate(beside, beside, cv::getStructuringElement(cv::MORPH_ELLIPSE, {width, width}));
  return beside;
}

// From the model's outline to that in the picture, px, outwards, but for places in `unclear`.
std::vector<double> Distances(const cv::Mat1f& cover, const cv::Mat1f& picture,
                              const cv::Mat1b& unclear) {
  cv::Mat mask = cover > 0.5;
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::Mat1f smooth;
  cv::GaussianBlur(cover, smooth, {0, 0}, 1.0);
  const double body = cv::mean(picture, mask)[0], around = cv::mean(picture, ~mask)[0];
  std::vector<double> distances;
  for (const std::vector<cv::Point>& outline : outlines) {
    for (size_t i = 0; i < outline.size(); i += 4) {
      const cv::Point p = outline[i];
      const int margin = static_cast<int>(kReach) + 2;
      if (!cv::Rect(margin, margin, cover.cols - 2 * margin, cover.rows - 2 * margin).contains(p) ||
          unclear(p) > 0) {
        continue;
      }
      cv::Point2d normal(smooth(p.y, p.x - 1) - smooth(p.y, p.x + 1),
                         smooth(p.y - 1, p.x) - smooth(p.y + 1, p.x));
      const double length = std::hypot(normal.x, normal.y);
      if (length < 1e-3) continue;
      normal /= length;
      const double model = Crossing(cover, p, normal, 0.9);
      const double seen = Crossing(picture, p, normal, kLeast * std::abs(body - around));
      if (std::isfinite(model) && std::isfinite(seen)) distances.push_back(seen - model);
    }
  }
  return distances;
}

// The absolute distances along all outlines in frames of the recording, ascending.
std::vector<double> OutlineErrors(const std::string& recording, const std::string& test) {
  const fs::path folder = kRecordings / recording;
  RunOptions options;
  options.out = fs::path(::testing::TempDir()) / test;
  options.overlay = options.report = options.show_progress = false;
  options.every = 6;
  const RunReport report = Run(folder / "scene.yaml", options);
  EXPECT_EQ(report.usable_frames, report.frames);

  const scene::Scene scene = scene::LoadScene(folder / "scene.yaml");
  const camera::Rig rig = scene::LoadRig(scene.cameras.rig);
  const World world = BuildWorld(scene);
  std::vector<double> errors;
  for (const camera::Camera& camera : rig.cameras) {
    cv::VideoCapture video((folder / (camera.name + ".mp4")).string());
    FrameFileReader frames(options.out / kFrameFile, world.mesh().num_nodes());
    int next = 0;
    while (const auto frame = frames.Next()) {
      cv::Mat colour, grey;
      for (; next <= frame->result.frame; ++next) video.read(colour);
      cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
      grey.convertTo(grey, CV_32F);
      const cv::Mat1f cover =
          Cover(world, world.mesh().nodes + frame->u, camera, frame->T_rig_robot, grey.size());
      const cv::Mat1b unclear = BesideFiducials(scene, camera, frame->T_rig_robot, grey.size());
      for (const double d : Distances(cover, grey, unclear)) errors.push_back(std::abs(d));
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

void ExpectWithinAPixel(const std::string& recording, const std::string& test) {
  if (!fs::exists(kRecordings)) GTEST_SKIP() << kRecordings << " is not there";
  const std::vector<double> errors = OutlineErrors(recording, test);
  ASSERT_GT(errors.size(), 1000u);
  const auto quantile = [&](double share) {
    return errors[static_cast<size_t>(share * static_cast<double>(errors.size() - 1))];
  };
  std::cout << fmt::format(
      "{} places: median {:.2f} px, 95 % within {:.2f}, 99 % within {:.2f}, all within {:.2f}\n",
      errors.size(), quantile(0.5), quantile(0.95), quantile(0.99), errors.back());
  EXPECT_LT(quantile(0.99), 1.0);  // px
  EXPECT_LT(errors.back(), 1.1);
}

TEST(Silhouette, OfTheSheetIsWhereThePictureHasIt) {
  ExpectWithinAPixel("sheet_two_weights", "silhouette_sheet");
}

TEST(Silhouette, OfTheRobotIsWhereThePictureHasIt) {
  ExpectWithinAPixel("robot_tip_weight", "silhouette_robot");
}

}  // namespace
}  // namespace softforce::pipeline
