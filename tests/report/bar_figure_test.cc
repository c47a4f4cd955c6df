#include "report/bar_figure.h"

#include <gmock/gmock.h>

#include <cmath>
#include <regex>

namespace softforce::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

BarFigure TwoGroups(bool logarithmic) {
  BarFigure figure;
  figure.title = "two groups";
  figure.y_label = "mN";
  figure.logarithmic = logarithmic;
  figure.groups = {"s1", "s2"};
  figure.series = {{"ours", {1, 100}}, {"theirs", {10, NAN}, true}};
  return figure;
}

// px, of the bars in the order in which they stand in the drawing.
std::vector<double> BarHeights(const std::string& html) {
  static const std::regex kBar("<rect class=\"bar[^>]* height=\"([0-9.]+)\"");
  std::vector<double> heights;
  for (std::sregex_iterator it(html.begin(), html.end(), kBar), end; it != end; ++it) {
    heights.push_back(std::stod((*it)[1]));
  }
  return heights;
}

TEST(DrawBars, OfAHundredfoldValueIsAHundredTimesAsHighOnALinearAxis) {
  const std::vector<double> heights = BarHeights(DrawBars(TwoGroups(false)));
  ASSERT_EQ(heights.size(), 2u);
  EXPECT_NEAR(heights[1] / heights[0], 100, 3);  // coordinates have one decimal
}

TEST(DrawBars, StandsDecadesApartOnALogarithmicAxis) {
  BarFigure figure = TwoGroups(true);
  figure.series[0].values = {1, 10};
  figure.series.push_back({"third", {100, NAN}});
  const std::vector<double> heights = BarHeights(DrawBars(figure));
  ASSERT_EQ(heights.size(), 3u);  // s1: ours, third; s2: ours
  EXPECT_NEAR(heights[1] - heights[2], heights[2] - heights[0], 0.21);
}

TEST(DrawBars, LeavesOutWhatIsNotKnownOrHasNoLogarithm) {
  BarFigure figure = TwoGroups(true);
  figure.series[0].values = {0, NAN};
  const std::string html = DrawBars(figure);
  EXPECT_TRUE(BarHeights(html).empty());
  EXPECT_THAT(html, HasSubstr("<circle"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  EXPECT_THAT(html, Not(HasSubstr("inf")));
}

TEST(DrawBars, SaysEveryValueAndWhatTheColoursMean) {
  const std::string html = DrawBars(TwoGroups(true));
  EXPECT_THAT(html, HasSubstr("<title>s2, ours: 100</title>"));
  EXPECT_THAT(html, HasSubstr("<title>s1, theirs: 10.0</title>"));
  EXPECT_THAT(html, HasSubstr("theirs (spots)"));
}

TEST(DrawBars, OfNothingIsAnEmptyFrame) {
  EXPECT_THAT(DrawBars({"nothing", "N", false, {}, {}, ""}), HasSubstr("<svg"));
}

}  // namespace
}  // namespace softforce::report
