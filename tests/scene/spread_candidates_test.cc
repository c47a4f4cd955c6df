#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "scene/temp_scene.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {
namespace {

using ::testing::HasSubstr;

const char* const kList = "    - {id: 1, position: 65 140 10 mm, direction: normal}\n";

// A scene of the sheet of 200 × 200 × 10 mm, held at its corners, with this in place of one of its
// three candidates.
std::string SceneWith(const std::string& item) {
  std::string text = testing::Replaced(testing::kSceneText, kList, "    - " + item + "\n");
  text = testing::Replaced(text, "finger.msh", SOFTFORCE_SOURCE_DIR "/meshes/sheet.msh");
  return testing::Replaced(text, "group: base", "group: clamps");
}

std::vector<Candidate> CandidatesWith(const std::string& item) {
  return LoadScene(testing::WriteScene(SceneWith(item))).forces.candidates;
}

std::string RefusalOf(const std::string& item) {
  return testing::Refusal([&] { CandidatesWith(item); });
}

TEST(SpreadCandidates, CoverASurfaceGroup) {
  const std::vector<Candidate> all =
      CandidatesWith("{group: bottom, spacing: 40 mm, direction: normal}");

  ASSERT_GT(all.size(), 2u + 15u);
  EXPECT_EQ(all.front().id, 0);
  EXPECT_EQ(all.back().id, 2);
  const std::vector<Candidate> spread(all.begin() + 1, all.end() - 1);
  for (size_t i = 0; i < spread.size(); ++i) {
    EXPECT_EQ(spread[i].id, 3 + static_cast<int>(i));  // on from the largest id of the list
    EXPECT_EQ(spread[i].direction, ForceDirection::kNormal);
    EXPECT_NEAR(spread[i].position.z(), 0, 1e-9);  // m; rounding in the mesh file
    for (size_t j = 0; j < i; ++j) {
      EXPECT_GE((spread[i].position - spread[j].position).norm(), 0.04);
    }
  }
}

TEST(SpreadCandidates, KeepOffWhatIsHeld) {
  for (const Candidate& candidate :
       CandidatesWith("{group: top, spacing: 15 mm, direction: [0, 0, -1]}")) {
    if (candidate.id < 3) continue;
    const Eigen::Vector3d p = candidate.position;
    const double from_corner =  // m, of the nearest clamp, a square of 10 mm
        std::max(std::min(p.x(), 0.2 - p.x()), std::min(p.y(), 0.2 - p.y()));
    EXPECT_GT(from_corner, 0.01);
  }
}

TEST(SpreadCandidates, AreTheSameEveryTime) {
  const char* const item = "{group: top, spacing: 25 mm, direction: free}";
  const std::vector<Candidate> once = CandidatesWith(item), again = CandidatesWith(item);

  ASSERT_EQ(once.size(), again.size());
  for (size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i].position, again[i].position);
}

TEST(SpreadCandidates, CanBeSimulatedForcesAt) {
  const std::string text = SceneWith("{group: bottom, spacing: 60 mm, direction: free}");
  const Scene scene = LoadScene(testing::WriteScene(text + R"(simulation:
  pictures: false
  forces:
    - {candidate: 4, history: [{time: 0 s, force: 0 0 1 N}]}
)"),
                                SceneFiles::kToSimulate);

  ASSERT_EQ(scene.simulation->forces.size(), 1u);
  EXPECT_EQ(scene.simulation->forces[0].position, scene.forces.candidates[2].position);
}

TEST(SpreadCandidates, NameTheGroupsThatThereAre) {
  EXPECT_THAT(RefusalOf("{group: botom, spacing: 40 mm, direction: free}"),
              HasSubstr("scene.yaml:30: forces: candidates[1]: the mesh has no surface group "
                        "\"botom\"; it has: bottom, clamps, top"));
}

TEST(SpreadCandidates, AreRefusedOnWhatIsHeld) {
  EXPECT_THAT(RefusalOf("{group: clamps, spacing: 4 mm, direction: free}"),
              HasSubstr("every part of the surface group \"clamps\" touches what is held"));
}

TEST(SpreadCandidates, AreRefusedIfTheyAreTooMany) {
  EXPECT_THAT(RefusalOf("{group: top, spacing: 0.01 mm, direction: free}"),
              HasSubstr("or more candidates, expected 500 at most"));
  EXPECT_THAT(RefusalOf("{group: top, spacing: 7 mm, direction: free}"),
              HasSubstr("candidates, expected 500 at most"));
}

TEST(SpreadCandidates, WantASpacing) {
  EXPECT_THAT(RefusalOf("{group: top, direction: free}"),
              HasSubstr("candidates[1]: missing key \"spacing\""));
  EXPECT_THAT(RefusalOf("{group: top, spacing: 0 mm, direction: free}"),
              HasSubstr("candidates[1]: spacing: got \"0 mm\", expected more than 0"));
}

TEST(SpreadCandidates, HaveNoPlaceOfTheirOwn) {
  EXPECT_THAT(RefusalOf("{group: top, spacing: 40 mm, id: 4, direction: free}"),
              HasSubstr("candidates[1]: id: unknown key, expected one of direction, group, "
                        "spacing"));
  EXPECT_THAT(RefusalOf("{position: 1 2 10 mm, direction: free}"),
              HasSubstr("candidates[1]: missing key \"id\""));
}

}  // namespace
}  // namespace softforce::scene
