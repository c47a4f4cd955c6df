// How often the reported 95 % intervals of forces hold the truth, over seeded trials with modelled
// noise; see tests/support/coverage_experiment.h for what is simulated. Prints a Markdown table;
// the exit code is 1 if any case is outside 93 to 97 %.
//
//   build/release/benchmarks/force_coverage [TRIALS]
#include <fmt/format.h>

#include <cstdlib>

#include "support/coverage_experiment.h"

int main(int argc, char** argv) {
  using namespace softforce::testing;
  const int trials = argc > 1 ? std::atoi(argv[1]) : 2000;
  if (trials < 1) {
    fmt::print(stderr, "force_coverage: got \"{}\", expected a number of trials\n", argv[1]);
    return 2;
  }
  fmt::print(
      "| uncertain and modelled | trials | lost | mean sd, mN | covered, % | "
      "normalised error² |\n|---|---|---|---|---|---|\n");
  bool all_hold = true;
  for (const CoverageCase& c : CoverageCases()) {
    std::mt19937 random(20);
    CoverageExperiment experiment(c.uncertain);
    const CoverageExperiment::Tally tally = experiment.Run(trials, 40, &random);
    const double covered = 100.0 * tally.covered / tally.intervals;
    all_hold = all_hold && covered >= 93 && covered <= 97;
    fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | {:.3f} |\n", c.name, trials, tally.lost,
               1e3 * tally.mean_sd, covered, tally.normalised);
    std::fflush(stdout);
  }
  return all_hold ? 0 : 1;
}
