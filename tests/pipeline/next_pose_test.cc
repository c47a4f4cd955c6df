#include "softforce/pipeline/next_pose.h"

#include <gtest/gtest.h>

#include "softforce/camera/lens.h"

namespace softforce::pipeline {
namespace {

using calibration::CalibrationInput;

// Cameras of 640 × 480 px, at the same place: what one sees the other does too, unless left out.
CalibrationInput MakeInput(int cameras) {
  CalibrationInput input;
  for (int c = 0; c < cameras; ++c) {
    input.cameras.push_back({c == 0 ? "left" : "right", 640, 480, {}});
  }
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 9; ++j) input.board.emplace_back(0.02 * j, 0.02 * i, 0);
  }
  return input;
}

// A board away from the middle faces outwards if it is held parallel to the picture: it is turned
// on from there, so that it faces the side at which it is.
Eigen::Vector3d Outwards(double x, double y) {
  return {y < 0.3 ? -0.6 : y > 0.7 ? 0.6 : 0, y != 0.5 ? 0 : x < 0.5 ? 0.6 : -0.6, 0};
}

// The board with its middle at a share of the picture, turned about the camera's axes (rad).
void AddView(CalibrationInput& input, double x, double y, const Eigen::Vector3d& turn,
             int only_camera = -1) {
  const camera::Lens lens{700, 700, 319.5, 239.5, {}};
  const double angle = turn.norm();
  const Eigen::AngleAxisd R(angle,
                            angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitX());
  const Eigen::Vector3d middle(0.6 * (640 * x - 320) / 700, 0.6 * (480 * y - 240) / 700, 0.6);
  calibration::CalibrationView view;
  view.seen.resize(input.cameras.size());
  for (size_t c = 0; c < view.seen.size(); ++c) {
    if (only_camera >= 0 && static_cast<int>(c) != only_camera) continue;
    for (size_t id = 0; id < input.board.size(); ++id) {
      const Eigen::Vector3d p = R * (input.board[id] - Eigen::Vector3d(0.08, 0.05, 0)) + middle;
      const Eigen::Vector2d pixel = camera::Project(lens, p).pixel;
      if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > 639 || pixel.y() > 479) continue;
      view.seen[c].ids.push_back(static_cast<int>(id));
      view.seen[c].pixels.push_back(pixel);
      view.seen[c].covariances.push_back(Eigen::Matrix2d::Identity());
    }
  }
  input.views.push_back(view);
}

Facing FacingAfter(const Eigen::Vector3d& turn) {
  CalibrationInput input = MakeInput(1);
  AddView(input, 0.5, 0.5, turn);
  return FacingOf(input.board, input.views[0].seen[0], input.cameras[0], 0.35);
}

TEST(FacingOf, TellsTheSideThatTheBoardIsTurnedTo) {
  // About the camera's y axis (down), a positive turn brings the right edge nearer, and the face
  // looks to the left; about x (right), the lower edge goes away, and it looks down.
  EXPECT_EQ(FacingAfter({0, 0, 0}), Facing::kAny);
  EXPECT_EQ(FacingAfter({0, 0.6, 0}), Facing::kLeft);
  EXPECT_EQ(FacingAfter({0, -0.6, 0}), Facing::kRight);
  EXPECT_EQ(FacingAfter({0.6, 0, 0}), Facing::kDown);
  EXPECT_EQ(FacingAfter({-0.6, 0, 0}), Facing::kUp);
}

TEST(FacingOf, IsNotMisledByATurnInThePlane) { EXPECT_EQ(FacingAfter({0, 0, 1.2}), Facing::kAny); }

TEST(NextPose, AsksForTheRegionThatNoBoardHasBeenIn) {
  CalibrationInput input = MakeInput(1);
  for (const double x : {0.16, 0.5, 0.84}) {
    for (const double y : {0.16, 0.5, 0.84}) {
      if (x > 0.6 && y < 0.3) continue;
      AddView(input, x * 0.9, 0.1 + y * 0.9, {0, 0.3, 0});
    }
  }
  const Guidance guidance = NextPose(input);

  ASSERT_TRUE(guidance.next.has_value());
  EXPECT_EQ(guidance.next->column, 2);
  EXPECT_EQ(guidance.next->row, 0);
  EXPECT_NE(guidance.Text(input, {}).find("left: top right of the picture"), std::string::npos)
      << guidance.Text(input, {});
}

TEST(NextPose, AsksForTheTiltThatIsMissing) {
  CalibrationInput input = MakeInput(1);
  for (const double x : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    for (const double y : {0.1, 0.5, 0.9}) AddView(input, x, y, {0, 0, 0});
  }
  for (int i = 0; i < 2; ++i) {
    AddView(input, 0.5, 0.5, {0, 0.6, 0});
    AddView(input, 0.5, 0.5, {0, -0.6, 0});
    AddView(input, 0.5, 0.5, {0.6, 0, 0});
  }
  const Guidance guidance = NextPose(input);

  ASSERT_TRUE(guidance.next.has_value());
  EXPECT_EQ(guidance.next->facing, Facing::kUp);
  EXPECT_FALSE(guidance.next->shared);
}

TEST(NextPose, AsksForViewsThatCamerasShare) {
  CalibrationInput input = MakeInput(2);
  for (int c = 0; c < 2; ++c) {
    for (const double x : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      for (const double y : {0.1, 0.5, 0.9}) {
        AddView(input, x, y, Outwards(x, y), c);
      }
    }
  }
  const Guidance guidance = NextPose(input);

  ASSERT_TRUE(guidance.next.has_value());
  EXPECT_TRUE(guidance.next->shared);
}

TEST(NextPose, EndsWhenAllHasBeenSeen) {
  CalibrationInput input = MakeInput(2);
  double before = NextPose(input).done;
  EXPECT_EQ(before, 0);
  for (const double x : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    for (const double y : {0.1, 0.5, 0.9}) {
      AddView(input, x, y, Outwards(x, y));
      const double now = NextPose(input).done;
      EXPECT_GE(now, before);
      before = now;
    }
  }
  const Guidance guidance = NextPose(input);

  EXPECT_FALSE(guidance.next.has_value()) << guidance.Text(input, {});
  EXPECT_NEAR(guidance.done, 1, 1e-12);
}

TEST(GuideOptions, RefusesWhatCannotBe) {
  for (int GuideOptions::*const count : {&GuideOptions::columns, &GuideOptions::rows,
                                         &GuideOptions::views_per_tilt, &GuideOptions::min_views}) {
    GuideOptions options;
    options.*count = 0;
    EXPECT_ANY_THROW(options.Check());
  }
  GuideOptions options;
  options.tilt = 0;
  EXPECT_ANY_THROW(options.Check());
}

}  // namespace
}  // namespace softforce::pipeline
