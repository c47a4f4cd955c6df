#include "pipeline/tag_oddities.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace softforce::pipeline {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class TagOdditiesTest : public ::testing::Test {
 protected:
  TagOdditiesTest() {
    scene_.markers.type = scene::MarkerType::kAprilTag;
    scene_.markers.family = "tag36h11";
    scene_.markers.points.resize(2);
    scene_.markers.points[0].id = 4;
    scene_.markers.points[1].id = 7;
    calibration::Fiducial fiducial;
    fiducial.family = "tag36h11";
    fiducial.id = 100;
    scene_.cameras.fiducials.push_back(fiducial);
    rig_.cameras.resize(2);
    rig_.cameras[0].name = "left";
    rig_.cameras[1].name = "right";
  }

  // What the cameras see, in so many frames.
  std::vector<std::string> After(int frames, const std::vector<int>& left,
                                 const std::vector<int>& right) const {
    std::vector<CameraDetections> cameras(2);
    for (size_t c = 0; c < 2; ++c) {
      for (const int id : c == 0 ? left : right) {
        vision::Tag tag;
        tag.family = "tag36h11";
        tag.id = id;
        cameras[c].tags.push_back(tag);
      }
    }
    TagOddities oddities(scene_, rig_);
    for (int i = 0; i < frames; ++i) oddities.Add(cameras);
    return oddities.Messages();
  }

  scene::Scene scene_;
  camera::Rig rig_;
};

TEST_F(TagOdditiesTest, AreNoneWithTheScenesOwnMarkersAndFiducials) {
  EXPECT_THAT(After(5, {4, 7, 100}, {4, 100}), IsEmpty());
}

TEST_F(TagOdditiesTest, NameATagThatIsThereTwiceAndTheCameraThatSeesIt) {
  EXPECT_THAT(After(5, {4, 7}, {4, 4, 7}),
              ElementsAre(AllOf(HasSubstr("\"right\""), HasSubstr("tag 4 was there twice"),
                                HasSubstr("5 pictures"))));
}

TEST_F(TagOdditiesTest, NameTheTagsThatTheSceneDoesNotKnow) {
  EXPECT_THAT(After(2, {4, 31, 12}, {4, 31}),
              ElementsAre(AllOf(HasSubstr("does not know"), HasSubstr("used: 31;"))));
}

}  // namespace
}  // namespace softforce::pipeline
