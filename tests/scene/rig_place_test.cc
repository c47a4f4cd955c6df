#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/temp_scene.h"
#include "softforce/scene/rig_file.h"

namespace softforce::scene {
namespace {

using ::testing::HasSubstr;
using testing::kRigText;
using testing::Replaced;
using testing::RigRefusal;
using ::testing::StartsWith;
using testing::TempFolder;
using testing::WriteFile;

const char* const kPlace =
    "softforce: 1\n"
    "T_rig_robot: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]]\n"
    "T_rig_robot_covariance:\n"
    "  - [4e-8, 0, 0, 0, 1e-8, 0]\n"
    "  - [0, 4e-8, 0, 0, 0, 0]\n"
    "  - [0, 0, 4e-8, 0, 0, 0]\n"
    "  - [0, 0, 0, 1e-8, 0, 0]\n"
    "  - [1e-8, 0, 0, 0, 1e-8, 0]\n"
    "  - [0, 0, 0, 0, 0, 0]\n";

// Why a rig file with this covariance is refused.
std::string Refused(const std::string& from, const std::string& to) {
  return RigRefusal("softforce: 1\n", Replaced(kPlace, from, to));
}

TEST(LoadRigPlace, ReadsItsCovariance) {
  const auto file =
      WriteFile(TempFolder() / "rig.yaml", Replaced(kRigText, "softforce: 1\n", kPlace));
  const camera::Rig rig = LoadRig(file);
  EXPECT_EQ(rig.T_rig_robot_covariance(0, 0), 4e-8);
  EXPECT_EQ(rig.T_rig_robot_covariance(0, 4), 1e-8);
  EXPECT_EQ(rig.T_rig_robot_covariance(5, 5), 0);
}

TEST(LoadRigPlace, IsExactWithoutACovariance) {
  const std::string place(kPlace);
  const auto file = WriteFile(
      TempFolder() / "rig.yaml",
      Replaced(kRigText, "softforce: 1\n", place.substr(0, place.find("T_rig_robot_cov"))));
  EXPECT_TRUE(LoadRig(file).T_rig_robot_covariance.isZero(0));
}

TEST(LoadRigPlace, RefusesACovarianceThatIsNotSymmetric) {
  EXPECT_THAT(Refused("[1e-8, 0, 0, 0, 1e-8, 0]", "[2e-8, 0, 0, 0, 1e-8, 0]"),
              StartsWith("rig.yaml:3: T_rig_robot_covariance: is not symmetric: got 2e-08 at "
                         "[4][0] and 1e-08 at [0][4]\n"));
}

TEST(LoadRigPlace, RefusesANegativeVariance) {
  EXPECT_THAT(Refused("[0, 0, 4e-8, 0, 0, 0]", "[0, 0, -4e-8, 0, 0, 0]"),
              StartsWith("rig.yaml:6: T_rig_robot_covariance[2]: got the variance -4e-08 at its "
                         "place 2, expected 0 or more\n"));
}

TEST(LoadRigPlace, RefusesACorrelationBeyondOne) {
  std::string text = Replaced(kPlace, "[4e-8, 0, 0, 0, 1e-8, 0]", "[4e-8, 0, 0, 0, 3e-8, 0]");
  text = Replaced(text, "[1e-8, 0, 0, 0, 1e-8, 0]", "[3e-8, 0, 0, 0, 1e-8, 0]");
  EXPECT_THAT(RigRefusal("softforce: 1\n", text), HasSubstr("is no covariance"));
}

TEST(LoadRigPlace, RefusesACorrelationWithAnExactCoordinate) {
  std::string text = Replaced(kPlace, "[4e-8, 0, 0, 0, 1e-8, 0]", "[4e-8, 0, 0, 0, 1e-8, 1e-9]");
  text = Replaced(text, "[0, 0, 0, 0, 0, 0]", "[1e-9, 0, 0, 0, 0, 0]");
  EXPECT_THAT(RigRefusal("softforce: 1\n", text), HasSubstr("is no covariance"));
}

TEST(LoadRigPlace, RefusesNumbersThatAreNone) {
  EXPECT_THAT(Refused("[0, 0, 4e-8, 0, 0, 0]", "[0, 0, .nan, 0, 0, 0]"),
              StartsWith("rig.yaml:6: T_rig_robot_covariance[2][2]: got \".nan\""));
}

TEST(LoadRigPlace, RefusesAnotherSize) {
  EXPECT_THAT(Refused("[0, 0, 4e-8, 0, 0, 0]", "[0, 0, 4e-8]"),
              HasSubstr("T_rig_robot_covariance[2]: got 3 items, expected 6"));
  EXPECT_THAT(Refused("  - [0, 0, 4e-8, 0, 0, 0]\n", ""),
              HasSubstr("T_rig_robot_covariance: got 5 items, expected 6"));
}

TEST(LoadRigPlace, RefusesACovarianceOfNoPlace) {
  EXPECT_THAT(
      Refused("T_rig_robot: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]]\n", ""),
      HasSubstr("T_rig_robot_covariance: there is no T_rig_robot"));
}

}  // namespace
}  // namespace softforce::scene
