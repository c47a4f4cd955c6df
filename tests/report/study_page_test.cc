#include "softforce/report/study_page.h"

#include <gmock/gmock.h>

#include "softforce/report/identification_page.h"

namespace softforce::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(StudyPage, HasEachTableThatWasComputed) {
  validation::Study study;
  validation::InexactCase inexact;
  inexact.layout = validation::RobotLayouts()[1];
  inexact.alone = 0.0123;
  inexact.tension = {0.1, 0.2, 0.3};
  inexact.tension_remedied = {0.004, 0.002};
  study.inexact.push_back(inexact);

  const std::string page = StudyPage(study);

  EXPECT_THAT(page, HasSubstr("Table III, soft robot"));
  EXPECT_THAT(page, Not(HasSubstr("Table II,")));
  EXPECT_THAT(page, Not(HasSubstr("Table I,")));
  EXPECT_THAT(page, HasSubstr("<title>r2, least squares: 300</title>")) << "the largest error";
  EXPECT_THAT(page, HasSubstr("<title>r2, remedied, selected: 2.00</title>"));
  EXPECT_THAT(page, Not(HasSubstr("http://"))) << "it needs no network";
}

TEST(IdentificationPage, ShowsValuesStatesAndForces) {
  IdentificationRecord record;
  record.found.status = estimation::Identification::Status::kOk;
  record.found.values.push_back({"Young's modulus", "Pa", 290e3, 282e3, 1.2e3});
  estimation::StateFit state;
  state.name = "frames 20 to 29";
  state.displacement = 0.011;
  state.rms_offset = 5e-5;
  record.found.states.push_back(state);
  record.forces.push_back({"frames 20 to 29", 3, 0.559, 0.561});

  const std::string page = IdentificationPage(record);

  EXPECT_THAT(page, HasSubstr("282.0 ± 1.2 kPa"));
  EXPECT_THAT(page, HasSubstr("in the scene: 290 kPa"));
  EXPECT_THAT(page, HasSubstr("moved, the marker that moves most: 11.0</title>"));
  EXPECT_THAT(page, HasSubstr("left unexplained, root mean square: 0.0500</title>"));
  EXPECT_THAT(page, HasSubstr("frames 20 to 29 (3), known: 0.559</title>"));
}

}  // namespace
}  // namespace softforce::report
