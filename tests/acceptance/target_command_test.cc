#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acceptance/program.h"

namespace softforce::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(TargetCommand, WritesAPdfAndSaysHowToUseIt) {
  const auto file = FreshFolder("target") / "board.pdf";
  const ProgramResult result =
      RunProgram("target chessboard:9x6,square=25mm --paper A3 -o " + file.string());
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("297 x 420 mm"), HasSubstr("Print it at 100 %"),
                                   HasSubstr("--board chessboard:9x6,square=25mm")));
  EXPECT_THAT(ReadText(file), StartsWith("%PDF"));
}

TEST(TargetCommand, WritesAnSvg) {
  const auto file = FreshFolder("target_svg") / "tags.svg";
  const ProgramResult result = RunProgram(
      "target tags:family=tag25h9,size=40mm --orientation landscape -o " + file.string());
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("297 x 210 mm"));
  EXPECT_THAT(ReadText(file), HasSubstr("<svg"));
}

TEST(TargetCommand, RefusesBadInputWithTheFix) {
  const auto file = FreshFolder("target_refused") / "board.pdf";
  const auto refusal = [&](const std::string& arguments) {
    const ProgramResult result = RunProgram("target " + arguments + " -o " + file.string());
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_FALSE(std::filesystem::exists(file)) << arguments;
    return result.errors;
  };
  EXPECT_THAT(refusal("chessboard:9x6,square=50mm"),
              HasSubstr("that fits: chessboard:9x6,square="));
  EXPECT_THAT(refusal("checkerboard"), HasSubstr("\"checkerboard\""));
  EXPECT_THAT(refusal("charuco --paper B5"), HasSubstr("A4, A3 or Letter"));
  EXPECT_THAT(refusal("charuco --orientation upright"), HasSubstr("portrait or landscape"));
  EXPECT_THAT(refusal("charuco --margin 5"), HasSubstr("no unit"));
}

}  // namespace
}  // namespace softforce::testing
