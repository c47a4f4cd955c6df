// How often markers are allocated rightly while a soft sheet moves fast, many of its identical dots
// are hidden and false ones appear; see tests/support/allocation_experiment.h for what is
// simulated. Prints a Markdown table.
//
//   build/release/benchmarks/allocation_study [FRAMES [ROW]]
//
// FRAMES (default 10,000) are divided by four for each row of the table without the paper's rule,
// and the rows with it take a tenth of that. With ROW (from 1 on) all go to that row.
#include <fmt/format.h>

#include <cstdlib>

#include "softforce/base/progress.h"
#include "support/allocation_experiment.h"

namespace {

using softforce::testing::AllocationTally;

struct Case {
  std::string name;
  softforce::testing::Disturbance disturbance;
};

std::vector<Case> Cases() {
  using softforce::testing::Hiding;
  return {{"all seen", {}},
          {"30 % hidden, 20 % clutter", {0.3, Hiding::kEachFrame, 0.2}},
          {"50 % hidden for 10 frames and more, 20 % clutter", {0.5, Hiding::kBursts, 0.2}},
          {"the same, all on one side", {0.5, Hiding::kSide, 0.2}},
          {"the same, clutter of 0.6 to 1.6 times a marker's size",
           {0.5, Hiding::kSide, 0.2, 0, 5, 1.6}},
          {"one side hidden, and blackouts of 5 frames", {0.5, Hiding::kSide, 0.2, 50, 5}},
          {"one side hidden, and blackouts of 20 frames", {0.5, Hiding::kSide, 0.2, 50, 20}}};
}

double Percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

void PrintRow(const std::string& name, const AllocationTally& t) {
  fmt::print(
      "| {} | {} | {} | {:.3f} | {} | {} ({:.1f}) | {} | {:.3f} | {:.2f} / {:.2f} | {:.1f} "
      "({:.3f} / {:.3f}) "
      "| {:.2f} ({:.2f}) | {:.2f} ({:.2f}) | {}/{} | {:.1f} |\n",
      name, t.frames, t.lost_frames, 100 * t.RightShare(), t.swapped, t.clutter_taken,
      t.clutter_taken > 0 ? std::sqrt(t.clutter_distance2 / t.clutter_taken) : 0, t.flagged_wrong,
      Percent(t.left_out, t.shown), Percent(t.returned_at_once, t.returns),
      Percent(t.returned_at_once + t.returned_next, t.returns), Percent(t.covered, t.regions),
      t.regions > 0 ? 1e3 * t.region_sd / t.regions : 0,
      t.regions > 0 ? 1e3 * std::sqrt(t.region_error2 / t.regions) : 0, 1e3 * t.ForceError(),
      1e3 * t.ReportedForceSd(), 1e3 * t.LeastForceSd(), 1e3 * t.LeastForceSdOfAll(), t.recovered,
      t.after_blackout, 1e3 * t.seconds / t.frames);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace softforce;
  const int frames = argc > 1 ? std::atoi(argv[1]) : 10000;
  if (frames < 100) {
    fmt::print(stderr, "allocation_study: got \"{}\", expected a number of frames from 100 on\n",
               argv[1]);
    return 2;
  }
  const int only = argc > 2 ? std::atoi(argv[2]) : 0;
  int row = 0;
  fmt::print(
      "| markers | frames | lost | right, % | swapped | clutter taken (px off) | wrong but flagged "
      "| left out, % | back at once / in the next frame, % | hidden ones in their 95 % region, % "
      "(sd / error, mm) | force error, mN (reported sd) | the least sd, mN (had all been seen) | "
      "back after blackouts | ms a frame |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto rule : {allocation::Rule::kOptimal, allocation::Rule::kNearest}) {
    for (const Case& c : Cases()) {
      const bool nearest = rule == allocation::Rule::kNearest;
      pipeline::TrackerOptions options;
      options.observe.allocation.rule = rule;
      if (++row != only && only > 0) continue;
      const int share = only > 0 ? frames : std::max(1, frames / (nearest ? 40 : 4));
      const std::string name = c.name + (nearest ? ", the paper's rule" : "");
      testing::AllocationExperiment experiment(c.disturbance, 7, options);
      base::Progress progress(name, share);
      for (int frame = 0; frame < share; ++frame) {
        experiment.Step();
        progress.Update(frame + 1);
      }
      progress.Finish();
      PrintRow(name, experiment.tally());
    }
  }
  return 0;
}
