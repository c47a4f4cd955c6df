#include "softforce/printing/target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "softforce/base/input_error.h"
#include "softforce/vision/board_detector.h"
#include "softforce/vision/dots.h"
#include "softforce/vision/tags.h"

namespace softforce::printing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr double kDpi = 150;
constexpr double kMmPerPixel = 25.4 / kDpi;

fs::path FileIn(const std::string& name) {
  const fs::path folder = fs::path(::testing::TempDir()) / "softforce_printing";
  fs::create_directories(folder);
  return folder / name;
}

std::string Bytes(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// The page as poppler shows it, at 150 dots per inch. It rounds edges to a quarter of a dot, so it
// is asked for twice as many.
cv::Mat Rendered(const std::string& target, const SheetOptions& options = {}) {
  std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  std::replace(test.begin(), test.end(), '/', '_');
  const fs::path pdf = FileIn(test + ".pdf"), png = FileIn(test);
  WriteSheet(pdf, DrawTarget(ParseTarget(target), options));
  std::ostringstream command;
  command << "pdftoppm -r " << 2 * kDpi << " -gray -png -singlefile '" << pdf.string() << "' '"
          << png.string() << "'";
  EXPECT_EQ(std::system(command.str().c_str()), 0);
  cv::Mat page = cv::imread(png.string() + ".png", cv::IMREAD_GRAYSCALE);
  cv::resize(page, page, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
  cv::GaussianBlur(page, page, cv::Size(), 0.7);  // px; no lens draws edges as hard as poppler
  return page;
}

std::string Refusal(const std::string& target, const SheetOptions& options = {}) {
  try {
    DrawTarget(ParseTarget(target), options);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "accepted";
}

class EveryBoard : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryBoard, IsPrintedInTrueSizeAndAsItsDetectorExpects) {
  const auto target = std::get<BoardTarget>(ParseTarget(GetParam()));
  const vision::Board& board = target.board;
  const bool y_up = board.kind == vision::Board::Kind::kAprilGrid;

  const vision::BoardDetection detection = vision::DetectBoard(Rendered(GetParam()), board);

  ASSERT_TRUE(detection.ok()) << detection.reason;
  ASSERT_EQ(detection.view.size(), board.NumPoints());
  // On the page the board stands upright and unscaled: it is only shifted.
  std::vector<Eigen::Vector2d> shifts;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (int k = 0; k < detection.view.size(); ++k) {
    const Eigen::Vector3d point = 1e3 * board.Point(detection.view.ids[k]);
    shifts.push_back(kMmPerPixel * detection.view.pixels[k] -
                     Eigen::Vector2d(point.x(), y_up ? -point.y() : point.y()));
    mean += shifts.back() / detection.view.size();
  }
  for (const Eigen::Vector2d& shift : shifts) {
    // mm; poppler rounds each edge by up to 0.011 mm, and a corner lies on four of them.
    EXPECT_LT((shift - mean).norm(), 0.03);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, EveryBoard,
    ::testing::Values("chessboard", "chessboard:8x5,square=12.5mm", "charuco",
                      "charuco:6x8,square=15mm,marker=11mm,dictionary=5X5_100,legacy", "aprilgrid",
                      "aprilgrid:4x3,tag=30mm,spacing=0.25,family=tag25h9,first=3,border=2",
                      "circles"));

TEST(DrawTarget, FitsTheDefaultsOnEveryPaper) {
  for (const char* kind : {"chessboard", "charuco", "aprilgrid", "circles", "tags", "markers"}) {
    for (const char* paper : {"A4", "a3", "Letter"}) {
      SheetOptions options;
      options.paper = paper;
      EXPECT_EQ(Refusal(kind, options), "accepted") << kind << " on " << paper;
    }
  }
}

TEST(DrawTarget, DrawsTagsUprightAndInTrueSize) {
  for (const char* family : {"tag36h11", "tag25h9", "tag16h5", "tagStandard41h12"}) {
    const cv::Mat page = Rendered(std::string("tags:size=30mm,first=3,count=6,family=") + family);
    const auto tags = vision::TagDetector(family).Detect(page);
    ASSERT_EQ(tags.size(), 6u) << family;
    for (int k = 0; k < 6; ++k) {
      EXPECT_EQ(tags[k].id, 3 + k);
      const Eigen::Vector2d across = kMmPerPixel * (tags[k].corners[1] - tags[k].corners[0]);
      EXPECT_NEAR(across.x(), 30, 0.03) << family;  // mm; 0.2 px of this rendering
      EXPECT_NEAR(across.y(), 0, 0.03) << family;
    }
  }
}

TEST(DrawTarget, DrawsMarkersInTrueSize) {
  for (const char* text : {"markers:size=8mm,count=20", "markers:size=8mm,count=20,white"}) {
    const bool white = std::string(text).back() == 'e';
    vision::DotOptions options;
    options.polarity = white ? vision::DotPolarity::kBright : vision::DotPolarity::kDark;
    options.min_diameter = 30;  // px; digits of the ruler are smaller
    const auto dots = vision::DetectDots(Rendered(text), options);
    ASSERT_EQ(dots.size(), 20u) << text;
    for (const vision::Dot& dot : dots) {
      EXPECT_NEAR(kMmPerPixel * dot.long_axis, 8, 0.1) << text;  // mm, half a pixel
    }
    double nearest = INFINITY;
    for (size_t k = 1; k < dots.size(); ++k) {
      nearest = std::min(nearest, kMmPerPixel * (dots[k].centroid - dots[0].centroid).norm());
    }
    EXPECT_NEAR(nearest, 12, 0.03) << text;  // mm
  }
}

TEST(DrawTarget, PutsARulerOfWholeCentimetresOnThePage) {
  const Sheet sheet = DrawTarget(ParseTarget("chessboard"), {});
  std::map<std::string, double> lengths;  // m, of the longest line along each axis
  for (const Sheet::Line& line : sheet.lines) {
    const Eigen::Vector2d d = (line.to - line.from).cwiseAbs();
    lengths["x"] = std::max(lengths["x"], d.x());
    lengths["y"] = std::max(lengths["y"], d.y());
  }
  EXPECT_NEAR(lengths["x"], 0.150, 1e-12);
  EXPECT_NEAR(lengths["y"], 0.150, 1e-12);
}

TEST(DrawTarget, SaysOnThePageHowToCalibrateWithIt) {
  const Sheet sheet = DrawTarget(ParseTarget("aprilgrid:3x2,tag=40mm,spacing=0.3,border=2"), {});
  std::string words;
  for (const Sheet::Text& text : sheet.texts) words += text.text + "\n";
  EXPECT_THAT(words, HasSubstr("softforce calibrate --board aprilgrid:3x2,tag=40mm,spacing=0.3\n"));
  EXPECT_THAT(words, HasSubstr("border=2"));
}

TEST(DrawTarget, KeepsEverythingInsideTheMargins) {
  SheetOptions options;
  options.margin = 7e-3;
  for (const char* kind : {"chessboard", "charuco", "circles", "tags", "markers"}) {
    const Sheet sheet = DrawTarget(ParseTarget(kind), options);
    Eigen::AlignedBox2d ink;
    for (const auto& box : sheet.black) ink.extend(box);
    for (const auto& line : sheet.lines) ink.extend(line.from), ink.extend(line.to);
    for (const auto& disc : sheet.discs) {
      ink.extend(Eigen::Vector2d(disc.centre.array() - 0.5 * disc.diameter));
      ink.extend(Eigen::Vector2d(disc.centre.array() + 0.5 * disc.diameter));
    }
    for (const auto& text : sheet.texts) ink.extend(text.at);
    EXPECT_GE(ink.min().minCoeff(), options.margin - 1e-9) << kind;
    EXPECT_LE(ink.max().x(), sheet.width - options.margin + 1e-9) << kind;
    EXPECT_LE(ink.max().y(), sheet.height - options.margin + 1e-9) << kind;
  }
}

TEST(DrawTarget, NamesTheLargestThatFits) {
  const std::string refusal = Refusal("chessboard:9x6,square=40mm");
  EXPECT_THAT(refusal, AllOf(HasSubstr("the pattern is 400 x 280 mm"),
                             HasSubstr("The largest of this shape that fits: chessboard:9x6,")));
  const size_t at = refusal.find("fits: ") + 6;
  const std::string largest = refusal.substr(at, refusal.find(" on ", at) - at);
  EXPECT_EQ(Refusal(largest), "accepted");
  auto larger = std::get<BoardTarget>(ParseTarget(largest));
  larger.board.square += 1e-4;
  EXPECT_NE(Refusal(larger.board.Text()), "accepted");

  EXPECT_THAT(Refusal("markers:size=6mm,count=2000"), HasSubstr("At most "));
  EXPECT_THAT(Refusal("tags:size=400mm"), HasSubstr("Take a smaller size"));
  EXPECT_THAT(Refusal("chessboard:99x99,square=40mm,"), HasSubstr("largest"));
  EXPECT_THAT(Refusal("aprilgrid:18x32,tag=80mm,spacing=0.01"), HasSubstr("largest"));
}

TEST(DrawTarget, TakesTheOrientationAskedFor) {
  SheetOptions options;
  options.orientation = Orientation::kPortrait;
  EXPECT_THAT(Refusal("chessboard:9x6,square=25mm", options), HasSubstr("A4 portrait leaves"));
  options.orientation = Orientation::kLandscape;
  EXPECT_GT(DrawTarget(ParseTarget("chessboard"), options).width, 0.29);
  options.orientation = ParseOrientation("portrait");
  EXPECT_LT(DrawTarget(ParseTarget("tags"), options).width, 0.22);
  EXPECT_THROW(ParseOrientation("upright"), base::InputError);
}

TEST(SheetOptions, RefusesValuesOutOfRange) {
  const auto refuses = [](auto change) {
    SheetOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  EXPECT_NO_THROW(SheetOptions().Check());
  refuses([](SheetOptions& o) { o.paper = "B5"; });
  refuses([](SheetOptions& o) { o.margin = -1e-3; });
  refuses([](SheetOptions& o) { o.margin = 0.05; });
}

TEST(ParseTarget, WritesBackWhatItRead) {
  for (const char* text :
       {"chessboard:9x6,square=20mm", "aprilgrid:3x2,tag=30mm,spacing=0.3,border=2",
        "tags:family=tag25h9,size=30mm,first=2,count=4", "markers:size=6mm,rim=2mm,count=40,white",
        "markers:size=5mm,rim=1mm"}) {
    EXPECT_EQ(TextOf(ParseTarget(text)), text);
  }
}

TEST(ParseTarget, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(Refusal("dots"), AllOf(HasSubstr("\"dots\""), HasSubstr("tags or markers")));
  EXPECT_THAT(Refusal("tags:size=0mm"), HasSubstr("size is 0 mm"));
  EXPECT_THAT(Refusal("tags:sizes=3mm"), HasSubstr("family, size, first, count"));
  EXPECT_THAT(Refusal("tags:family=tag1"), HasSubstr("\"tag1\""));
  EXPECT_THAT(Refusal("tags:family=tag16h5,first=28,count=5"), HasSubstr("ids are 0 to 29"));
  EXPECT_THAT(Refusal("markers:size=-1mm"), HasSubstr("size is -1 mm"));
  EXPECT_THAT(Refusal("markers:rim=0mm"), HasSubstr("rim is 0 mm"));
  EXPECT_THAT(Refusal("markers:colour=red"), HasSubstr("size, rim, count, white"));
  EXPECT_THAT(Refusal("aprilgrid:3x2,tag=30mm,spacing=0.3,border=3"), HasSubstr("border is 3"));
  EXPECT_THAT(Refusal("chessboard:9x6"), HasSubstr("\"square\" is missing"));
}

TEST(WriteSheet, GivesTheSameBytesForTheSameSheet) {
  const Sheet sheet = DrawTarget(ParseTarget("charuco"), {});
  for (const char* ending : {".pdf", ".svg"}) {
    const fs::path first = FileIn(std::string("first") + ending);
    const fs::path second = FileIn(std::string("second") + ending);
    WriteSheet(first, sheet);
    WriteSheet(second, sheet);
    EXPECT_GT(Bytes(first).size(), 1000u);
    EXPECT_TRUE(Bytes(first) == Bytes(second)) << ending;
  }
}

TEST(WriteSheet, GivesAnSvgItsTrueSize) {
  const fs::path file = FileIn("size.svg");
  WriteSheet(file, DrawTarget(ParseTarget("charuco"), {}));
  const std::string text = Bytes(file);
  const size_t at = text.find("width=\"") + 7;
  char* unit = nullptr;
  const double width = std::strtod(text.c_str() + at, &unit);
  EXPECT_NEAR(width, 210 / 25.4 * 72, 0.01);
  EXPECT_EQ(std::string(unit, 2), "pt");
}

TEST(WriteSheet, RefusesOtherEndingsAndFoldersThatAreNotThere) {
  EXPECT_THROW(WriteSheet("board.png", {}), base::InputError);
  EXPECT_THROW(WriteSheet("/nowhere/board.pdf", DrawTarget(ParseTarget("charuco"), {})),
               base::InputError);
}

}  // namespace
}  // namespace softforce::printing
