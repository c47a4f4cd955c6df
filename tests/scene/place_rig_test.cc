#include "softforce/scene/place_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "softforce/base/input_error.h"
#include "softforce/scene/rig_file.h"

namespace softforce::scene {
namespace {

const char* const kCameras =
    "softforce: 1\n"
    "# measured on a Tuesday\n"
    "cameras:\n"
    "  only: {model: brown_conrady, resolution: [640, 480], intrinsics: [500, 500, 320, 240],\n"
    "         distortion: [0, 0, 0, 0],\n"
    "         T_camera_rig: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}\n";

std::filesystem::path Write(const std::string& name, const std::string& text) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / name;
  std::ofstream(file) << text;
  return file;
}

std::string Read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

Eigen::Isometry3d Place(double x) {
  return Eigen::Translation3d(x, 0.2, 0.3) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY());
}

// Of a rig that is 0.7 m away: its turns and shifts go together.
geometry::Matrix6d Spread() {
  Eigen::Matrix<double, 6, 3> turns;
  turns << 0, 0.7, 0, -0.7, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  geometry::Matrix6d covariance = 1e-6 * turns * turns.transpose();
  covariance.diagonal().head<3>().array() += 1e-10;
  return covariance;
}

TEST(WritePlacedRig, AddsThePlaceAndLeavesTheRestAlone) {
  const auto file = Write("place_add.yaml", kCameras);

  WritePlacedRig(file, {Place(0.1), Spread(), "sd 0.1 mm\nand more"}, file);

  EXPECT_EQ(Read(file).substr(0, std::string(kCameras).size()), kCameras);
  EXPECT_NE(Read(file).find("  # sd 0.1 mm\n  # and more\n"), std::string::npos);
  EXPECT_EQ(LoadRig(file).T_rig_robot->matrix(), Place(0.1).matrix());
  EXPECT_EQ(LoadRig(file).T_rig_robot_covariance, Spread());
}

TEST(WritePlacedRig, ReplacesAnOldPlaceInAnyForm) {
  const std::string rows =
      "T_rig_robot:\n  - [1, 0, 0, 0]\n  - [0, 1, 0, 0]\n  - [0, 0, 1, 0]\n  - [0, 0, 0, 1]\n";
  const std::string flow =
      "T_rig_robot: [[1, 0, 0, 0], [0, 1, 0, 0],\n  [0, 0, 1, 0], [0, 0, 0, 1]]\n";
  const std::string cameras = std::string(kCameras).substr(13);  // without the version
  for (const std::string& old : {rows, flow}) {
    const auto file = Write("place_replace.yaml", "softforce: 1\n" + old + "# after\n" + cameras);

    WritePlacedRig(file, {Place(0.4), Spread(), "new"}, file);
    WritePlacedRig(file, {Place(0.4), 4 * Spread(), "newer"}, file);

    EXPECT_EQ(LoadRig(file).T_rig_robot->matrix(), Place(0.4).matrix());
    const std::string text = Read(file);
    EXPECT_EQ(LoadRig(file).T_rig_robot_covariance, 4 * Spread());
    EXPECT_EQ(text.find("T_rig_robot:"), text.rfind("T_rig_robot:"));
    EXPECT_EQ(text.find("T_rig_robot_c"), text.rfind("T_rig_robot_c"));
    EXPECT_NE(text.find("# after\n" + cameras), std::string::npos);
  }
}

TEST(WritePlacedRig, WritesAnotherFile) {
  const auto file = Write("place_from.yaml", kCameras);
  const auto to = std::filesystem::path(::testing::TempDir()) / "place_to.yaml";
  WritePlacedRig(file, {Place(0.1), Spread(), ""}, to);
  EXPECT_EQ(Read(file), kCameras);
  EXPECT_TRUE(LoadRig(to).T_rig_robot);
}

TEST(WritePlacedRig, KeepsTheStatisticsOfTheCalibration) {
  RigStatistics statistics;
  statistics.board = "chessboard:9x6,square=25mm";
  statistics.views = 14;
  statistics.parameters = {"only: fx"};
  statistics.covariance = Eigen::MatrixXd::Constant(1, 1, 0.16);
  const auto file = Write("place_statistics.yaml", kCameras);
  SaveRig(LoadRig(file), file, statistics);

  WritePlacedRig(file, {Place(0.1), Spread(), ""}, file);

  const std::optional<RigStatistics> kept = LoadRigStatistics(file);
  ASSERT_TRUE(kept.has_value());
  EXPECT_EQ(kept->board, statistics.board);
  EXPECT_EQ(kept->views, 14);
  EXPECT_EQ(kept->covariance, statistics.covariance);
  EXPECT_EQ(LoadRig(file).T_rig_robot_covariance, Spread());
}

TEST(WritePlacedRig, AnExactPlaceTakesAnOldCovarianceAway) {
  const auto file = Write("place_exact.yaml", kCameras);
  WritePlacedRig(file, {Place(0.1), Spread(), ""}, file);
  WritePlacedRig(file, {Place(0.2), geometry::Matrix6d::Zero(), ""}, file);
  EXPECT_EQ(Read(file).find("covariance"), std::string::npos);
  EXPECT_TRUE(LoadRig(file).T_rig_robot_covariance.isZero(0));
}

class OfAnotherProgram : public ::testing::TestWithParam<RigFormat> {
 protected:
  // A rig file of one camera in that format.
  std::filesystem::path Saved() const {
    // Of its own: tests run beside each other.
    std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '_');
    const auto folder = std::filesystem::path(::testing::TempDir()) / name;
    std::filesystem::create_directories(folder);
    const camera::Rig rig = LoadRig(Write(name + ".yaml", kCameras));
    if (GetParam() == RigFormat::kRos) {
      SaveRigAs(rig, GetParam(), folder);
      return folder / "only.yaml";
    }
    SaveRigAs(rig, GetParam(), folder / "rig.yaml");
    return folder / "rig.yaml";
  }
};

TEST_P(OfAnotherProgram, BecomesARigOfOursWithThePlace) {
  const auto from = Saved();
  const auto to = from.parent_path() / "converted.yaml";
  WritePlacedRig(from, {Place(0.1), Spread(), ""}, to);
  EXPECT_EQ(FormatOfRig(to), RigFormat::kSoftforce);
  EXPECT_EQ(LoadRig(to).cameras[0].name, LoadRig(from).cameras[0].name);
  EXPECT_EQ(LoadRig(to).T_rig_robot->matrix(), Place(0.1).matrix());
  EXPECT_EQ(LoadRig(to).T_rig_robot_covariance, Spread());
}

TEST_P(OfAnotherProgram, IsNotReplacedByARigOfOurs) {
  const auto file = Saved();
  const std::string before = Read(file);
  EXPECT_THROW(WritePlacedRig(file, {Place(0.1), Spread(), ""}, file), base::InputError);
  EXPECT_EQ(Read(file), before);
}

INSTANTIATE_TEST_SUITE_P(Formats, OfAnotherProgram,
                         ::testing::Values(RigFormat::kOpenCv, RigFormat::kKalibr, RigFormat::kRos),
                         [](const auto& instance) { return NameOf(instance.param); });

TEST(WritePlacedRig, RefusesAPlaceThatItCannotReplace) {
  const std::string quoted =
      std::string(kCameras) +
      "\"T_rig_robot\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n";
  const auto file = Write("place_quoted.yaml", quoted);
  EXPECT_THROW(WritePlacedRig(file, {Place(0.1), Spread(), ""}, file), base::InputError);
  EXPECT_EQ(Read(file), quoted);
}

}  // namespace
}  // namespace softforce::scene
