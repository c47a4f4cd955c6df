#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <tuple>

#include "acceptance/program.h"
#include "softforce/scene/scene.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;

// The shipped recording; with cells of 4 nodes, which are enough to choose markers and take little.
Folder SheetToDesign(const std::string& name) {
  const Folder folder = testing::CopyOfDemo(name);
  testing::Edit(folder / "scene.yaml", "order: 2", "order: 1");
  return folder;
}

testing::ProgramResult Design(const Folder& folder, const std::string& options) {
  return testing::RunProgram(
      fmt::format("design '{0}/scene.yaml' --out '{0}/design' {1}", folder.string(), options));
}

// The scene with the section "markers" replaced by the fragment.
void PutInScene(const Folder& folder) {
  std::string scene = testing::ReadText(folder / "scene.yaml");
  const size_t begin = scene.find("markers:"), end = scene.find("forces:");
  scene.replace(begin, end - begin, testing::ReadText(folder / "design/markers.yaml"));
  testing::WriteText(folder / "scene.yaml", scene);
}

TEST(DesignCommand, ChoosesMarkersThatTellMoreThanTheScenesOwn) {
  const Folder folder = SheetToDesign("design_sheet");

  const testing::ProgramResult result = Design(folder, "");

  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("14 markers chosen of"), std::string::npos) << result.output;
  const auto summary = nlohmann::json::parse(testing::ReadText(folder / "design/summary.json"));
  const double best = summary["best"]["location_error_mm"];
  EXPECT_EQ(summary["rig_place_from"], "fiducials");
  EXPECT_LT(best, summary["own"]["location_error_mm"]);
  EXPECT_LT(best, summary["random"]["best_location_error_mm"]);
  EXPECT_LT(best, 0.25 * summary["location_error_without_markers_mm"].get<double>());
  EXPECT_GT(summary["candidate_spacings"].size(), 3u);

  const auto rows = testing::ReadTable(folder / "design/markers.csv");
  ASSERT_EQ(rows.size(), 14u);
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("cameras"), "2");
    EXPECT_NEAR(std::stod(row.at("z_mm")), 10, 1e-3);  // only the top is seen; digits of the table
  }
}

TEST(DesignCommand, WritesAFragmentThatASceneTakes) {
  const Folder folder = SheetToDesign("design_fragment");
  const testing::ProgramResult result = Design(folder, "--count 5 --on z-max --spacing '20 mm'");
  ASSERT_EQ(result.exit_code, 0) << result.errors;

  PutInScene(folder);

  const auto scene = scene::LoadScene(folder / "scene.yaml");
  const auto rows = testing::ReadTable(folder / "design/markers.csv");
  ASSERT_EQ(scene.markers.points.size(), 5u);
  EXPECT_DOUBLE_EQ(scene.markers.size, 6e-3);
  for (size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(scene.markers.points[i].position.x(), 1e-3 * std::stod(rows[i].at("x_mm")), 1e-9);
  }
}

TEST(DesignCommand, DrawsTheBodyInTheColoursOfAScale) {
  const Folder folder = SheetToDesign("design_picture");
  const testing::ProgramResult result =
      Design(folder, "--count 4 --noise '0.1 mm' --spacing '25 mm'");
  ASSERT_EQ(result.exit_code, 0) << result.errors;

  const cv::Mat3b picture = cv::imread((folder / "design/design.png").string());

  ASSERT_FALSE(picture.empty());
  std::set<std::tuple<int, int, int>> colours;
  for (const cv::Vec3b& pixel : picture) colours.insert({pixel[0], pixel[1], pixel[2]});
  EXPECT_GT(colours.size(), 300u);  // a flat drawing has a few dozen
  EXPECT_NE(testing::ReadText(folder / "design/location_error.vtu")
                .find("Name=\"location_error_chosen_mm\""),
            std::string::npos);
}

TEST(DesignCommand, NeedsNoCamerasWithANoise) {
  const Folder folder = SheetToDesign("design_without_cameras");
  for (const char* file : {"left.mp4", "right.mp4"}) std::filesystem::remove(folder / file);

  const testing::ProgramResult result =
      Design(folder, "--count 5 --on z-min --noise '0.1 mm' --spacing '25 mm'");

  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const auto& row : testing::ReadTable(folder / "design/markers.csv")) {
    EXPECT_NEAR(std::stod(row.at("z_mm")), 0, 1e-3);  // digits of the table
    EXPECT_EQ(row.at("sd_mm"), "0.1000");
  }
}

TEST(DesignCommand, RefusesWhatItCannotDo) {
  const Folder folder = SheetToDesign("design_refusals");
  const auto refuses = [&](const std::string& options, const std::vector<const char*>& named) {
    const testing::ProgramResult result = Design(folder, options);
    EXPECT_EQ(result.exit_code, 2) << options;
    for (const char* word : named) {
      EXPECT_NE(result.errors.find(word), std::string::npos) << options << ": " << result.errors;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "design/markers.csv")) << options;
  };
  refuses("--on lid", {"--on", "no surface group \"lid\"", "softforce mesh --help"});
  refuses("--loads lid", {"--loads", "no surface group \"lid\""});
  refuses("--on z-min --registration-frames 1",
          {"--on z-min", "seen by 2 of the cameras", "softforce register"});
  refuses("--count 5000 --noise '0.1 mm'", {"--count", "asks for 5000 markers", "--spacing"});
  refuses("--count -1", {"--count", "must be 1 or more"});
  refuses("--load '0 N'", {"--load", "greater than 0 N"});
  refuses("--load '3 mm'", {"--load", "mm"});
  refuses("--random 0", {"--random", "must be 1 or more"});
  refuses("--criterion best", {"--criterion", "expected location or d-optimal"});
  refuses("--pixel-noise 0", {"--pixel-noise", "greater than 0 px"});
  refuses("--spacing '-1 mm'", {"--spacing", "0 or more"});
  refuses("--common-model-error 1", {"--common-model-error", "below 1"});
}

TEST(DesignCommand, SaysIfNothingTellsWhereTheCamerasStand) {
  const Folder folder = SheetToDesign("design_no_rig_place");
  std::string scene = testing::ReadText(folder / "scene.yaml");
  scene.erase(scene.find("  fiducials:"));
  testing::WriteText(folder / "scene.yaml", scene);

  const testing::ProgramResult result = Design(folder, "");

  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("nothing says where the cameras stand"), std::string::npos)
      << result.errors;
  EXPECT_NE(result.errors.find("--noise"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace softforce
