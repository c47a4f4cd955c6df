#include "softforce/calibration/match_markers.h"

#include <gtest/gtest.h>

#include "calibration/marker_layouts.h"
#include "softforce/base/input_error.h"

namespace softforce::calibration {
namespace {

using Status = MarkerMatch::Status;
using softforce::testing::MakeStereoRig;

// Of random worlds.
struct Outcome {
  int worlds = 0, right = 0, wrong = 0, refused = 0;
};

// The rig stands within 10 cm and 30° of where it looks down on the dots; up to two dots are
// hidden, six others are strewn about the body, and each camera sees six more spots. Worlds in
// which the cameras do not see enough of the dots together are left out.
Outcome Register(const std::vector<KnownDot>& dots, int seeds,
                 const std::optional<Eigen::Isometry3d>& guess = {}) {
  const camera::Rig rig = MakeStereoRig();
  const Eigen::Vector3d centre = CentreOf(dots);
  Outcome outcome;
  for (int seed = 0; seed < seeds; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto direction = [&] {
      Eigen::Vector3d v;
      do v = {uniform(random), uniform(random), uniform(random)};
      while (v.norm() > 1 || v.norm() < 0.1);
      return Eigen::Vector3d(v);
    };
    const Eigen::AngleAxisd turn(M_PI / 6 * std::abs(uniform(random)), direction().normalized());
    const Eigen::Isometry3d truth = LookingDown(dots) * Eigen::Translation3d(0.1 * direction()) *
                                    Eigen::Translation3d(centre) * turn *
                                    Eigen::Translation3d(-centre);
    Disturbance how;
    how.misplacement = 1e-4;
    how.decoys = how.clutter = 6;
    how.hidden = {static_cast<int>(random() % dots.size()),
                  static_cast<int>(random() % (2 * dots.size()))};
    Disturbance alone;
    alone.hidden = how.hidden;
    std::mt19937 other(1);
    const auto in_view = SpotsOf(rig, dots, truth, alone, other);
    const size_t needed = std::max<size_t>(5, (2 * dots.size() + 2) / 3);
    if (std::min(in_view[0].size(), in_view[1].size()) < needed) continue;
    ++outcome.worlds;

    const MarkerMatch match =
        MatchMarkers(rig, dots, SpotsOf(rig, dots, truth, how, random), guess);

    if (!match.ok()) {
      ++outcome.refused;
    } else if (ErrorAt(dots, match.pose.T_rig_robot, truth) < 1e-3) {  // m; noise gives 0.3 mm
      ++outcome.right;
    } else {
      ++outcome.wrong;
      std::cout << "seed " << seed << ": " << 1e3 * ErrorAt(dots, match.pose.T_rig_robot, truth)
                << " mm off, " << match.matched << " matched, rival " << match.rival << ", "
                << match.pose.rms_px << " px, by guess " << match.by_guess << "\n";
    }
  }
  std::cout << outcome.worlds << " worlds: " << outcome.right << " right, " << outcome.refused
            << " refused, " << outcome.wrong << " wrong\n";
  return outcome;
}

TEST(MatchMarkers, FindsTheSheetAmongDecoysWithHiddenDots) {
  const Outcome outcome = Register(SheetDots(), 300);

  EXPECT_GE(outcome.worlds, 200);
  EXPECT_GE(outcome.right, 0.99 * outcome.worlds);
  EXPECT_EQ(outcome.wrong, 0);
}

TEST(MatchMarkers, IsNeverWrongAboutABodyThatIsNearlySymmetric) {
  const Outcome outcome = Register(LeggedDots(), 300);

  EXPECT_GE(outcome.worlds, 200);
  EXPECT_EQ(outcome.wrong, 0);
  // Some pairs of hidden dots leave the same picture as a quarter turn; the rest is found.
  EXPECT_GE(outcome.right, 0.85 * outcome.worlds);
}

TEST(MatchMarkers, ARoughGuessDecidesWhatASymmetricBodyLeavesOpen) {
  const Outcome outcome = Register(LeggedDots(), 300, LookingDown(LeggedDots()));

  EXPECT_GE(outcome.right, 0.99 * outcome.worlds);
  EXPECT_EQ(outcome.wrong, 0);
}

TEST(MatchMarkers, IsExactWithoutNoise) {
  const camera::Rig rig = MakeStereoRig();
  const std::vector<KnownDot> dots = SheetDots();
  const Eigen::Isometry3d truth = LookingDown(dots);
  std::mt19937 random(1);
  Disturbance how;
  how.pixel_sd = 0;

  auto spots = SpotsOf(rig, dots, truth, how, random);
  for (auto& of_camera : spots) {
    for (DetectedSpot& spot : of_camera) spot.covariance = 1e-4 * Eigen::Matrix2d::Identity();
  }
  const MarkerMatch match = MatchMarkers(rig, dots, spots, {});

  ASSERT_EQ(match.status, Status::kOk);
  EXPECT_EQ(match.matched, 14);
  EXPECT_LT(ErrorAt(dots, match.pose.T_rig_robot, truth), 1e-7);  // m; the centroids' quadrature
}

std::vector<KnownDot> Grid() {
  std::vector<KnownDot> dots;
  for (int i = 0; i < 9; ++i) {
    dots.push_back({0.04 * Eigen::Vector3d(i % 3, i / 3, 0), Eigen::Vector3d::UnitZ(), 6e-3});
  }
  return dots;
}

TEST(MatchMarkers, SaysThatASymmetricLayoutIsAmbiguous) {
  const camera::Rig rig = MakeStereoRig();
  std::mt19937 random(1);
  const auto spots = SpotsOf(rig, Grid(), LookingDown(Grid()), {}, random);

  const MarkerMatch match = MatchMarkers(rig, Grid(), spots, {});

  EXPECT_EQ(match.status, Status::kAmbiguous);
  EXPECT_EQ(match.matched, 9);
  EXPECT_EQ(match.rival, 9);
}

TEST(MatchMarkers, TakesTheLabellingThatIsNearTheGuess) {
  const camera::Rig rig = MakeStereoRig();
  const Eigen::Isometry3d truth = LookingDown(Grid());
  std::mt19937 random(1);
  const auto spots = SpotsOf(rig, Grid(), truth, {}, random);
  const Eigen::Isometry3d guess = Eigen::Translation3d(0.005, -0.01, 0.01) * truth *
                                  Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ());

