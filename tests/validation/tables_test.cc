#include "softforce/validation/tables.h"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "softforce/base/input_error.h"

namespace softforce::validation {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

// A study of one layout of each body, with figures that are easy to find again.
Study SmallStudy() {
  Study study;
  ExactCase exact;
  exact.layout = SheetLayouts()[1];
  exact.I_w = 1500;
  exact.converged = 2e-9;
  exact.linear = 0.25e-3;
  study.exact.push_back(exact);
  InexactCase inexact;
  inexact.layout = RobotLayouts()[1];
  inexact.alone = 0.0123;
  inexact.markers = {0.1, 0.2, 0.3};
  study.inexact.push_back(inexact);
  return study;
}

TEST(TextTables, StandBesideThePaper) {
  const std::string text = TextTables(SmallStudy());
  EXPECT_THAT(text, HasSubstr("Table I, soft sheet                            s2\n"
                              "I_w, N/mm: paper                             1.40\n"
                              "           ours                              1.50\n"
                              "I_e, mN:   paper                             1.10\n"
                              "           ours, linear steps                0.25\n"));
  EXPECT_THAT(text, HasSubstr("B  markers 0.10 mm off along z\n"
                              "     paper                                   94.6\n"
                              "     ours, least squares                    200.0\n"));
  EXPECT_THAT(text, Not(HasSubstr("Table II,")));  // no sheet in it
}

TEST(TextTables, ShowADashWhereThereIsNoAnswer) {
  EXPECT_THAT(TextTables(SmallStudy()),
              HasSubstr("     ours, remedied                             -\n"));
}

TEST(WriteCsv, WritesALinePerFigure) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / "validation_csv";
  const std::filesystem::path file = WriteCsv(folder, SmallStudy());

  std::ostringstream content;
  content << std::ifstream(file).rdbuf();
  EXPECT_THAT(content.str(), HasSubstr("table,layout,error,size,quantity,how,value,paper\n"
                                       "I,s2,none,0,I_w,at rest,1.5,1.4\n"));
  EXPECT_THAT(content.str(), HasSubstr("\nIII,r2,markers,0.1,I_e,least squares,200,94.6\n"));
  EXPECT_THAT(content.str(), HasSubstr("\nIII,r2,none,0,I_e,remedied,,\n"));  // no answer
}

TEST(WriteCsv, RefusesAFolderThatIsAFile) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "taken";
  std::ofstream(file) << "x";
  EXPECT_THAT([&] { PrepareCsv(file); }, ThrowsMessage<base::InputError>(HasSubstr("--out")));
}

}  // namespace
}  // namespace softforce::validation
