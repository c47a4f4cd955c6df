#include "softforce/calibration/calibrate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/calibration_world.h"

namespace softforce::calibration {
namespace {

using softforce::testing::CalibrationWorld;
using softforce::testing::MakeStereoWorld;
using softforce::testing::See;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Status = Calibration::Status;

CalibrationOptions Quick() {
  CalibrationOptions options;
  options.max_folds = 0;
  options.uncertainty_columns = options.uncertainty_rows = 3;
  return options;
}

CalibrationInput SeeWithoutNoise(const CalibrationWorld& world) {
  std::mt19937 random(1);
  return See(world, 0, &random);
}

// Largest distance between where the true and the calibrated lens see a direction, over what was
// seen of the picture, px.
double LensDifference(const camera::Lens& truth, const camera::Lens& found,
                      const Calibration& result) {
  double worst = 0;
  for (const PointResidual& residual : result.residuals) {
    const auto ray = camera::UnprojectRay(truth, residual.pixel);
    if (!ray) return INFINITY;
    worst = std::max(worst, (camera::Project(found, *ray).pixel - residual.pixel).norm());
  }
  return worst;
}

void ExpectTruth(const CalibrationWorld& world, const Calibration& result) {
  ASSERT_TRUE(result.ok()) << Name(result.status) << ": " << result.reason;
  EXPECT_EQ(result.outliers, 0);
  for (size_t c = 0; c < world.rig.cameras.size(); ++c) {
    const camera::Camera& truth = world.rig.cameras[c];
    const camera::Camera& found = result.rig.cameras[c];
    // Of data without noise, only rounding and where the iterations end are left.
    EXPECT_LT(LensDifference(truth.lens, found.lens, result), 1e-5) << truth.name;  // px
    const Eigen::Isometry3d off = found.T_camera_rig * truth.T_camera_rig.inverse();
    EXPECT_LT(off.translation().norm(), 1e-8) << truth.name;                 // m
    EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 1e-8) << truth.name;  // rad
  }
  EXPECT_LT((result.warp - world.warp).norm(), 1e-8);  // m
}

TEST(Calibrate, RecoversAStereoRigAndTheBoardsBend) {
  CalibrationWorld world = MakeStereoWorld(10);
  world.warp = {0.0004, -0.0002};
  ExpectTruth(world, Calibrate(SeeWithoutNoise(world), Quick()));
}

TEST(Calibrate, RecoversOneCamera) {
  CalibrationWorld world = MakeStereoWorld(8);
  world.rig.cameras.resize(1);
  world.lenses.resize(1);
  const Calibration result = Calibrate(SeeWithoutNoise(world), Quick());
  ExpectTruth(world, result);
  EXPECT_EQ(result.values.size(), 4 + 5 + 2);
}

TEST(Calibrate, RecoversEachLensModel) {
  CalibrationWorld world = MakeStereoWorld(10);
  camera::Lens& left = world.rig.cameras[0].lens;
  camera::Lens& right = world.rig.cameras[1].lens;
  left.distortion = {-0.2, 0.1, 0.001, -0.001};
  right.model = camera::LensModel::kKannalaBrandt;
  right.distortion = {0.05, -0.02, 0.003, 0.001};
  world.lenses = {LensFit::kBrownConrady4, LensFit::kKannalaBrandt};
  ExpectTruth(world, Calibrate(SeeWithoutNoise(world), Quick()));
}

// One camera that sees beyond 90°, and the board all around it.
CalibrationWorld MakeFisheyeWorld() {
  CalibrationWorld world = MakeStereoWorld(25, 0.9, 3);
  world.rig.cameras.resize(1);
  world.lenses = {LensFit::kKannalaBrandt};
  world.rig.cameras[0].lens = {
      330, 331, 641.3, 509.8, {0.03, -0.01, 0.003, -0.0006}, camera::LensModel::kKannalaBrandt};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (Eigen::Isometry3d& T : world.T_rig_board) {
    const double direction = M_PI * unit(random);
    const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0);
    T = Eigen::AngleAxisd(1.2 * std::abs(unit(random)), axis) * Eigen::Translation3d(0, 0, -0.2) *
        T;
  }
  return world;
}

