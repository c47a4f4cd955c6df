#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "report/json_text.h"
#include "report/scripts.h"
#include "softforce/report/run_report.h"

namespace softforce::report {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr int kMarkers = 14;

RunColumn Frame(int number) {
  RunColumn column;
  column.first_frame = column.last_frame = number;
  column.first_s = column.last_s = number / 30.0;
  column.frames = 1;
  if (number % 7 != 3) {  // those have no forces
    column.forces.resize(2);
    for (ForceExtent& force : column.forces) {
      for (size_t i = 0; i < 4; ++i) {
        const double value = 0.123456 * ((number * 37 + static_cast<int>(i)) % 101);
        force.value[i].Add(value);
        force.band[i].Add(value - 0.04);
        force.band[i].Add(value + 0.04);
      }
    }
    column.reduced_chi2.Add(0.5 + number % 3);
  }
  for (int m = 0; m < kMarkers; ++m) {
    column.markers.push_back(static_cast<unsigned char>((number * 31 + m * 17) % 4));
  }
  return column;
}

BodyView View(int frame) {
  BodyView view;
  view.frame = frame;
  view.time_s = frame / 30.0;
  view.u = Eigen::Matrix3Xf::Zero(3, 4);
  view.u(2, 3) = 0.001F * static_cast<float>(frame);
  view.forces.push_back({"F0", {0, 0, 0}, {0, 0, -1}, 0.1F});
  view.markers.push_back({7, 2, {0.01F, 0, 0}});
  return view;
}

RunRecord MakeRecord(int frames) {
  RunRecord record;
  record.scene = "sheet <i>&\"x\"</script>";
  record.usable = true;
  record.brief = "30 of 30 frames with forces";
  record.warnings = {"camera \"<left>\" went away"};
  record.advice = {{"Rejected in most frames: marker 7", "Check its position."}};
  record.cards = {{"0.571 N", "largest force"}};
  record.facts = {{"mesh", "a<b.msh"}};
  record.inputs = {{"<scene>.yaml", "00ff"}};
  record.forces = {"F0", "F<1>"};
  for (int m = 0; m < kMarkers; ++m) record.markers.push_back(m);
  record.marker_statuses = {"seen", "one camera", "hidden", "rejected"};
  for (int i = 0; i < frames; ++i) record.time.Add(Frame(i));
  record.stages = {{"detect", 3, 4, 5}};
  record.pictures = {{"Frame 0: first <frame>", "\xff\xd8\xff"}};
  record.body.nodes.resize(3, 4);  // a tetrahedron's
  record.body.nodes << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  record.body.triangles.resize(3, 2);
  record.body.triangles << 0, 0, 1, 2, 2, 3;
  record.views = {View(0), View(5)};
  return record;
}

// The contents of <script … id="ID">.
nlohmann::json Data(const std::string& page, const std::string& id) {
  const size_t begin = page.find('>', page.find("id=\"" + id + "\"")) + 1;
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

// The page without the scripts, which are not of the record.
std::string WithoutScripts(const std::string& page) { return page.substr(0, page.find("<script")); }

TEST(RunPage, NeedsNothingFromOutside) {
  const std::string page = WithoutScripts(RunPage(MakeRecord(30)));
  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  for (const char* const outside : {"http:", "https:", "src=\"/", "href=", "url(", "@import"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
}

TEST(RunPage, EscapesNamesEverywhere) {
  const std::string page = RunPage(MakeRecord(30));
  const std::string ours = page.substr(0, page.find("<script>"));  // markup and data, no program
  EXPECT_THAT(ours, HasSubstr("sheet &lt;i&gt;&amp;&quot;x&quot;&lt;/script&gt;"));
  for (const char* const raw : {"<i>", "F<1>", "<left>", "a<b", "<scene>", "<frame>"}) {
    EXPECT_EQ(ours.find(raw), std::string::npos) << raw;
  }
  EXPECT_EQ(Data(page, "chart-data")["charts"]["norm"][1]["name"], "F<1>");
}

TEST(RunPage, HasNoNumberThatIsNone) {
  for (const int frames : {1, 2, 30}) {
    const std::string page = WithoutScripts(RunPage(MakeRecord(frames)));
    EXPECT_FALSE(std::regex_search(page, std::regex("[\" (:MLHV,](-?nan|-?inf)[\" ,)<]")));
  }
}

TEST(RunPage, GivesThePointerTheValuesOfEveryFrame) {
  const nlohmann::json data = Data(RunPage(MakeRecord(30)), "chart-data");
  ASSERT_EQ(data["first"].size(), 30u);
  EXPECT_EQ(data["first"][11], 11);
  const auto& norm = data["charts"]["norm"][0];
  EXPECT_NEAR(norm["low"][11], 0.123456 * ((11 * 37 + 3) % 101), 1e-3);  // N; five digits
  EXPECT_NEAR(norm["bandHigh"][11], 0.123456 * ((11 * 37 + 3) % 101) + 0.04, 1e-3);
  EXPECT_TRUE(norm["low"][3].is_null()) << "a frame without forces";
  EXPECT_EQ(data["rows"][5].get<std::string>()[11], '0' + (11 * 31 + 5 * 17) % 4);
}

TEST(RunPage, BreaksLinesWhereThereAreNoForces) {
  const std::string page = RunPage(MakeRecord(30));
  const size_t line = page.find("class=\"line c0\"");
  const std::string path = page.substr(line, page.find("/>", line) - line);
  // Frames 3, 10, 17 and 24 part the line in five.
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 5);
}

TEST(RunPage, IsOfBoundedSizeHoweverLongTheRun) {
  const size_t thousand = RunPage(MakeRecord(RunColumns::kMaxColumns)).size();
  const size_t hundred_thousand = RunPage(MakeRecord(100000)).size();
  // Joined columns have two ends where single frames have one value, and larger numbers.
  EXPECT_LT(hundred_thousand, 2 * thousand);
  EXPECT_LT(hundred_thousand, 5000000u);  // bytes
}

TEST(RunPage, HoldsTheBodyToAThirtyThousandthOfItsMotion) {
  if (BodyViewScript().empty()) GTEST_SKIP() << "built without the 3-D view";
  const nlohmann::json data = Data(RunPage(MakeRecord(30)), "body-data");
  EXPECT_EQ(data["views"].size(), 2u);
  EXPECT_EQ(data["views"][1]["frame"], 5);
  EXPECT_NEAR(data["step"].get<double>() * 32767, 0.005, 1e-6);  // m; five digits
  EXPECT_EQ(data["views"][1]["markers"][0][1], 2);
}

TEST(RunPage, SaysWhatRanEvenIfNoFrameDid) {
  RunRecord record = MakeRecord(0);
  record.usable = false;
  record.views.clear();
  const std::string page = RunPage(record);
  EXPECT_THAT(page, HasSubstr("not usable"));
  EXPECT_THAT(page, HasSubstr("a&lt;b.msh"));
}

TEST(RunPage, GivesTheSameBytesForTheSameRecord) {
  RunRecord record = MakeRecord(30);
  EXPECT_EQ(RunPage(record), RunPage(record));
}

TEST(Base64, FillsUpToFours) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64("\xff\xfe\xfd"), "//79");
}

TEST(JsonText, CannotEndAScript) {
  EXPECT_EQ(JsonText("</script>\n"), "\"\\u003c/script>\\n\"");
  EXPECT_EQ(JsonNumber(NAN), "null");
}

}  // namespace
}  // namespace softforce::report
