#include "softforce/vision/time_offset.h"

#include <random>

#include "softforce/base/input_error.h"
#include "support/stereo_rig.h"

namespace softforce::vision {
namespace {

constexpr double kRate = 30;  // Hz

// Where a marker is at a time, m: some hertz, some millimetres up and down and to the sides.
Eigen::Vector3d Moving(int marker, double t, double amplitude = 6e-3) {
  const double phase = 0.7 * marker;
  return Eigen::Vector3d(
      0.02 * marker - 0.04 + amplitude * std::sin(2 * M_PI * 0.9 * t + phase),
      0.01 * (marker % 3) - 0.01 + amplitude * std::sin(2 * M_PI * 1.3 * t + 2 * phase),
      0.45 + 0.5 * amplitude * std::sin(2 * M_PI * 0.5 * t));
}

struct Scene {
  double offset_s = 0;  // of the second camera's stamps
  double noise_px = 0;  // standard deviation
  double seconds = 4;
  double amplitude = 6e-3;  // m
  double wild_share = 0;    // of pictures in which a marker is found far off
  unsigned seed = 1;
};

std::vector<TrackPair> TracksOf(const camera::Rig& rig, const Scene& scene) {
  std::mt19937 random(scene.seed);
  std::normal_distribution<double> noise(0, 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto see = [&](int c, const Eigen::Vector3d& p) {
    Eigen::Vector2d pixel = testing::ProjectInto(rig, p)[static_cast<size_t>(c)].pixel;
    pixel += scene.noise_px * Eigen::Vector2d(noise(random), noise(random));
    if (uniform(random) < scene.wild_share) pixel += Eigen::Vector2d(30, 40);
    return pixel;
  };
  std::vector<TrackPair> tracks(5);
  for (int m = 0; m < 5; ++m) {
    for (int k = 0; k < scene.seconds * kRate; ++k) {
      const double t = k / kRate, t2 = (k + 0.3) / kRate;  // free-running cameras
      tracks[m].in_first.push_back({t, see(0, Moving(m, t, scene.amplitude))});
      tracks[m].in_second.push_back({t2 + scene.offset_s, see(1, Moving(m, t2, scene.amplitude))});
    }
  }
  return tracks;
}

TimeOffset Estimate(const Scene& scene, const TimeOffsetOptions& options = {}) {
  const camera::Rig rig = testing::MakeStereoRig();
  return EstimateTimeOffset(rig, 0, 1, TracksOf(rig, scene), options);
}

TEST(TimeOffset, IsFoundFromMovingMarkers) {
  for (const double offset_s : {-0.071, -0.004, 0.0, 0.0127, 0.09}) {
    const TimeOffset found = Estimate({offset_s});
    ASSERT_TRUE(found.ok()) << found.BriefReport();
    // s; what cubics between pictures miss of a motion of 1.3 Hz.
    EXPECT_NEAR(found.offset_s, offset_s, 2e-5) << found.BriefReport();
  }
}

TEST(TimeOffset, HasAStandardDeviationThatIsTrue) {
  constexpr int kTrials = 100;
  double squares = 0, reported = 0;
  for (int i = 0; i < kTrials; ++i) {
    Scene scene{0.0137, 0.2, 2};
    scene.seed = static_cast<unsigned>(i + 1);
    const TimeOffset found = Estimate(scene);
    ASSERT_TRUE(found.ok());
    squares += std::pow(found.offset_s - 0.0137, 2);
    reported += found.sd_s / kTrials;
  }
  const double sampled = std::sqrt(squares / kTrials);
  EXPECT_NEAR(reported / sampled, 1, 0.25);  // 3.5 standard deviations of a sample of 100
}

TEST(TimeOffset, BearsMarkersThatWereFoundInTheWrongPlace) {
  Scene scene{0.0137, 0.1};
  scene.wild_share = 0.03;
  const TimeOffset found = Estimate(scene);
  ASSERT_TRUE(found.ok()) << found.BriefReport();
  EXPECT_NEAR(found.offset_s, 0.0137, 4 * found.sd_s);
}

TEST(TimeOffset, SaysThatMarkersHardlyMove) {
  Scene scene{0.0137, 0.2};
  scene.amplitude = 2e-5;  // m
  EXPECT_EQ(Estimate(scene).status, TimeOffset::Status::kTooLittleMotion);
}

// Cameras are calibrated to some tenths of a pixel.
TEST(TimeOffset, IsNotLedAstrayByAnErrorOfTheRig) {
  const camera::Rig rig = testing::MakeStereoRig();
  std::vector<TrackPair> tracks = TracksOf(rig, {0.0137, 0.1});
  for (size_t m = 0; m < tracks.size(); ++m) {
    const double error_px = m % 2 == 0 ? 0.8 : 0.3;
    for (TimedPixel& seen : tracks[m].in_second) seen.pixel.y() += error_px;
  }
  const TimeOffset found = EstimateTimeOffset(rig, 0, 1, tracks);
  ASSERT_TRUE(found.ok()) << found.BriefReport();
  EXPECT_NEAR(found.offset_s, 0.0137, 4 * found.sd_s);
}

// An error of the rig could not be told from an offset.
TEST(TimeOffset, SaysThatAMotionOneWayDoesNotDo) {
  const camera::Rig rig = testing::MakeStereoRig();
  std::vector<TrackPair> tracks(1);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.1);  // px
  for (int k = 0; k < 120; ++k) {
    const double t = k / kRate;
    const auto seen = testing::ProjectInto(rig, {0.01, -0.02 + 0.01 * t, 0.45});
    tracks[0].in_first.push_back({t, seen[0].pixel});
    tracks[0].in_second.push_back({t + 0.01, seen[1].pixel + Eigen::Vector2d(0, noise(random))});
  }
  EXPECT_EQ(EstimateTimeOffset(rig, 0, 1, tracks).status, TimeOffset::Status::kTooLittleMotion);
}

TEST(TimeOffset, SaysThatItLiesOutsideOfTheSearch) {
  TimeOffsetOptions options;
  options.longest_s = 0.02;
  EXPECT_EQ(Estimate({0.05}, options).status, TimeOffset::Status::kAtLimit);
}

TEST(TimeOffset, SaysThatThereAreTooFewPictures) {
  EXPECT_EQ(Estimate({0, 0, 0.2}).status, TimeOffset::Status::kTooFewPictures);
  const camera::Rig rig = testing::MakeStereoRig();
  EXPECT_EQ(EstimateTimeOffset(rig, 0, 1, {}).status, TimeOffset::Status::kTooFewPictures);
}

TEST(TimeOffset, DoesNotInterpolateOverGaps) {
  const camera::Rig rig = testing::MakeStereoRig();
  std::vector<TrackPair> tracks = TracksOf(rig, {0.01});
  for (TrackPair& track : tracks) {  // one second is hidden from the second camera
    auto& seen = track.in_second;
    seen.erase(seen.begin() + 40, seen.begin() + 70);
  }
  const TimeOffset found = EstimateTimeOffset(rig, 0, 1, tracks);
  EXPECT_NEAR(found.offset_s, 0.01, 2e-5);  // s, as without the gap
}

TEST(TimeOffsetRefusal, NamesOptionsOutOfRange) {
  for (double TimeOffsetOptions::*option :
       {&TimeOffsetOptions::longest_s, &TimeOffsetOptions::longest_gap_s,
        &TimeOffsetOptions::robust_px, &TimeOffsetOptions::largest_sd_s}) {
    TimeOffsetOptions options;
    options.*option = 0;
    EXPECT_THROW(options.Check(), base::InputError);
  }
}

}  // namespace
}  // namespace softforce::vision