TEST(Calibrate, RecoversAWideFisheye) {
  const CalibrationWorld world = MakeFisheyeWorld();
  const CalibrationInput input = SeeWithoutNoise(world);
  double widest = 0;
  for (const CalibrationView& view : input.views) {
    for (const Eigen::Vector2d& pixel : view.seen[0].pixels) {
      widest = std::max(
          widest, std::acos(camera::UnprojectRay(world.rig.cameras[0].lens, pixel).value().z()));
    }
  }
  ASSERT_GT(widest, M_PI / 2);  // rad; else this tests nothing wide
  ExpectTruth(world, Calibrate(input, Quick()));
}

// Agreement where points were seen: numerator and denominator of the rational model may trade.
TEST(Calibrate, RecoversTheRationalModelWhereItWasSeen) {
  CalibrationWorld world = MakeStereoWorld(12);
  world.lenses.assign(2, LensFit::kBrownConrady8);
  for (camera::Camera& camera : world.rig.cameras) {
    camera.lens.distortion = {0.3, -0.1, 0.0006, -0.0004, 0.02, 0.5, -0.05, 0.01};
  }
  const CalibrationInput input = SeeWithoutNoise(world);
  const Calibration result = Calibrate(input, Quick());
  ASSERT_TRUE(result.ok()) << result.reason;
  for (int c = 0; c < 2; ++c) {
    // px; the weak prior on the rational terms is weighed against points stated as good to 0.1 px
    EXPECT_LT(LensDifference(world.rig.cameras[c].lens, result.rig.cameras[c].lens, result), 0.03);
  }
}

// Cameras 0 and 1 share views, and 1 and 2, but never 0 and 2.
CalibrationWorld MakeChain(CalibrationInput* input) {
  CalibrationWorld world = MakeStereoWorld(16);
  camera::Camera third = world.rig.cameras[0];
  third.name = "third";
  third.lens.fx = third.lens.fy = 1200;
  third.T_camera_rig = Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitY()) *
                       Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) *
                       Eigen::Translation3d(0.11, 0.01, 0.02);
  world.rig.cameras.push_back(third);
  world.lenses.assign(3, LensFit::kBrownConrady5);
  *input = SeeWithoutNoise(world);
  for (int v = 0; v < 16; ++v) input->views[v].seen[v % 2 == 0 ? 2 : 0] = {};
  return world;
}

TEST(Calibrate, ConnectsCamerasThroughOthers) {
  CalibrationInput input;
  const CalibrationWorld world = MakeChain(&input);
  ExpectTruth(world, Calibrate(input, Quick()));
}

TEST(Calibrate, NamesTheGroupsOfCamerasThatNeverSeeTheBoardTogether) {
  CalibrationInput input;
  MakeChain(&input);
  for (int v = 1; v < 16; v += 2) {  // what cameras 1 and 2 shared
    CalibrationView alone = input.views[v];
    alone.seen[1] = {};
    input.views.push_back(alone);
    input.views[v].seen[2] = {};
  }
  const Calibration result = Calibrate(input, Quick());
  EXPECT_EQ(result.status, Status::kNotConnected);
  EXPECT_THAT(result.groups, ElementsAre(ElementsAre(0, 1), ElementsAre(2)));
  EXPECT_THAT(result.reason, HasSubstr("{left, right} and {third}"));
  EXPECT_THAT(result.what_to_do, HasSubstr("at the same time"));
}

// Points moved across the picture, by hundreds of pixels: every fifth of the first ten in each.
std::vector<std::array<int, 3>> Poison(CalibrationInput* input) {
  std::vector<std::array<int, 3>> poisoned;
  for (int v = 0; v < static_cast<int>(input->views.size()); ++v) {
    for (int c = 0; c < 2; ++c) {
      vision::BoardView& seen = input->views[v].seen[c];
      for (int i = (v + c) % 5; i < std::min(10, seen.size()); i += 5) {
        seen.pixels[i].x() = std::fmod(seen.pixels[i].x() + 640, 1279);
        seen.pixels[i].y() = std::fmod(seen.pixels[i].y() + 512, 1023);
        poisoned.push_back({v, c, seen.ids[i]});
      }
    }
  }
  return poisoned;
}

