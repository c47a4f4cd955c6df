#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/temp_scene.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {
namespace {

using ::testing::HasSubstr;
using testing::kSceneText;
using testing::Replaced;
using testing::SceneRefusal;
using ::testing::StartsWith;
using testing::TempFolder;
using testing::WriteScene;

std::string LeftSource(const std::string& source) {
  return LoadScene(WriteScene(Replaced(kSceneText, "left.mp4", source))).cameras.sources.at("left");
}

TEST(CameraSection, MakesPathsAbsolute) {
  const Cameras cameras = LoadScene(WriteScene(kSceneText)).cameras;

  EXPECT_EQ(cameras.rig, TempFolder() / "rig.yaml");
  EXPECT_EQ(cameras.sources.at("left"), TempFolder() / "left.mp4");
}

TEST(CameraSection, KeepsSourcesThatAreNoFiles) {
  for (const std::string source :
       {"rtsp://cell/left", "/dev/video0", "0", "v4l2src ! videoconvert ! appsink"}) {
    EXPECT_EQ(LeftSource(source), source);
  }
}

TEST(CameraSection, TakesTheFolderOfARecordedCamera) {
  std::filesystem::create_directories(TempFolder() / "recording/left");
  EXPECT_EQ(LeftSource("recording/left"), TempFolder() / "recording/left");
}

TEST(CameraSection, ReadsFiducials) {
  const Cameras cameras = LoadScene(WriteScene(kSceneText)).cameras;

  ASSERT_EQ(cameras.fiducials.size(), 1);
  EXPECT_EQ(cameras.fiducials[0].family, "tag36h11");
  EXPECT_EQ(cameras.fiducials[0].id, 100);
  EXPECT_TRUE(cameras.fiducials[0].corners[1].isApprox(Eigen::Vector3d(0.02, 0.02, 0)));
}

TEST(CameraSection, NeedsNoFilesToJudgeAMesh) {
  const std::filesystem::path file = WriteScene(kSceneText);
  for (const char* name : {"left.mp4", "rig.yaml", "finger.msh", "actuation.csv"}) {
    ASSERT_TRUE(std::filesystem::remove(TempFolder() / name)) << name;
  }

  const Scene scene = LoadScene(file, SceneFiles::kNone);

  EXPECT_EQ(scene.cameras.sources.at("left"), TempFolder() / "left.mp4");
  EXPECT_FALSE(scene.actuators.empty());
  EXPECT_TRUE(scene.actuation.time_s.empty());
}

TEST(CameraSection, RefusesAVideoThatIsNotThere) {
  EXPECT_THAT(SceneRefusal("left.mp4", "lift.mp4"),
              StartsWith("scene.yaml:34: cameras: sources: left: there is no file lift.mp4\n"
                         "  Paths are relative to the folder of scene.yaml"));
}

TEST(CameraSection, RefusesARigThatIsNotThere) {
  EXPECT_THAT(SceneRefusal("rig.yaml", "rag.yaml"),
              StartsWith("scene.yaml:33: cameras: rig: there is no file rag.yaml"));
}

TEST(CameraSection, RefusesNoSources) {
  EXPECT_THAT(SceneRefusal("{left: left.mp4, right: \"rtsp://cell/right\"}", "{}"),
              StartsWith("scene.yaml:34: cameras: sources: got no cameras, expected at least one"));
}

TEST(CameraSection, RefusesAFiducialWithThreeCorners) {
  EXPECT_EQ(SceneRefusal("[0 20 0 mm, 20 20 0 mm, 20 0 0 mm, 0 0 0 mm]",
                         "[0 20 0 mm, 20 20 0 mm, 20 0 0 mm]"),
            "scene.yaml:36: cameras: fiducials[0]: corners: got 3 items, expected 4");
}

TEST(CameraSection, RefusesAFiducialGivenTwice) {
  const std::string corners = ", corners: [0 20 0 mm, 20 20 0 mm, 20 0 0 mm, 0 0 0 mm]}";
  EXPECT_EQ(
      SceneRefusal("    - {id: 100" + corners,
                   "    - {id: 100" + corners + "\n    - {family: tag36h11, id: 100" + corners),
      "scene.yaml:37: cameras: fiducials[1]: tag tag36h11 100 is given twice, expected once");
}

TEST(CameraSection, RefusesATagThatIsBothMarkerAndFiducial) {
  EXPECT_THAT(SceneRefusal("{id: 100", "{family: tag25h9, id: 7"),
              HasSubstr("tag tag25h9 7 is both a marker and a fiducial"));
}

}  // namespace
}  // namespace softforce::scene