  const MarkerMatch match = MatchMarkers(rig, Grid(), spots, guess);

  ASSERT_EQ(match.status, Status::kOk);
  EXPECT_TRUE(match.by_guess);
  EXPECT_LT(ErrorAt(Grid(), match.pose.T_rig_robot, truth), 3e-4);  // m; noise of 0.05 px
}

TEST(MatchMarkers, AGuessHalfwayBetweenTwoLabellingsDoesNotDecide) {
  const camera::Rig rig = MakeStereoRig();
  std::mt19937 random(1);
  const auto spots = SpotsOf(rig, Grid(), LookingDown(Grid()), {}, random);
  const Eigen::Vector3d centre = CentreOf(Grid());
  const Eigen::Isometry3d between = LookingDown(Grid()) * Eigen::Translation3d(centre) *
                                    Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitZ()) *
                                    Eigen::Translation3d(-centre);

  EXPECT_EQ(MatchMarkers(rig, Grid(), spots, between).status, Status::kAmbiguous);
}

TEST(MatchMarkers, RefusesWhatAreNotItsDots) {
  const camera::Rig rig = MakeStereoRig();
  const std::vector<KnownDot> dots = SheetDots();
  for (int seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    Disturbance how;
    for (int d = 0; d < 14; ++d) how.hidden.push_back(d);
    how.decoys = 14;
    const auto spots = SpotsOf(rig, dots, LookingDown(dots), how, random);
    EXPECT_FALSE(MatchMarkers(rig, dots, spots, {}).ok()) << seed;
  }
}

TEST(MatchMarkers, SaysThatItSeesTooFew) {
  const camera::Rig rig = MakeStereoRig();
  EXPECT_EQ(MatchMarkers(rig, SheetDots(), {{}, {}}, {}).status, Status::kTooFewSeen);
}

TEST(MatchMarkers, ItsCovarianceIsThatOfItsErrors) {
  const camera::Rig rig = MakeStereoRig();
  const std::vector<KnownDot> dots = SheetDots();
  const Eigen::Isometry3d truth = LookingDown(dots);
  for (const double misplacement : {0.0, 2e-4}) {  // m
    double sum = 0;
    constexpr int kWorlds = 60;
    for (int seed = 0; seed < kWorlds; ++seed) {
      std::mt19937 random(seed);
      Disturbance how;
      how.misplacement = misplacement;
      const auto match = MatchMarkers(rig, dots, SpotsOf(rig, dots, truth, how, random), {});
      ASSERT_TRUE(match.ok());
      const Eigen::Isometry3d error = truth * match.pose.T_rig_robot.inverse();
      const Eigen::AngleAxisd turn(error.linear());
      geometry::Vector6d xi;
      xi << error.translation(), turn.angle() * turn.axis();
      sum += xi.dot(match.pose.covariance.inverse() * xi) / 6;
    }
    // 1 for errors as large as stated; the floor under the pixels makes it half where noise is all.
    EXPECT_GT(sum / kWorlds, 0.3) << misplacement;
    EXPECT_LT(sum / kWorlds, 1.6) << misplacement;
  }
}

TEST(MatchOptions, ChecksEveryOption) {
  const auto refused = [](auto change) {
    MatchOptions options;
    change(&options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  refused([](MatchOptions* o) { o->max_misplacement = 0; });
  refused([](MatchOptions* o) { o->max_misfit_px = -1; });
  refused([](MatchOptions* o) { o->size_tolerance = 1; });
  refused([](MatchOptions* o) { o->min_facing = 1; });
  refused([](MatchOptions* o) { o->min_share = 0; });
  refused([](MatchOptions* o) { o->min_lead = 0; });
  refused([](MatchOptions* o) { o->max_triples = 0; });
}

}  // namespace
}  // namespace softforce::calibration