TEST(Calibrate, OutliersDoNotChangeTheAnswer) {
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(10), 0.05, &random);
  CalibrationInput poisoned = input;
  const std::vector<std::array<int, 3>> bad = Poison(&poisoned);
  for (const auto& [v, c, id] : bad) {  // the same without the points
    vision::BoardView& seen = input.views[v].seen[c];
    const auto at = std::find(seen.ids.begin(), seen.ids.end(), id) - seen.ids.begin();
    seen.ids.erase(seen.ids.begin() + at);
    seen.pixels.erase(seen.pixels.begin() + at);
    seen.covariances.erase(seen.covariances.begin() + at);
  }

  const Calibration clean = Calibrate(input, Quick());
  const Calibration result = Calibrate(poisoned, Quick());

  ASSERT_TRUE(clean.ok() && result.ok());
  EXPECT_EQ(result.outliers, clean.outliers + static_cast<int>(bad.size()));
  for (const PointResidual& residual : result.residuals) {
    const std::array<int, 3> key = {residual.view, residual.camera, residual.id};
    const bool is_bad = std::find(bad.begin(), bad.end(), key) != bad.end();
    EXPECT_TRUE(residual.outlier || !is_bad);
  }
  for (size_t i = 0; i < clean.values.size(); ++i) {
    // in standard deviations; the floor is found among all points, and weighs them very little
    // differently
    EXPECT_NEAR(result.values[i].value, clean.values[i].value, 0.02 * clean.values[i].sd)
        << clean.values[i].name;
  }
}

TEST(Calibrate, LeavesOutAPictureThatIsNotOfTheView) {
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(10), 0.05, &random);
  vision::BoardView& wrong = input.views[3].seen[1];
  for (int& id : wrong.ids) id = 53 - id;  // as if the board had been turned by half a turn
  const Calibration result = Calibrate(input, Quick());
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_TRUE(result.views[3].pictures[1].left_out);
  EXPECT_FALSE(result.views[3].pictures[0].left_out);
  EXPECT_TRUE(std::any_of(result.advice.begin(), result.advice.end(), [](const Advice& advice) {
    return advice.kind == Advice::Kind::kPictureLeftOut && advice.camera == 1;
  }));
}

TEST(Calibrate, RaisesNoiseThatIsStatedTooLowToWhatTheFitLeaves) {
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(12), 0.1, &random);
  for (CalibrationView& view : input.views) {
    for (vision::BoardView& seen : view.seen) {
      for (Eigen::Matrix2d& covariance : seen.covariances) covariance *= 1e-2;
    }
  }
  const Calibration result = Calibrate(input, Quick());
  ASSERT_TRUE(result.ok());
  // px; the floor to 0.01 px gives 0.1; of 1200 points the noise is known to 2 %, its median to 3 %
  EXPECT_NEAR(result.floor_px, 0.0995, 0.009);
  EXPECT_NEAR(result.noise_px, 0.1, 0.006);
  EXPECT_NEAR(result.noise_factor, 1, 0.1);
}

// The definition of the projection uncertainty, sampled: a point at rest in each board's frame, put
// into the rig by where the boards are found, averaged, and projected by the calibrated camera.
Eigen::Vector2d SampledProjection(const CalibrationWorld& world, const Calibration& result, int c,
                                  const Eigen::Vector3d& p_camera) {
  const Eigen::Vector3d p_rig = world.rig.cameras[c].T_camera_rig.inverse() * p_camera;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (size_t v = 0; v < world.T_rig_board.size(); ++v) {
    mean += result.views[v].T_rig_board * (world.T_rig_board[v].inverse() * p_rig);
  }
  mean /= static_cast<double>(world.T_rig_board.size());
  const camera::Camera& camera = result.rig.cameras[c];
  return camera::Project(camera.lens, camera.T_camera_rig * mean).pixel;
}

