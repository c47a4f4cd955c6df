#include "softforce/allocation/allocate_places.h"

#include <gtest/gtest.h>

#include "softforce/base/input_error.h"

namespace softforce::allocation {
namespace {

using Status = AllocatedPixel::Status;

constexpr double kThreshold = 0.02;  // m

PredictedPlace Predicted(double x, double y, double z, double sd = 1e-3) {
  return {{x, y, z}, sd * sd * Eigen::Matrix3d::Identity()};
}

DetectedPlace Detected(double x, double y, double z) {
  return {{x, y, z}, 1e-8 * Eigen::Matrix3d::Identity()};
}

TEST(AllocatePlaces, GivesPointsToTheFeaturesNearThem) {
  const auto allocated = AllocatePlaces({Predicted(0, 0, 0), Predicted(0.03, 0, 0)},
                                        {Detected(0.031, 0, 0), Detected(0, 0.001, 0)}, kThreshold);

  EXPECT_EQ(allocated[0].detection, 1);
  EXPECT_EQ(allocated[1].detection, 0);
}

TEST(AllocatePlaces, TellsApartWhatIsBehindEachOtherInAPicture) {
  const auto allocated =
      AllocatePlaces({Predicted(0, 0, 0), Predicted(0, 0, 0.02)},
                     {Detected(0, 0, 0.0205), Detected(0, 0, 0.0005)}, kThreshold);

  EXPECT_EQ(allocated[0].detection, 1);
  EXPECT_EQ(allocated[1].detection, 0);
}

TEST(AllocatePlaces, LeavesHiddenWhatNoPointIsNearAndClutterAlone) {
  const auto allocated = AllocatePlaces({Predicted(0, 0, 0), Predicted(0.03, 0, 0)},
                                        {Detected(0.0301, 0, 0), Detected(0, 0.5, 0)}, kThreshold);

  EXPECT_EQ(allocated[0].status, Status::kHidden);
  EXPECT_EQ(allocated[1].detection, 0);
}

TEST(AllocatePlaces, HasGatesThatAreLongWhereThePredictionIsUncertain) {
  PredictedPlace along_z = Predicted(0, 0, 0);
  along_z.covariance(2, 2) = 25e-6;  // (5 mm)²

  EXPECT_EQ(AllocatePlaces({along_z}, {Detected(0, 0, 0.012)}, kThreshold)[0].status,
            Status::kSeen);
  EXPECT_EQ(AllocatePlaces({along_z}, {Detected(0.012, 0, 0)}, kThreshold)[0].status,
            Status::kHidden);
}

TEST(AllocatePlaces, TakesNothingBeyondTheThresholdDisplacement) {
  const PredictedPlace vague = Predicted(0, 0, 0, 0.02);

  EXPECT_EQ(AllocatePlaces({vague}, {Detected(0.021, 0, 0)}, kThreshold)[0].status,
            Status::kHidden);
  EXPECT_EQ(AllocatePlaces({vague}, {Detected(0.021, 0, 0)}, 0)[0].status, Status::kSeen);
}

TEST(AllocatePlaces, LeavesCloseCallsHidden) {
  const auto allocated = AllocatePlaces(
      {Predicted(0, 0, 0)}, {Detected(0.001, 0, 0), Detected(-0.001, 0, 0)}, kThreshold);

  EXPECT_EQ(allocated[0].status, Status::kAmbiguous);
}

TEST(AllocatePlaces, LeavesOutWhatIsNotFinite) {
  const auto allocated =
      AllocatePlaces({Predicted(0, 0, 0)}, {Detected(NAN, 0, 0), Detected(0, 0, 0)}, kThreshold);

  EXPECT_EQ(allocated[0].detection, 1);
}

TEST(AllocatePlaces, RefusesANegativeThreshold) {
  EXPECT_THROW(AllocatePlaces({}, {}, -1), base::InputError);
}

}  // namespace
}  // namespace softforce::allocation
