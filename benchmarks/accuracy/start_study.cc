// How often dots without labels are told apart in the first frame, when the rig does not stand
// where its file says and the body may be loaded: what `softforce register --from markers` does.
// Prints a Markdown table.
//
//   build/release/benchmarks/start_study [TRIALS]
//
// TRIALS (default 400) are made for each row with strewn dots, a tenth of them with the lattice.
//
// The body is the sheet of tests/support/dotted_sheet.h, with its lattice of 40 dots or with 14
// dots strewn over it; the rig is up to 10 cm and 30° from its nominal place; loads are drawn from
// a share of the range of allocation_study. 0.05 px noise, a tenth of the dots hidden, 20 %
// clutter.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "softforce/calibration/match_markers.h"
#include "softforce/pipeline/world.h"
#include "support/dotted_sheet.h"

namespace {

using namespace softforce;

constexpr double kFarthest = 0.10;        // m
constexpr double kMostTurned = M_PI / 6;  // rad
constexpr double kNoise = 0.05;           // px
constexpr double kHidden = 0.1, kClutter = 0.2;

enum class Layout { kLattice, kStrewn };

// Dots at least 8 mm apart, the same in every run.
void Strew(scene::Scene* scene) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(0.03, 0.125), y(0.006, 0.074);
  scene->markers.points.clear();
  while (scene->markers.points.size() < 14) {
    const Eigen::Vector3d p(x(random), y(random), 0.015);
    const auto near = [&](const auto& other) { return (other.position - p).norm() < 8e-3; };
    const auto& points = scene->markers.points;
    if (std::any_of(points.begin(), points.end(), near)) continue;
    scene->markers.points.push_back({static_cast<int>(points.size()), p});
  }
}

scene::Scene SceneWith(Layout layout) {
  scene::Scene scene = testing::DottedSheetScene();
  if (layout == Layout::kStrewn) Strew(&scene);
  return scene;
}

class Study {
 public:
  explicit Study(Layout layout)
      : scene_(SceneWith(layout)),
        world_(pipeline::BuildWorld(scene_, testing::MakeDottedSheet({10, 5, 1}))),
        truth_(pipeline::BuildWorld(scene_, testing::MakeDottedSheet({13, 7, 1}))),
        rig_(testing::DottedSheetRig()) {
    known_ = DotsOf(world_, Eigen::Matrix3Xd::Zero(3, world_.mesh().num_nodes()));
  }

  struct Tally {
    int trials = 0, right = 0, wrong = 0, too_few = 0, no_match = 0, ambiguous = 0;
    double displacement = 0;  // m, largest of a dot by the loads
  };

  Tally Run(double load_share, int trials) {
    Tally tally;
    for (tally.trials = 0; tally.trials < trials; ++tally.trials) Try(load_share, &tally);
    return tally;
  }