TEST(Calibrate, ReportsTheScatterOfValuesAndOfTheProjection) {
  CalibrationWorld world = MakeStereoWorld(10);
  world.warp = {0.0002, -0.0003};
  std::mt19937 random(8);
  CalibrationOptions options = Quick();
  options.working_distance = 0.4;
  const std::vector<Eigen::Vector2d> places = {{0, 0}, {639.5, 511.5}, {1279, 511.5}};
  const std::array<int, 3> in_grid = {0, 4, 5};
  std::array<double, 3> sampled{}, reported{};  // px², of the right camera
  double squares = 0;                           // of the values' normalised errors
  int count = 0;
  for (int trial = 0; trial < 15; ++trial) {
    const Calibration result = Calibrate(See(world, 0.1, &random), options);
    ASSERT_TRUE(result.ok());
    for (double error : softforce::testing::NormalisedErrors(world, result)) {
      squares += error * error;
      ++count;
    }
    for (size_t i = 0; i < places.size(); ++i) {
      const Eigen::Vector3d ray =
          camera::UnprojectRay(world.rig.cameras[1].lens, places[i]).value();
      sampled[i] += (SampledProjection(world, result, 1, 0.4 * ray) - places[i]).squaredNorm();
      reported[i] += result.uncertainty[1].covariances[in_grid[i]].trace();
    }
  }
  // The mean of 390 squares, of which about a quarter are independent, scatters by 14 %.
  EXPECT_NEAR(squares / count, 1, 0.42);
  for (size_t i = 0; i < places.size(); ++i) {
    // A variance from 15 samples, in one direction mostly, scatters by 37 %.
    EXPECT_NEAR(sampled[i] / reported[i], 1, 0.9) << i;
  }
}

TEST(Calibrate, GivesTheSameBitsAgain) {
  std::mt19937 random(4);
  const CalibrationInput input = See(MakeStereoWorld(8), 0.1, &random);
  CalibrationOptions options = Quick();
  options.max_folds = 3;
  const Calibration once = Calibrate(input, options);
  const Calibration again = Calibrate(input, options);
  ASSERT_TRUE(once.ok());
  for (size_t i = 0; i < once.values.size(); ++i) {
    EXPECT_EQ(once.values[i].value, again.values[i].value);
    EXPECT_EQ(once.values[i].sd, again.values[i].sd);
  }
  EXPECT_EQ(once.hold_out.rms_px, again.hold_out.rms_px);
}

TEST(Calibrate, ChoosesTheLensModelByHeldOutViews) {
  CalibrationOptions options = Quick();
  options.max_folds = 3;
  std::mt19937 random(4);
  CalibrationInput input = See(MakeFisheyeWorld(), 0.1, &random);
  input.cameras[0].lens.reset();

  const Calibration result = Calibrate(input, options);

  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_THAT(result.lenses, ElementsAre(LensFit::kKannalaBrandt));
  ASSERT_EQ(result.trials.size(), 4);
  EXPECT_EQ(result.trials[3].hold_out_px, result.hold_out.rms_px);
}

// A lens that all models fit: the one with the fewest parameters.
TEST(Calibrate, PrefersTheLensModelWithFewerParameters) {
  CalibrationOptions options = Quick();
  options.max_folds = 3;
  std::mt19937 random(4);
  CalibrationWorld world = MakeStereoWorld(9);
  world.rig.cameras.resize(1);
  world.lenses.resize(1);
  world.rig.cameras[0].lens.distortion = {-0.1, 0.05, 0.0005, -0.0003};
  CalibrationInput input = See(world, 0.1, &random);
  input.cameras[0].lens.reset();
  EXPECT_THAT(Calibrate(input, options).lenses, ElementsAre(LensFit::kBrownConrady4));
}

TEST(Calibrate, ChoosesTheSimplestLensModelIfNoViewCanBeHeldOut) {
  CalibrationOptions options = Quick();
  options.max_folds = 3;
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(3), 0.02, &random);
  for (CameraToCalibrate& camera : input.cameras) camera.lens.reset();
  const Calibration result = Calibrate(input, options);
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_EQ(result.hold_out.folds, 0);
  EXPECT_THAT(result.lenses, ElementsAre(LensFit::kBrownConrady4, LensFit::kBrownConrady4));
}

TEST(Calibrate, SaysThatTheBoardNeverTilted) {
  std::mt19937 random(4);
  CalibrationWorld world = MakeStereoWorld(10, 0);
  world.rig.cameras.resize(1);
  world.lenses.resize(1);
  const Calibration result = Calibrate(See(world, 0.1, &random), Quick());
  EXPECT_EQ(result.status, Status::kUndetermined) << Name(result.status);
  EXPECT_THAT(result.what_to_do, HasSubstr("tilted by 30 to 45 degrees"));
}

