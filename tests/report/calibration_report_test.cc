#include "softforce/report/calibration_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "report/example_record.h"

namespace softforce::report {
namespace {

using ::testing::HasSubstr;
using testing::MakeFailedRecord;
using testing::MakeRecord;
using testing::MakeSingleCameraRecord;
using ::testing::Not;
using ::testing::StartsWith;

int Occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(BriefReport, GivesTheVerdictAndTheFigures) {
  EXPECT_EQ(BriefReport(MakeRecord()),
            "Usable, but read the advice: 2 cameras, 11 views, 0.113 px RMS; held-out views 0.131 "
            "px, 0.0420 mm between neighbouring points, 0.0860 mm from the board");
  EXPECT_EQ(BriefReport(MakeFailedRecord()),
            "Not usable (too few views): left: 2 pictures with the board, expected at least 3");
}

TEST(BriefReport, LeavesOutMillimetresOfASingleCamera) {
  EXPECT_EQ(BriefReport(MakeSingleCameraRecord()),
            "Usable: 1 camera, 11 views, 0.113 px RMS; held-out views 0.131 px");
}

TEST(FullReport, ShowsEveryParameterWithTheDigitsThatItsDeviationAllows) {
  const std::string report = FullReport(MakeRecord());

  EXPECT_THAT(report, HasSubstr("fx                  1400.00         0.42 px\n"));
  EXPECT_THAT(report, HasSubstr("k1                  -0.1200       0.0013 \n"));
  EXPECT_THAT(report, HasSubstr("rotation y           18.335        0.011 °\n"));
  EXPECT_THAT(report, HasSubstr("warp x                0.180        0.020 mm\n"));
  // |(-0.15, 0.002, 0.01)| m, each axis known to 0.05 mm
  EXPECT_THAT(report, HasSubstr("left to right: 150.346 mm, sd 0.050 mm\n"));
}

TEST(FullReport, SaysWhatWasLeftOutAndWhatToDo) {
  const std::string report = FullReport(MakeRecord());

  EXPECT_THAT(report, HasSubstr("1 picture left out (no board found: 1)\n"
                                "    left: dark_<3>.jpg: no board found\n"));
  EXPECT_THAT(report, HasSubstr("right: no board within 160 px of the left edge\n"
                                "      Take pictures with the board at the left edge of right."));
}

TEST(CalibrationPage, NeedsNothingFromOutside) {
  const std::string page = CalibrationPage(MakeRecord());

  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  for (const char* const outside : {"http:", "https:", "src=", "href=", "url(", "@import"}) {
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  }
}

TEST(CalibrationPage, ClosesWhatItOpens) {
  for (const CalibrationRecord& record :
       {MakeRecord(), MakeSingleCameraRecord(), MakeFailedRecord()}) {
    const std::string page = CalibrationPage(record);
    for (const char* const tag : {"div", "svg", "figure", "table", "tr", "td", "ul", "li", "p",
                                  "details", "text", "title", "main"}) {
      const std::string name = tag;
      const int opened = Occurrences(page, "<" + name + ">") + Occurrences(page, "<" + name + " ");
      EXPECT_EQ(opened, Occurrences(page, "</" + name + ">")) << name;
    }
  }
}

TEST(CalibrationPage, HasNoNumberThatIsNone) {
  for (const CalibrationRecord& record :
       {MakeRecord(), MakeSingleCameraRecord(), MakeFailedRecord()}) {
    const std::string page = CalibrationPage(record);
    EXPECT_FALSE(std::regex_search(page, std::regex("[\" (:](-?nan|-?inf)[\" ,)<]")));
  }
}

TEST(CalibrationPage, DrawsEveryPictureOfEveryCamera) {
  const CalibrationRecord record = MakeRecord();
  const std::string page = CalibrationPage(record);

  // A bar with its tooltip for each of 12 views and 2 cameras; a line of the table besides.
  for (int v = 0; v < 12; ++v) {
    const std::string name = "board_" + std::to_string(v) + ".jpg, ";
    EXPECT_EQ(Occurrences(page, "<title>" + name + "left: 0.1") +
                  Occurrences(page, "<title>" + name + "left: 2.4"),
              1)
        << name;
  }
  EXPECT_EQ(Occurrences(page, ", left out</title>"), 2);
  EXPECT_EQ(Occurrences(page, "Where the board was seen\""), 2);
  EXPECT_EQ(Occurrences(page, "Projection uncertainty over the picture\""), 2);
}

TEST(CalibrationPage, EscapesNamesOfFiles) {
  const std::string page = CalibrationPage(MakeRecord());

  EXPECT_THAT(page, HasSubstr("dark_&lt;3&gt;.jpg"));
  EXPECT_THAT(page, Not(HasSubstr("dark_<3>")));
}

TEST(CalibrationPage, TellsWhyNothingWasFitted) {
  const std::string page = CalibrationPage(MakeFailedRecord());

  EXPECT_THAT(page, HasSubstr("not usable"));
  EXPECT_THAT(page, HasSubstr("left: 2 pictures with the board, expected at least 3"));
  EXPECT_THAT(page, HasSubstr("Take more pictures."));
}

TEST(CalibrationPage, GivesTheSameBytesForTheSameRecord) {
  EXPECT_EQ(CalibrationPage(MakeRecord()), CalibrationPage(MakeRecord()));
}

}  // namespace
}  // namespace softforce::report
