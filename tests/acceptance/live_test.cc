#include <fmt/format.h>
#include <gtest/gtest.h>

#include <iostream>

#include "acceptance/program.h"

namespace softforce {
namespace {

const std::string kScene =
    std::string(SOFTFORCE_SOURCE_DIR) + "/datasets/sheet_two_weights/scene.yaml";

// Two cameras over loopback, one of which is killed and started again; ended with Ctrl-C, and run
// again from what it recorded. The script tells what it holds against the truth.
TEST(Live, FindsForcesBeforeAndAfterACameraWasAway) {
  const std::filesystem::path folder = testing::FreshFolder("live");
  const testing::ProgramResult run = testing::RunCommand(
      fmt::format("'{}/benchmarks/live/run_live' --program '{}' --seconds 5 --work '{}'",
                  SOFTFORCE_SOURCE_DIR, SOFTFORCE_PROGRAM, folder.string()));

  std::cout << run.output;
  EXPECT_EQ(run.exit_code, 0) << run.output << run.errors;
  EXPECT_EQ(run.output.find("FAIL"), std::string::npos);
}

TEST(Record, KeepsWhatGivesTheSameBytesAgain) {
  const std::filesystem::path folder = testing::FreshFolder("record");
  const std::string recording = (folder / "recording").string();
  const testing::ProgramResult recorded = testing::RunProgram(
      fmt::format("run '{}' --out '{}/first' --no-overlay --frames :12 --record '{}'", kScene,
                  folder.string(), recording));
  ASSERT_EQ(recorded.exit_code, 0) << recorded.errors;

  const testing::ProgramResult again = testing::RunProgram(
      fmt::format("run '{0}' --out '{1}/again' --no-overlay --camera 'left={2}/left' "
                  "--camera 'right={2}/right'",
                  kScene, folder.string(), recording));

  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(testing::ReadTable(folder / "again/forces.csv").size(), 2u * 12);
  for (const char* table : {"forces.csv", "markers.csv"}) {
    EXPECT_EQ(testing::ReadText(folder / "first" / table),
              testing::ReadText(folder / "again" / table))
        << table;
  }
  const std::string summary = testing::ReadText(folder / "first/summary.json");
  EXPECT_NE(summary.find("\"sets\": 12"), std::string::npos) << summary;
}

// What is refused, and what the message names.
struct Refused {
  const char* name;
  const char* arguments;
  std::vector<const char*> named;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }

class RefusedLive : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedLive, InOneMessageThatLeavesNothing) {
  const std::filesystem::path folder =
      testing::FreshFolder(std::string("live_bad_") + GetParam().name);

  const testing::ProgramResult run =
      testing::RunCommand(fmt::format("cd '{}' && '{}' run '{}' --out out {}", folder.string(),
                                      SOFTFORCE_PROGRAM, kScene, GetParam().arguments));

  EXPECT_EQ(run.exit_code, 2) << run.output << run.errors;
  EXPECT_EQ(run.errors.rfind("softforce: ", 0), 0u) << run.errors;
  for (const char* word : GetParam().named) {
    EXPECT_NE(run.errors.find(word), std::string::npos)
        << '"' << word << "\" is not in: " << run.errors;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedLive,
    ::testing::Values(
        Refused{"OneLiveOneFile", "--camera left=tcp://127.0.0.1:9", {"left", "right", "live"}},
        Refused{"NobodyThere",
                "--camera left=tcp://127.0.0.1:9 --camera right=tcp://127.0.0.1:9",
                {"127.0.0.1:9"}},
        Refused{"NoSuchDevice",
                "--camera left=/dev/softforce0 --camera right=/dev/softforce1",
                {"/dev/softforce"}},
        Refused{"RecordOfAPart", "--record recording --frames 12:20", {"--record", "12:20"}},
        Refused{"RecordOfTooLittle", "--record recording --frames :4", {"--record", "first 10"}},
        Refused{"DurationWithoutUnit", "--duration 4", {"--duration", "unit"}},
        Refused{"NoDuration", "--duration '0 s'", {"--duration"}},
        Refused{"TooManyThreads", "--threads 1000", {"--threads", "256"}},
        Refused{"NegativeThreads", "--threads -1", {"--threads"}}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(Duration, EndsByTheTimesOfTheFrames) {
  const std::filesystem::path out = testing::FreshFolder("duration");
  const testing::ProgramResult run = testing::RunProgram(
      fmt::format("run '{}' --out '{}' --no-overlay --duration '0.1 s'", kScene, out.string()));

  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(testing::ReadTable(out / "forces.csv").size(), 2u * 3);  // at 0, 33 and 67 ms
}

}  // namespace
}  // namespace softforce