TEST(Calibrate, SaysThatThereAreTooFewViews) {
  CalibrationInput input = SeeWithoutNoise(MakeStereoWorld(4));
  input.views[0].seen[1] = {};
  input.views[1].seen[1].ids.resize(5);
  input.views[1].seen[1].pixels.resize(5);
  input.views[1].seen[1].covariances.resize(5);
  const Calibration result = Calibrate(input, Quick());
  EXPECT_EQ(result.status, Status::kTooFewViews);
  EXPECT_EQ(result.reason,
            "camera \"right\" has 2 usable pictures of the board, expected at least 3");
}

TEST(Calibrate, SaysThatItIsAnotherBoard) {
  CalibrationInput input = SeeWithoutNoise(MakeStereoWorld(8));
  // The points counted in rows of six instead of nine.
  for (int id = 0; id < 54; ++id) input.board[id] = {0.02 * (id % 6), 0.02 * (id / 6), 0};
  const Calibration result = Calibrate(input, Quick());
  EXPECT_TRUE(result.status == Status::kBoardMismatch || result.status == Status::kNoStart)
      << Name(result.status);
  EXPECT_THAT(result.what_to_do, HasSubstr("the board given is the one in the pictures"));
}

TEST(Calibrate, StopsWhenAsked) {
  const std::atomic<bool> stop = true;
  CalibrationOptions options = Quick();
  options.stop = &stop;
  EXPECT_EQ(Calibrate(SeeWithoutNoise(MakeStereoWorld(5)), options).status, Status::kStopped);
}

bool Advises(const Calibration& result, Advice::Kind kind, const std::string& words) {
  return std::any_of(result.advice.begin(), result.advice.end(), [&](const Advice& advice) {
    return advice.kind == kind && advice.finding.find(words) != std::string::npos;
  });
}

TEST(Calibrate, AdvisesWhereTheBoardWasNotSeen) {
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(12), 0.05, &random);
  for (CalibrationView& view : input.views) {
    vision::BoardView kept;
    const vision::BoardView& seen = view.seen[0];
    for (int i = 0; i < seen.size(); ++i) {
      if (seen.pixels[i].x() < 300) continue;
      kept.ids.push_back(seen.ids[i]);
      kept.pixels.push_back(seen.pixels[i]);
      kept.covariances.push_back(seen.covariances[i]);
    }
    view.seen[0] = kept;
  }
  const Calibration result = Calibrate(input, Quick());
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(Advises(result, Advice::Kind::kEdgeNotCovered, "left: no board near the left edge"));
  EXPECT_FALSE(
      Advises(result, Advice::Kind::kEdgeNotCovered, "right: no board near the left edge"));
  EXPECT_EQ(result.cameras[0].coverage.leftCols(1).sum(), 0);
  EXPECT_EQ(result.cameras[0].coverage.sum(), result.cameras[0].points);
}

TEST(Calibrate, AdvisesToTilt) {
  std::mt19937 random(4);
  const Calibration result = Calibrate(See(MakeStereoWorld(12, 0.1), 0.02, &random), Quick());
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_TRUE(Advises(result, Advice::Kind::kFewViews, "") == false);
  EXPECT_TRUE(Advises(result, Advice::Kind::kUncertainFocal, "") ||
              Advises(result, Advice::Kind::kLittleTilt, ""));
}

TEST(Calibrate, AdvisesToShareViews) {
  std::mt19937 random(4);
  CalibrationInput input = See(MakeStereoWorld(16), 0.05, &random);
  for (int v = 2; v < 16; ++v) input.views[v].seen[v % 2] = {};
  const Calibration result = Calibrate(input, Quick());
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_TRUE(Advises(result, Advice::Kind::kFewSharedViews, "right sees the board together"));
}

TEST(Calibrate, AdvisesOnABentBoard) {
  CalibrationWorld world = MakeStereoWorld(10);
  world.warp = {0.001, 0};
  std::mt19937 random(4);
  const Calibration result = Calibrate(See(world, 0.05, &random), Quick());
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_NEAR(result.warp.x(), 1e-3, 3e-5);  // m; its standard deviation is 1e-5
  EXPECT_TRUE(Advises(result, Advice::Kind::kLargeWarp, "the board bends by"));
}

}  // namespace
}  // namespace softforce::calibration
