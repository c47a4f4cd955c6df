#include "softforce/allocation/allocate_jointly.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "softforce/base/input_error.h"

namespace softforce::allocation {
namespace {

using Status = AllocatedPixel::Status;

// Dots in a row, 30 px apart, that one number moves: each further than the one before.
struct Row {
  std::vector<JointPrediction> predictions;
  Belief prior{Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Constant(1, 1, 1)};

  explicit Row(int dots, int cameras = 1) {
    for (int c = 0; c < cameras; ++c) {
      for (int i = 0; i < dots; ++i) {
        predictions.push_back({c,
                               {100 + 30.0 * i, 100 + 50.0 * c},
                               Eigen::Vector2d(6.0 * (i + 1), 0),
                               0.25 * Eigen::Matrix2d::Identity()});
      }
    }
  }

  // Where the dots stand for a delta; numbers among the detections are those of the predictions.
  std::vector<std::vector<DetectedPixel>> Seen(double delta) const {
    std::vector<std::vector<DetectedPixel>> seen;
    for (const JointPrediction& p : predictions) {
      if (p.camera == static_cast<int>(seen.size())) seen.emplace_back();
      seen[p.camera].push_back({p.pixel + p.H * delta, 0.0025 * Eigen::Matrix2d::Identity()});
    }
    return seen;
  }
};

TEST(AllocateJointly, FollowsABodyThatMovesFurtherThanItsMarkersAreApart) {
  const Row row(8);
  // The last dot moves by 86 px, nearly three spacings.
  const JointAllocation found = AllocateJointly(row.predictions, row.prior, row.Seen(1.8));
  for (int i = 0; i < 8; ++i) EXPECT_EQ(found.pixels[i].detection, i);
  EXPECT_NEAR(found.belief.mean(0), 1.8, 0.05);  // px noise of 0.5 over levers of 6 to 48 px
}

TEST(AllocateJointly, GivesTheDotOfAHiddenMarkerToNoNeighbour) {
  const Row row(8, 2);
  auto seen = row.Seen(1.8);
  for (auto& camera : seen) {
    camera[5].pixel.setConstant(NAN);
    camera[2].pixel.setConstant(NAN);
  }
  const JointAllocation found = AllocateJointly(row.predictions, row.prior, seen);
  for (int i = 0; i < 16; ++i) {
    const bool hidden = i % 8 == 2 || i % 8 == 5;
    EXPECT_EQ(found.pixels[i].status, hidden ? Status::kHidden : Status::kSeen) << i;
    if (!hidden) {
      EXPECT_EQ(found.pixels[i].detection, i % 8);
    }
  }
}

TEST(AllocateJointly, LeavesOutWhatTwoExplanationsFitAlike) {
  // One dot that may stand at either of two places, by a delta of +1 or of −1.
  std::vector<JointPrediction> one{
      {0, {100, 100}, Eigen::Vector2d(30, 0), Eigen::Matrix2d::Identity()}};
  const Eigen::Matrix2d noise = 0.01 * Eigen::Matrix2d::Identity();
  const JointAllocation found =
      AllocateJointly(one, {Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Constant(1, 1, 1)},
                      {{{Eigen::Vector2d(70, 100), noise}, {Eigen::Vector2d(130.1, 100), noise}}});
  EXPECT_EQ(found.pixels[0].status, Status::kAmbiguous);
}

TEST(AllocateJointly, LooksNearWhatIsKnownBetterThanThePrior) {
  const Row row(8);
  const Belief near{Eigen::VectorXd::Constant(1, 1.79), Eigen::MatrixXd::Constant(1, 1, 1e-3)};
  const JointAllocation found =
      AllocateJointly(row.predictions, row.prior, row.Seen(1.8), {}, &near);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(found.pixels[i].detection, i);
}

TEST(AllocateJointly, TakesNothingFromNothing) {
  const Belief prior{Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Constant(1, 1, 1)};
  EXPECT_TRUE(AllocateJointly({}, prior, {{}}).pixels.empty());
  EXPECT_EQ(AllocateJointly(Row(1).predictions, prior, {{}}).pixels[0].status, Status::kHidden);
}

TEST(AllocateJointly, RefusesOptionsOutOfRange) {
  const auto refuses = [](auto change) {
    JointOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  refuses([](JointOptions& o) { o.detection_probability = 1; });
  refuses([](JointOptions& o) { o.max_hypotheses = 0; });
  refuses([](JointOptions& o) { o.refined_hypotheses = 0; });
}

}  // namespace
}  // namespace softforce::allocation
