#include "softforce/allocation/allocate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::allocation {
namespace {

using Status = AllocatedPixel::Status;

PredictedPixel Predicted(double x, double y, double sigma = 5) {
  return {{x, y}, sigma * sigma * Eigen::Matrix2d::Identity()};
}
DetectedPixel Detected(double x, double y) { return {{x, y}, 0.01 * Eigen::Matrix2d::Identity()}; }

TEST(Allocate, GivesEachFeatureItsDetection) {
  const auto found =
      Allocate({Predicted(100, 100), Predicted(200, 100)}, {Detected(203, 98), Detected(101, 104)});
  EXPECT_EQ(found[0].detection, 1);
  EXPECT_EQ(found[1].detection, 0);
}

TEST(Allocate, LeavesAFeatureWithoutDetectionHidden) {
  const auto found = Allocate({Predicted(100, 100), Predicted(200, 100)}, {Detected(101, 100)});
  EXPECT_EQ(found[0].status, Status::kSeen);
  EXPECT_EQ(found[1].status, Status::kHidden);
}

TEST(Allocate, IsGlobalWhereTheNearestNeighbourGoesWrong) {
  // All moved right by 12 px: the nearest neighbour of the second feature is the first one's
  // detection.
  const auto found = Allocate({Predicted(100, 100, 10), Predicted(120, 100, 10)},
                              {Detected(113, 100), Detected(133, 100)});
  EXPECT_EQ(found[0].detection, 0);
  EXPECT_EQ(found[1].detection, 1);
}

TEST(Allocate, LeavesACloseCallHiddenRatherThanGuess) {
  const auto found = Allocate({Predicted(100, 100)}, {Detected(98, 100), Detected(102.1, 100)});
  EXPECT_EQ(found[0].status, Status::kAmbiguous);
  EXPECT_EQ(found[0].detection, -1);
}

TEST(Allocate, HoldsThePapersThreshold) {
  AllocationOptions options;
  options.threshold_displacement_px = 8;
  EXPECT_EQ(Allocate({Predicted(100, 100)}, {Detected(110, 100)}, options)[0].status,
            Status::kHidden);
  EXPECT_EQ(Allocate({Predicted(100, 100)}, {Detected(107, 100)}, options)[0].status,
            Status::kSeen);
}

TEST(Allocate, TakesTheNearestByThePapersRule) {
  AllocationOptions options;
  options.rule = Rule::kNearest;
  options.threshold_displacement_px = 15;
  // Both features are nearest to the first one's detection: the nearer one gets it.
  const auto found = Allocate({Predicted(100, 100, 10), Predicted(120, 100, 10)},
                              {Detected(113, 100), Detected(133, 100)}, options);
  EXPECT_EQ(found[0].status, Status::kHidden);
  EXPECT_EQ(found[1].detection, 0);
}

TEST(Allocate, StretchesItsGateAlongTheSoftDirection) {
  PredictedPixel soft{{100, 100}, Eigen::Vector2d(400, 1).asDiagonal()};
  EXPECT_EQ(Allocate({soft}, {Detected(140, 100)})[0].status, Status::kSeen);
  EXPECT_EQ(Allocate({soft}, {Detected(100, 140)})[0].status, Status::kHidden);
}

TEST(Allocate, IsNotMovedByDetectionsThatAreNoNumbers) {
  const auto found =
      Allocate({Predicted(100, 100)}, {Detected(NAN, 100), Detected(100, 101), Detected(1e6, 1e6)});
  EXPECT_EQ(found[0].detection, 1);
}

TEST(Allocate, TakesNothingFromNothing) {
  EXPECT_TRUE(Allocate({}, {Detected(1, 1)}).empty());
  EXPECT_EQ(Allocate({Predicted(1, 1)}, {})[0].status, Status::kHidden);
}

TEST(Allocate, RefusesOptionsOutOfRange) {
  const auto refuses = [](auto change) {
    AllocationOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  refuses([](AllocationOptions& o) { o.gate_probability = 1; });
  refuses([](AllocationOptions& o) { o.threshold_displacement_px = -1; });
  refuses([](AllocationOptions& o) { o.min_margin = NAN; });
}

}  // namespace
}  // namespace softforce::allocation
