#include "pipeline/known_states.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace softforce::pipeline {
namespace {

const std::string kDemo =
    std::string(SOFTFORCE_SOURCE_DIR) + "/datasets/sheet_two_weights/scene.yaml";
constexpr double kSd = 2e-5;  // m

MarkerObservation Seen(int feature, const Eigen::Vector3d& position, bool one_camera = false) {
  MarkerObservation observation{feature, {}};
  observation.seen.position = position;
  observation.seen.whitening = Eigen::Matrix3d::Identity() / kSd;
  if (one_camera) observation.seen.whitening = Eigen::Matrix3d::Identity().topRows(2) / kSd;
  return observation;
}

TEST(KnownStates, AveragesTheFramesOfOneShape) {
  const scene::Scene scene = scene::LoadScene(kDemo);
  const World world = BuildWorld(scene);
  const std::vector<KnownWeights> weights =
      ParseWeights({"4:7: 0 = 0.5 N, 1 = 0.2 N", "0: none"}, scene);
  KnownStates known(scene, world, weights);
  EXPECT_TRUE(known.Wants(0) && known.Wants(6));
  EXPECT_FALSE(known.Wants(1) || known.Wants(7));
  EXPECT_EQ(known.end_frame(), 7);

  known.Add(0, {}, {Seen(3, {0, 0, 0})});
  known.Add(4, {}, {Seen(3, {1, 2, 3}), Seen(5, {0, 0, 1}, true)});
  known.Add(5, {}, {Seen(3, {3, 2, 1})});
  const std::vector<estimation::KnownState> states = known.Collected();

  ASSERT_EQ(states.size(), 2u);
  EXPECT_TRUE(states[0].forces.isZero(0));
  EXPECT_EQ(states[1].name, "frames 4 to 5");
  EXPECT_NE(states[0].group, states[1].group);
  EXPECT_NEAR((states[1].forces.rowwise().sum() - Eigen::Vector3d(0, 0, -0.7)).norm(), 0,
              1e-12);  // N; both weights, rounding
  ASSERT_EQ(states[1].observations.size(), 2u);
  EXPECT_EQ(states[1].points, (std::vector<int>{3, 5}));
  const estimation::Observation& mean = states[1].observations[0];
  EXPECT_LT((mean.position - Eigen::Vector3d(2, 2, 2)).norm(), 1e-12);  // m; rounding
  // As sure as a single frame, not more.
  const Eigen::Matrix3d information = mean.whitening.transpose() * mean.whitening;
  EXPECT_LT((information * kSd * kSd - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_EQ(states[1].observations[1].whitening.rows(), 2);  // what one camera saw
}

// Three markers of a scene in frames of one spec, and what is said of their movement.
std::vector<std::string> MovementOf(const std::function<Eigen::Vector3d(int, int)>& shift) {
  const scene::Scene scene = scene::LoadScene(kDemo);
  const World world = BuildWorld(scene);
  const std::vector<KnownWeights> weights = ParseWeights({"10:20: 0 = 0.5 N"}, scene);
  KnownStates known(scene, world, weights);
  for (int frame = 10; frame < 20; ++frame) {
    std::vector<MarkerObservation> observations;
    for (int marker = 0; marker < 3; ++marker) {
      const BodyPoint& point = world.markers[marker];
      const Eigen::Vector3d rest = point.weights.Apply(world.mesh().nodes) + point.offset;
      observations.push_back(
          Seen(marker, rest + Eigen::Vector3d(0, 0, -5e-3) + shift(frame, marker), marker == 2));
      observations.back().seen.at = point.weights;
      observations.back().seen.offset = point.offset;
      observations.back().seen.marker = marker;
    }
    known.Add(frame, {}, observations);
  }
  return known.Moving(scene);
}

TEST(KnownStates, TellsOfABodyThatMovesInFramesOfOneSpec) {
  // m; a ramp of a tenth of the displacement.
  const auto moving =
      MovementOf([](int frame, int) { return Eigen::Vector3d(0, 0, -5e-4 * (frame - 10) / 9); });
  ASSERT_EQ(moving.size(), 1u);
  EXPECT_NE(moving[0].find("the body moves in frames 10 to 19: 2 of 3 markers"),
            std::string::npos)  // the third one is seen by one camera, and not along z
      << moving[0];
}

TEST(KnownStates, IsAtRestInNoiseAndWithOneWrongDetection) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, kSd);
  const auto shift = [&](int frame, int marker) {
    Eigen::Vector3d off(noise(random), noise(random), noise(random));
    if (frame == 14 && marker == 1) off.x() += 8e-3;  // m
    return off;
  };
  EXPECT_TRUE(MovementOf(shift).empty());
}

TEST(KnownStates, KeepsFramesOfDifferentActuationApart) {
  scene::Scene scene = scene::LoadScene(kDemo);
  scene::Actuator cable;
  cable.name = "side";
  cable.input = scene::ActuatorInput::kTension;
  cable.points = {{0.1, 0.1, 0.01}};
  cable.guide = {0.1, 0.1, 0.2};
  cable.offset = 0.1;
  scene.actuators = {cable};
  scene.actuation.time_s = {0, 1};
  scene.actuation.inputs = Eigen::Vector2d(0, 1);
  const World world = BuildWorld(scene);
  const std::vector<KnownWeights> weights = ParseWeights({"0:10: none"}, scene);
  KnownStates known(scene, world, weights);

  for (const auto& [frame, time] : {std::pair(0, 0.0), {1, 0.5}, {2, 0.5001}, {3, 1.0}}) {
    known.Add(frame, ActuationAt(scene, time), {Seen(0, {0, 0, 0})});
  }
  const std::vector<estimation::KnownState> states = known.Collected();

  ASSERT_EQ(states.size(), 3u);
  EXPECT_EQ(states[1].name, "frames 1 to 2");
  EXPECT_DOUBLE_EQ(states[1].actuation.cables[0].value, 0.6);  // N; told 0.5, and the offset
  EXPECT_EQ(states[0].group, states[2].group);
}

}  // namespace
}  // namespace softforce::pipeline
