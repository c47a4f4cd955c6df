#include "softforce/pipeline/known_weights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

using ::testing::HasSubstr;

// Two candidates of given direction, ids 0 and 7, and a free one, id 3.
scene::Scene ThreeCandidates() {
  scene::Scene scene;
  scene.forces.candidates = {{0, {}, scene::ForceDirection::kFixed, {0, 0, -1}},
                             {7, {}, scene::ForceDirection::kNormal, {}},
                             {3, {}, scene::ForceDirection::kFree, {}}};
  return scene;
}

TEST(ParseWeights, ReadsForcesAlongGivenDirectionsAndFreeOnes) {
  const auto weights = ParseWeights(
      {"20:30: 0 = 0.559 N, 7 = 250 mN", " 5 : 3 = 0.1 0 -0.5 N ", "0:3:none"}, ThreeCandidates());

  ASSERT_EQ(weights.size(), 3u);
  EXPECT_EQ(weights[0].first_frame, 20);
  EXPECT_EQ(weights[0].end_frame, 30);
  ASSERT_EQ(weights[0].forces.size(), 2u);
  EXPECT_DOUBLE_EQ(weights[0].forces.at(0)(0), 0.559);  // N, by the candidate's place in the list
  EXPECT_DOUBLE_EQ(weights[0].forces.at(1)(0), 0.25);
  EXPECT_EQ(weights[1].first_frame, 5);
  EXPECT_EQ(weights[1].end_frame, 6);
  EXPECT_EQ(weights[1].forces.at(2), Eigen::Vector3d(0.1, 0, -0.5));
  EXPECT_TRUE(weights[2].forces.empty());
  EXPECT_TRUE(weights[2].Contains(2));
  EXPECT_FALSE(weights[2].Contains(3));
}

TEST(ParseWeights, ReadsTheLinesOfAFile) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "weights.txt";
  std::ofstream(file) << "# weighed on Monday\n\n0:10: none\n  29: 0 = 0.859 N\r\n";

  const auto weights = ParseWeights({file.string(), "12: none"}, ThreeCandidates());

  ASSERT_EQ(weights.size(), 3u);
  EXPECT_EQ(weights[1].first_frame, 29);
  EXPECT_EQ(weights[2].first_frame, 12);
  std::ofstream(file) << "# nothing\n";
  EXPECT_THROW(ParseWeights({file.string()}, ThreeCandidates()), base::InputError);
}

struct Refused {
  const char* spec;
  const char* says;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.spec; }

class RefusedWeights : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedWeights, AreNamedWithWhatIsWrong) {
  try {
    ParseWeights({"40:50: none", GetParam().spec}, ThreeCandidates());
    ADD_FAILURE() << "it was accepted";
  } catch (const base::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().says));
    EXPECT_THAT(error.what(), HasSubstr(std::string("--weights \"") + GetParam().spec));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, RefusedWeights,
    ::testing::Values(Refused{"no_such_file", "expected FRAMES: CANDIDATE = FORCE"},
                      Refused{"1:2:3:4", "expected FRAMES: CANDIDATE = FORCE"},
                      Refused{"x: none", "expected a number or A:B"},
                      Refused{"-1: none", "expected a number or A:B"},
                      Refused{"1:: none", "expected a number or A:B"},
                      Refused{"5:5: none", "5:5 holds no frame"},
                      Refused{"5:", "says nothing about the forces"},
                      Refused{"5: 0.5 N", "expected CANDIDATE = FORCE or none"},
                      Refused{"5: 0 = 0.5", "got no unit, expected a force"},
                      Refused{"5: 0 = 57 mm", "a force"},
                      Refused{"5: 0 = 0 0 1 N", "whose direction is given"},
                      Refused{"5: 3 = 1 N", "whose direction is free"},
                      Refused{"5: 1 = 1 N", "no candidate \"1\", its ids are 0, 7, 3"},
                      Refused{"5: 0 = 1 N, 0 = 2 N", "candidate 0 is given twice"},
                      Refused{"5: 0 = 1 N,", "expected CANDIDATE = FORCE or none"},
                      Refused{"45:60: none", "frame 45 is in another one too"}));

TEST(ParseWeights, RefusesNone) {
  EXPECT_THROW(ParseWeights({}, ThreeCandidates()), base::InputError);
}

}  // namespace
}  // namespace softforce::pipeline
