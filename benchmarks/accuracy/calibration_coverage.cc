// How often the reported 95 % intervals of a calibration hold the truth, over seeded trials with
// noise as modelled; see tests/support/calibration_world.h for what is simulated. Prints a Markdown
// table; the exit code is 1 if any class of parameters is outside 90 to 99 %.
//
//   build/release/benchmarks/calibration_coverage [TRIALS]
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "support/calibration_world.h"

namespace {

using namespace softforce;
using Kind = calibration::CalibratedValue::Kind;

const std::map<Kind, const char*> kClasses = {{Kind::kIntrinsics, "fx, fy, cx, cy"},
                                              {Kind::kDistortion, "distortion"},
                                              {Kind::kRotation, "rotation"},
                                              {Kind::kTranslation, "translation"},
                                              {Kind::kWarp, "warp"}};

struct Tally {
  int intervals = 0, covered = 0;
  double squares = 0;
};

struct Case {
  const char* name;
  testing::CalibrationWorld world;
  double sigma;  // px, per axis
};

std::vector<Case> Cases() {
  Case stereo{"stereo, 5 parameters", testing::MakeStereoWorld(15), 0.1};
  stereo.world.warp = {0.0002, -0.0003};
  Case fisheye{"stereo, fisheye", testing::MakeStereoWorld(15), 0.1};
  fisheye.world.warp = {0.0002, -0.0003};
  for (camera::Camera& camera : fisheye.world.rig.cameras) {
    camera.lens.model = camera::LensModel::kKannalaBrandt;
    camera.lens.fx = camera.lens.fy = 900;
    camera.lens.distortion = {0.03, -0.01, 0.004, -0.001};
  }
  fisheye.world.lenses.assign(2, calibration::LensFit::kKannalaBrandt);
  Case single{"one camera, 4 parameters", testing::MakeStereoWorld(12), 0.1};
  single.world.rig.cameras.resize(1);
  single.world.rig.cameras[0].lens.distortion[4] = 0;
  single.world.lenses = {calibration::LensFit::kBrownConrady4};
  return {stereo, fisheye, single};
}

}  // namespace

int main(int argc, char** argv) {
  const int trials = argc > 1 ? std::atoi(argv[1]) : 300;
  if (trials < 1) {
    fmt::print(stderr, "calibration_coverage: got \"{}\", expected a number of trials\n", argv[1]);
    return 2;
  }
  fmt::print(
      "| case | parameters | trials | lost | covered, % | normalised error² |\n"
      "|---|---|---|---|---|---|\n");
  bool all_hold = true;
  for (const Case& c : Cases()) {
    std::map<Kind, Tally> tallies;
    int lost = 0;
    std::mt19937 random(20);
    calibration::CalibrationOptions options;
    options.max_folds = 0;
    options.uncertainty_columns = options.uncertainty_rows = 2;
    for (int trial = 0; trial < trials; ++trial) {
      const calibration::Calibration result =
          calibration::Calibrate(testing::See(c.world, c.sigma, &random), options);
      lost += result.ok() ? 0 : 1;
      if (!result.ok()) continue;
      const std::vector<double> errors = testing::NormalisedErrors(c.world, result);
      for (size_t i = 0; i < errors.size(); ++i) {
        Tally& tally = tallies[result.values[i].kind];
        ++tally.intervals;
        tally.covered += std::abs(errors[i]) < 1.96 ? 1 : 0;
        tally.squares += errors[i] * errors[i];
      }
    }
    for (const auto& [kind, tally] : tallies) {
      const double covered = 100.0 * tally.covered / tally.intervals;
      all_hold = all_hold && covered >= 90 && covered <= 99 && lost == 0;
      fmt::print("| {} | {} | {} | {} | {:.1f} | {:.3f} |\n", c.name, kClasses.at(kind), trials,
                 lost, covered, tally.squares / tally.intervals);
    }
    std::fflush(stdout);
  }
  return all_hold ? 0 : 1;
}
