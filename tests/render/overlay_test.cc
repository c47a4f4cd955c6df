#include "softforce/render/overlay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace softforce::render {
namespace {

constexpr int kGrey = 90;

camera::Camera MakeCamera() {
  camera::Camera camera;
  camera.name = "left";
  camera.width = 640;
  camera.height = 512;
  camera.lens.fx = camera.lens.fy = 800;
  camera.lens.cx = 320;
  camera.lens.cy = 256;
  camera.lens.distortion[0] = -0.12;
  return camera;
}

// The robot frame's z axis points at the camera from 0.5 m away, x to the right.
Eigen::Isometry3d FacingCamera() {
  Eigen::Isometry3d T_camera_robot = Eigen::Isometry3d::Identity();
  T_camera_robot.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  T_camera_robot.translation() = Eigen::Vector3d(0, 0, 0.5);
  return T_camera_robot;
}

cv::Mat3b MakePicture() { return cv::Mat3b(512, 640, cv::Vec3b::all(kGrey)); }

// Squares across z, 0.16 m wide with a corner at every 0.02 m, seen from +z.
struct Plate {
  mesh::Surface surface;
  Eigen::Matrix3Xd x;
};

Plate MakePlate(const std::vector<double>& heights, bool faces_camera) {
  constexpr int kCells = 8;
  constexpr int kRow = kCells + 1;
  const int plates = static_cast<int>(heights.size());
  Plate plate;
  plate.x.resize(3, plates * kRow * kRow);
  plate.surface.triangles.resize(3, plates * 2 * kCells * kCells);
  int triangle = 0;
  for (int p = 0; p < plates; ++p) {
    const int first = p * kRow * kRow;
    for (int i = 0; i < kRow * kRow; ++i) {
      const int row = i / kRow;
      plate.x.col(first + i) << 0.02 * (i % kRow) - 0.08, 0.02 * row - 0.08, heights[p];
    }
    for (int i = 0; i < kCells * kCells; ++i) {
      const int a = first + i % kCells + kRow * (i / kCells);
      plate.surface.triangles.col(triangle++) << a, a + 1, a + kRow + 1;
      plate.surface.triangles.col(triangle++) << a, a + kRow + 1, a + kRow;
    }
  }
  if (!faces_camera) plate.surface.triangles.row(1).swap(plate.surface.triangles.row(2));
  plate.surface.element.assign(triangle, 0);
  return plate;
}

cv::Point2d PixelOf(const Eigen::Vector3d& p_robot) {
  const auto projection = camera::Project(MakeCamera().lens, FacingCamera() * p_robot);
  return {projection.pixel.x(), projection.pixel.y()};
}

cv::Mat3b Draw(const OverlayScene& scene, const OverlayOptions& options = {},
               Easel* easel = nullptr) {
  cv::Mat3b picture = MakePicture();
  DrawOverlay(picture, MakeCamera(), FacingCamera(), scene, options, easel);
  return picture;
}

// Where the drawing differs from the picture.
cv::Mat1b Changed(const cv::Mat& drawn) {
  cv::Mat difference;
  cv::absdiff(drawn, cv::Scalar::all(kGrey), difference);
  cv::Mat1b changed;
  cv::cvtColor(difference, changed, cv::COLOR_BGR2GRAY);
  cv::threshold(changed, changed, 0, 255, cv::THRESH_BINARY);
  return changed;
}

// Pixels that have the pure colour of a force, as blue green red.
cv::Mat1b OrangePixels(const cv::Mat& drawn) {
  cv::Mat1b orange;
  cv::inRange(drawn, cv::Scalar(0, 159, 230), cv::Scalar(0, 159, 230), orange);
  return orange;
}

// The shaft and head without the words, which stand on a dark ground of their own.
cv::Rect BoxOfArrow(const cv::Mat& drawn) {
  cv::Mat labels, statistics, centroids;
  const int count =
      cv::connectedComponentsWithStats(OrangePixels(drawn), labels, statistics, centroids, 8);
  int largest = 1;
  for (int i = 2; i < count; ++i) {
    if (statistics.at<int>(i, cv::CC_STAT_AREA) > statistics.at<int>(largest, cv::CC_STAT_AREA)) {
      largest = i;
    }
  }
  const int* box = statistics.ptr<int>(largest);
  return {box[cv::CC_STAT_LEFT], box[cv::CC_STAT_TOP], box[cv::CC_STAT_WIDTH],
          box[cv::CC_STAT_HEIGHT]};
}

TEST(DrawOverlay, ChangesNothingForAnEmptyScene) {
  const cv::Mat drawn = Draw({});

  ASSERT_EQ(drawn.type(), CV_8UC3);
  ASSERT_EQ(drawn.size(), cv::Size(640, 512));
  EXPECT_EQ(cv::countNonZero(Changed(drawn)), 0);
}

TEST(DrawOverlay, WritesTheCaptionAtTheTopLeftOnly) {
  OverlayScene scene;
  scene.caption = {"frame 7", "0.2 s"};

  const cv::Mat1b changed = Changed(Draw(scene));

  const cv::Rect box = cv::boundingRect(changed);
  EXPECT_GT(box.area(), 0);
  EXPECT_LT(box.br().x, 320);
  EXPECT_LT(box.br().y, 128);
}

TEST(DrawOverlay, EndsThePushArrowAtItsPlace) {
  const Eigen::Vector3d place(0.06, 0.04, 0);
  OverlayScene scene;
  scene.forces = {{"F1", place, {1, 0, 0}, 0.01}};

  const cv::Rect arrow = BoxOfArrow(Draw(scene));

  // Without a body a force counts as a push. The tip's last pixels are antialiased: 3 px.
  EXPECT_NEAR(arrow.br().x, PixelOf(place).x, 3);
  EXPECT_NEAR(arrow.x, PixelOf(place - Eigen::Vector3d(0.08, 0, 0)).x, 3);
}

TEST(DrawOverlay, StartsThePullArrowAtItsPlace) {
  const Plate plate = MakePlate({0}, true);
  const Eigen::Vector3d place(-0.01, 0.03, 0);
  OverlayScene scene;
  scene.surface = &plate.surface;
  scene.x = &plate.x;
  scene.forces = {{"F1", place, {0.8, 0, 0.1}, 0.01}};

  const cv::Rect arrow = BoxOfArrow(Draw(scene));

  EXPECT_NEAR(arrow.x, PixelOf(place).x, 4);  // px
  EXPECT_NEAR(arrow.br().x, PixelOf(place + Eigen::Vector3d(0.064, 0, 0.008)).x, 4);
}

TEST(DrawOverlay, MakesTheArrowAsLongAsTheScaleSays) {
  OverlayScene scene;
  scene.forces = {{"F1", {0.04, -0.05, 0}, {1, 0, 0}, 0}};
  OverlayOptions options;
  options.metres_per_newton = 0.03;

  const cv::Rect arrow = BoxOfArrow(Draw(scene, options));

  EXPECT_NEAR(arrow.width, 0.03 / 0.5 * 800, 4);  // px
}

TEST(DrawOverlay, DoesNotDrawFacesThatTurnAway) {
  const Plate plate = MakePlate({0}, false);
  OverlayScene scene;
  scene.surface = &plate.surface;
  scene.x = &plate.x;

  EXPECT_EQ(cv::countNonZero(Changed(Draw(scene))), 0);
}

TEST(DrawOverlay, DrawsTheNetThroughTheNodes) {
  const Plate plate = MakePlate({0}, true);
  OverlayScene scene;
  scene.surface = &plate.surface;
  scene.x = &plate.x;

  const cv::Mat1b changed = Changed(Draw(scene));

  for (int i = 0; i < plate.x.cols(); ++i) {
    const cv::Point pixel = PixelOf(plate.x.col(i));
    EXPECT_GT(cv::countNonZero(changed(cv::Rect(pixel - cv::Point(1, 1), cv::Size(3, 3)))), 0)
        << "node " << i;
  }
}

TEST(DrawOverlay, ShowsAFieldInTheColoursOfItsScale) {
  const Plate plate = MakePlate({0}, true);
  OverlayScene scene;
  scene.surface = &plate.surface;
  scene.x = &plate.x;
  // From 0 at the left end to the end of the scale at the right one.
  scene.field = SurfaceField{"displacement", "mm", (plate.x.row(0).array() + 0.08) / 0.16, 1};
  OverlayOptions options;
  options.net = false;

  const cv::Mat3b drawn = Draw(scene, options);

  const auto at = [&](double x) { return drawn(cv::Point(PixelOf({x, 0.01, 0}))); };
  const cv::Vec3b low = at(-0.078), middle = at(0), high = at(0.078);
  EXPECT_GT(low[0], low[1]) << "violet at the lower end: more blue than green";
  EXPECT_GT(middle[1], middle[2]) << "green in the middle: more than red";
  EXPECT_GT(high[2], high[0]) << "yellow at the upper end: more red than blue";
  const auto light = [](const cv::Vec3b& c) { return 0.11 * c[0] + 0.59 * c[1] + 0.3 * c[2]; };
  EXPECT_LT(light(low), light(middle));
  EXPECT_LT(light(middle), light(high));
  EXPECT_EQ(drawn(cv::Point(PixelOf({0, -0.1, 0}))), cv::Vec3b::all(kGrey)) << "beside the body";
}

TEST(DrawOverlay, DrawsTheRegionOfAHiddenMarkerAsLargeAsItIs) {
  OverlayScene scene;
  const double sd = 5e-3;  // m
  scene.markers = {
      {"", MarkerMark::kHidden, {0.01, 0.02, 0}, sd * sd * Eigen::Matrix3d::Identity()}};

  const cv::Rect box = cv::boundingRect(Changed(Draw(scene)));

  // 95 %: 2.45 standard deviations, and the width of the line with its seam.
  EXPECT_NEAR(box.width, 2 * 2.448 * sd / 0.5 * 800, 6);  // px
  EXPECT_NEAR(box.height, 2 * 2.448 * sd / 0.5 * 800, 6);
}

TEST(DrawOverlay, DrawsCandidatesAndAxesWhereTheyAre) {
  OverlayScene scene;
  scene.candidates = {{"0", {0.06, -0.05, 0}}};
  EXPECT_TRUE(cv::boundingRect(Changed(Draw(scene))).contains(PixelOf({0.06, -0.05, 0})));
  scene.candidates.clear();
  scene.axes = 0.05;
  const cv::Mat1b changed = Changed(Draw(scene));
  EXPECT_GT(changed(cv::Point(PixelOf({0.03, 0, 0}))), 0);
  EXPECT_GT(changed(cv::Point(PixelOf({0, 0.03, 0}))), 0);
}

TEST(DrawOverlay, DoesNotDrawFacesBehindOthers) {
  const Plate front = MakePlate({0}, true);
  Plate both = MakePlate({0, -0.02}, true);
  both.x.rightCols(81).topRows(2) *= 0.7;  // the one behind stays within the outline of the first
  both.x.row(0).rightCols(81).array() += 0.004;
  OverlayScene alone, together;
  alone.surface = &front.surface;
  alone.x = &front.x;
  together.surface = &both.surface;
  together.x = &both.x;

  EXPECT_EQ(cv::norm(Draw(alone), Draw(together), cv::NORM_INF), 0);
}

TEST(DrawOverlay, DrawsTheFartherFacesWhereNothingStandsBefore) {
  Plate both = MakePlate({0, -0.02}, true);
  both.x.row(0).rightCols(81).array() += 0.1;
  OverlayScene scene;
  scene.surface = &both.surface;
  scene.x = &both.x;

  const cv::Mat1b changed = Changed(Draw(scene));

  const cv::Point beyond = PixelOf(both.x.col(both.x.cols() - 1));
  EXPECT_GT(cv::countNonZero(changed(cv::Rect(beyond - cv::Point(2, 2), cv::Size(5, 5)))), 0);
}

TEST(DrawOverlay, DrawsEachStatusOfAMarkerDifferently) {
  std::vector<cv::Mat> drawn;
  for (const MarkerMark mark :
       {MarkerMark::kSeen, MarkerMark::kOneCamera, MarkerMark::kHidden, MarkerMark::kRejected}) {
    OverlayScene scene;
    scene.markers = {{"", mark, {0.01, 0.02, 0}}};
    drawn.push_back(Draw(scene));
    const cv::Rect box = cv::boundingRect(Changed(drawn.back()));
    const cv::Point pixel = PixelOf({0.01, 0.02, 0});
    EXPECT_TRUE((box + cv::Size(2, 0)).contains(pixel)) << pixel << " not in " << box;
    EXPECT_LT(box.width, 30);
  }
  for (size_t i = 0; i < drawn.size(); ++i) {
    for (size_t j = 0; j < i; ++j) EXPECT_GT(cv::norm(drawn[i], drawn[j], cv::NORM_INF), 50);
  }
}

TEST(DrawOverlay, DrawsACableBetweenItsEnds) {
  OverlayScene scene;
  scene.cables = {{{{0.05, 0.02, 0}, {-0.05, 0.02, 0}}}};

  const cv::Mat1b changed = Changed(Draw(scene));

  for (const double x : {-0.05, -0.02, 0.0, 0.03, 0.05}) {
    EXPECT_NE(changed(cv::Point(PixelOf({x, 0.02, 0}))), 0) << "at x = " << x << " m";
  }
}

TEST(DrawOverlay, SkipsWhatIsNowhereOrBehindTheCamera) {
  OverlayScene scene;
  scene.markers = {{"1", MarkerMark::kSeen, Eigen::Vector3d::Constant(NAN)},
                   {"2", MarkerMark::kHidden, {0, 0, 0.8}}};
  scene.forces = {{"F1", {0, 0, 0.8}, {1, 0, 0}, 0.1},
                  {"F2", Eigen::Vector3d::Constant(NAN), {1, 0, 0}, 0.1}};
  scene.cables = {{{{0, 0, 0.8}, {0, 0.1, 0.9}}}};

  EXPECT_EQ(cv::countNonZero(Changed(Draw(scene))), 0);
}

TEST(DrawOverlay, KeepsTheLabelsOfTwoForcesApart) {
  OverlayScene one, two;
  one.forces = {{"F1", {0.02, 0, 0}, {0.5, 0, 0}, 0.01}};
  two.forces = {one.forces[0], {"F2", {0.02, 0.003, 0}, {0.5, 0, 0}, 0.01}};

  const int first = cv::countNonZero(Changed(Draw(one)));
  const int both = cv::countNonZero(Changed(Draw(two)));

  EXPECT_GT(both, 1.6 * first);  // most of what is drawn for a force is its label
}

TEST(DrawOverlay, GivesTheSameBytesAgain) {
  const Plate plate = MakePlate({0, -0.03}, true);
  OverlayScene scene;
  scene.surface = &plate.surface;
  scene.x = &plate.x;
  scene.markers = {{"3", MarkerMark::kSeen, {0.02, 0.01, 0}}};
  scene.forces = {{"F1", {0.01, -0.02, 0}, {0.3, 0.2, -0.4}, 0.01}};
  scene.caption = {"frame 7"};

  EXPECT_EQ(cv::norm(Draw(scene), Draw(scene), cv::NORM_INF), 0);
}

TEST(DrawOverlay, DoesNotDependOnWhatItsEaselServedBefore) {
  const Plate fine = MakePlate({0, -0.03}, true), turned = MakePlate({0.01}, true);
  OverlayScene scene, other;
  scene.surface = &fine.surface;
  scene.x = &fine.x;
  scene.field = SurfaceField{"displacement", "mm", 10 * fine.x.row(0).cwiseAbs(), 1};
  scene.markers = {{"3", MarkerMark::kSeen, {0.02, 0.01, 0}}};
  other.surface = &turned.surface;
  other.x = &turned.x;
  other.forces = {{"F1", {0.01, -0.02, 0}, {0.3, 0.2, -0.4}, 0.01}};
  Easel easel;

  Draw(other, {}, &easel);
  cv::Mat3b small(400, 300, cv::Vec3b::all(kGrey));
  DrawOverlay(small, MakeCamera(), FacingCamera(), other, {}, &easel);

  EXPECT_EQ(cv::norm(Draw(scene, {}, &easel), Draw(scene), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace softforce::render