 private:
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Eigen::Vector3d Direction() {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(random_), normal(random_), normal(random_)).normalized();
  }

  std::vector<calibration::KnownDot> DotsOf(const pipeline::World& world,
                                            const Eigen::Matrix3Xd& u) const {
    const Eigen::Matrix3Xd x = world.mesh().nodes + u;
    std::vector<calibration::KnownDot> dots;
    for (const pipeline::BodyPoint& marker : world.markers) {
      dots.push_back({marker.weights.Apply(x) + marker.offset,
                      mesh::Normal(world.surface, x, marker.at), scene_.markers.size});
    }
    return dots;
  }

  std::vector<calibration::KnownDot> Loaded(double share) {
    const Eigen::Vector4d range(0.04, 0.06, 0.1, 0.2);  // N
    Eigen::Vector4d force;
    for (int i = 0; i < 4; ++i) force(i) = share * range(i) * Uniform(-1, 1);
    fem::LoadCase load = fem::OwnWeight(truth_.solver->body());
    const Eigen::Vector3d forces[2] = {force.head<3>(), force(3) * Eigen::Vector3d::UnitZ()};
    for (int s = 0; s < 2; ++s) {
      const mesh::NodalWeights& at = truth_.sites[s].at;
      for (size_t i = 0; i < at.nodes.size(); ++i) {
        load.forces.col(at.nodes[i]) += at.weights[i] * forces[s];
      }
    }
    fem::Equilibrium state = truth_.solver->AtRest();
    truth_.solver->Solve(load, &state);
    return DotsOf(truth_, state.u);
  }

  // The rig turned about the dots and shifted.
  Eigen::Isometry3d Displaced() {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const auto& dot : known_) centre += dot.p_robot / static_cast<double>(known_.size());
    const Eigen::AngleAxisd turn(Uniform(0, kMostTurned), Direction());
    const Eigen::Vector3d shift = Uniform(0, kFarthest) * Direction();
    return Eigen::Translation3d(centre + shift) * turn * Eigen::Translation3d(-centre);
  }

  void Try(double load_share, Tally* tally) {
    const std::vector<calibration::KnownDot> dots = Loaded(load_share);
    for (size_t d = 0; d < dots.size(); ++d) {
      tally->displacement =
          std::max(tally->displacement, (dots[d].p_robot - known_[d].p_robot).norm());
    }
    const Eigen::Isometry3d T_rig_robot = Displaced();
    std::vector<char> hidden(dots.size());
    for (char& h : hidden) h = Uniform(0, 1) < kHidden;
    std::normal_distribution<double> noise(0, kNoise);
    std::vector<std::vector<calibration::DetectedSpot>> spots(rig_.cameras.size());
    std::vector<std::vector<int>> sources(rig_.cameras.size());
    for (size_t c = 0; c < rig_.cameras.size(); ++c) {
      const camera::Camera& camera = rig_.cameras[c];
      const Eigen::Isometry3d T = camera.T_camera_rig * T_rig_robot;
      const auto add = [&](const Eigen::Vector2d& pixel, double size, int source) {
        if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > camera.width - 1 ||
            pixel.y() > camera.height - 1) {
          return;
        }
        spots[c].push_back({pixel, kNoise * kNoise * Eigen::Matrix2d::Identity(), size});
        sources[c].push_back(source);
      };
      for (size_t d = 0; d < dots.size(); ++d) {
        const Eigen::Vector3d p = T * dots[d].p_robot, n = T.linear() * dots[d].normal;
        if (hidden[d] || -n.dot(p.normalized()) < 0.2) continue;
        const auto centroid = camera::ProjectDiscCentroid(camera.lens, p, n, dots[d].diameter);
        if (!centroid) continue;
        add(*centroid + Eigen::Vector2d(noise(random_), noise(random_)),
            dots[d].diameter * camera.lens.fx / p.z(), static_cast<int>(d));
      }
      const auto clutter = std::lround(kClutter * static_cast<double>(spots[c].size()));
      for (long i = 0; i < clutter; ++i) {
        add({Uniform(0, camera.width), Uniform(0, camera.height)}, 9, -1);
      }
    }
    Judge(calibration::MatchMarkers(rig_, known_, spots, Eigen::Isometry3d::Identity()), sources,
          tally);
  }

  void Judge(const calibration::MarkerMatch& match, const std::vector<std::vector<int>>& sources,
             Tally* tally) const {
    using Status = calibration::MarkerMatch::Status;
    if (match.status == Status::kTooFewSeen) ++tally->too_few;
    if (match.status == Status::kNoMatch) ++tally->no_match;
    if (match.status == Status::kAmbiguous) ++tally->ambiguous;
    if (!match.ok()) return;
    bool right = true;
    for (size_t c = 0; c < match.spots.size(); ++c) {
      for (size_t d = 0; d < match.spots[c].size(); ++d) {
        const int spot = match.spots[c][d];
        if (spot >= 0 && sources[c][spot] >= 0) right = right && sources[c][spot] == int(d);
      }
    }
    ++(right ? tally->right : tally->wrong);
  }

  scene::Scene scene_;
  pipeline::World world_, truth_;
  camera::Rig rig_;
  std::vector<calibration::KnownDot> known_;  // on the body without loads
  std::mt19937 random_{17};
};

}  // namespace

int main(int argc, char** argv) {
  const int trials = argc > 1 ? std::atoi(argv[1]) : 400;
  if (trials < 1) {
    fmt::print(stderr, "start_study: got \"{}\", expected a number of trials from 1 on\n", argv[1]);
    return 2;
  }
  fmt::print(
      "| dots | loads up to, % of the range | a dot moved by up to, mm | trials | right, % | wrong "
      "| "
      "refused: too few seen | no match | ambiguous |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Layout layout : {Layout::kStrewn, Layout::kLattice}) {
    Study study(layout);
    for (const double share : {0.0, 0.1, 0.3}) {
      const Study::Tally t =
          study.Run(share, layout == Layout::kLattice ? std::max(1, trials / 10) : trials);
      fmt::print("| {} | {:.0f} | {:.1f} | {} | {:.2f} | {} | {} | {} | {} |\n",
                 layout == Layout::kLattice ? "lattice of 40" : "14, strewn", 100 * share,
                 1e3 * t.displacement, t.trials, 100.0 * t.right / t.trials, t.wrong, t.too_few,
                 t.no_match, t.ambiguous);
      std::fflush(stdout);
    }
  }
  return 0;
}
