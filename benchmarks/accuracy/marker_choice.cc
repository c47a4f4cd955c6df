// Forces from a few of many markers, chosen by expected information, by displacement, by nearness
// to the force, or at random. The truth is a sheet of another, irregular mesh. Prints a Markdown
// table; the exit code is 1 if another choice of as many markers is better than that by
// information.
//
//   build/release/benchmarks/marker_choice [LOADS] [FRAMES]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>

#include "softforce/mesh/read_mesh.h"
#include "softforce/pipeline/tracker.h"
#include "support/box_mesh.h"

namespace softforce {
namespace {

constexpr double kNoise = 0.1e-3;  // m, standard deviation of each coordinate
constexpr double kMillimetre = 1e-3;
constexpr int kGrid = 6;  // markers along each side

enum class Choice { kAll, kInformation, kDisplacement, kNearness, kRandom };

const char* Name(Choice choice) {
  switch (choice) {
    case Choice::kAll:
      return "all 36";
    case Choice::kInformation:
      return "information";
    case Choice::kDisplacement:
      return "largest displacement";
    case Choice::kNearness:
      return "nearest to a force";
    case Choice::kRandom:
      return "random";
  }
  return "";
}

// The sheet of meshes/ with 36 markers and 4 places of vertical forces, seen by motion capture.
scene::Scene SheetScene() {
  scene::Scene scene;
  scene.name = "sheet";
  scene.file = "marker_choice";
  scene.mesh.order = 2;
  fem::Material material;
  material.model = fem::MaterialModel::kNeoHookean;
  material.youngs_modulus = 290e3;
  material.poissons_ratio = 0.45;
  scene.materials[""] = material;
  for (const double x : {0.0, 0.19}) {
    for (const double y : {0.0, 0.19}) {
      scene::FixedRegion corner;
      corner.box_min = Eigen::Vector3d(x, y, 0);
      corner.box_max = Eigen::Vector3d(x + 0.01, y + 0.01, 0.01);
      scene.fixed.push_back(corner);
    }
  }
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jitter(-6 * kMillimetre, 6 * kMillimetre);
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const double step = 0.2 / kGrid;
    const Eigen::Vector3d p((i % kGrid + 0.5) * step + jitter(random),
                            (i / kGrid + 0.5) * step + jitter(random), 0.01);
    scene.markers.points.push_back({i, p, std::to_string(i)});
  }
  scene.forces.patch = 6 * kMillimetre;
  const Eigen::Vector3d places[] = {
      {0.065, 0.130, 0}, {0.140, 0.075, 0}, {0.155, 0.150, 0}, {0.060, 0.055, 0}};
  for (const Eigen::Vector3d& place : places) {
    const int id = static_cast<int>(scene.forces.candidates.size());
    scene.forces.candidates.push_back(
        {id, place, scene::ForceDirection::kFixed, -Eigen::Vector3d::UnitZ()});
  }
  scene.measured.emplace();
  return scene;
}

struct Truth {
  Eigen::VectorXd forces;               // N, downward
  std::vector<Eigen::Vector3d> places;  // m, of the markers
};

class Study {
 public:
  Study()
      : scene_(SheetScene()),
        world_(pipeline::BuildWorld(
            scene_, mesh::WithOrder(testing::MakeBox(20, 20, 2, {0.2, 0.2, 0.01}), 2))),
        truth_world_(pipeline::BuildWorld(
            scene_,
            mesh::WithOrder(mesh::ReadMesh(SOFTFORCE_SOURCE_DIR "/meshes/sheet.msh", kMillimetre),
                            2))) {}

  int num_nodes() const { return static_cast<int>(world_.mesh().nodes.cols()); }
  int num_true_nodes() const { return static_cast<int>(truth_world_.mesh().nodes.cols()); }

  // Two of the places are loaded.
  Truth Load(int number) {
    std::mt19937 random(100 + number);
    std::uniform_real_distribution<double> force(0.2, 0.6);
    Truth truth{Eigen::VectorXd::Zero(4), {}};
    const int first = number % 4, second = (first + 1 + number / 4 % 3) % 4;
    truth.forces(first) = force(random);
    truth.forces(second) = force(random);
    fem::Equilibrium state = truth_world_.solver->AtRest();
    fem::LoadCase load = state.load;
    for (int s = 0; s < 4; ++s) {
      const mesh::NodalWeights& at = truth_world_.sites[s].at;
      for (size_t i = 0; i < at.nodes.size(); ++i) {
        load.forces(2, at.nodes[i]) -= at.weights[i] * truth.forces(s);
      }
    }
    if (!truth_world_.solver->Solve(load, &state).ok()) std::abort();
    const Eigen::Matrix3Xd x = truth_world_.mesh().nodes + state.u;
    for (const pipeline::BodyPoint& marker : truth_world_.markers) {
      truth.places.push_back(marker.weights.Apply(x) + marker.offset);
    }
    return truth;
  }

  // N², sum over the forces of all frames; each frame has noise of its own.
  double SquaredErrors(const Truth& truth, Choice choice, int count, int frames, int* lost) const {
    pipeline::TrackerOptions options;
    if (choice == Choice::kInformation) options.max_markers = count;
    pipeline::Tracker tracker(scene_, world_, no_cameras_, Eigen::Isometry3d::Identity(),
                              geometry::Matrix6d::Zero(), options);
    double squares = 0;
    for (int frame = 0; frame < frames; ++frame) {
      std::mt19937 random(1000 + frame);  // the same noise for all choices
      std::normal_distribution<double> noise(0, kNoise);
      std::vector<scene::MeasuredPoint> points;
      for (size_t m = 0; m < truth.places.size(); ++m) {
        const Eigen::Vector3d error(noise(random), noise(random), noise(random));
        points.push_back({truth.places[m] + error, kNoise, static_cast<int>(m)});
      }
      std::vector<scene::MeasuredPoint> given;
      for (const int m : Given(truth, choice, count, frame)) given.push_back(points[m]);
      const pipeline::FrameResult result = tracker.Process(frame, frame, {{{}, {}, given}});
      if (result.forces.empty()) ++*lost;
      for (size_t s = 0; s < result.forces.size(); ++s) {
        squares += std::pow(-result.forces[s].force.z() - truth.forces(static_cast<int>(s)), 2);
      }
    }
    return squares;
  }

 private:
  // The markers that the tracker is given at all.
  std::vector<int> Given(const Truth& truth, Choice choice, int count, int frame) const {
    std::vector<int> markers(scene_.markers.points.size());
    std::iota(markers.begin(), markers.end(), 0);
    if (choice == Choice::kAll || choice == Choice::kInformation) return markers;
    std::mt19937 random(frame);
    std::shuffle(markers.begin(), markers.end(), random);
    if (choice != Choice::kRandom) {
      std::stable_sort(markers.begin(), markers.end(), [&](int a, int b) {
        return Merit(truth, choice, a) > Merit(truth, choice, b);
      });
    }
    markers.resize(count);
    return markers;
  }

  // m; the displacement, or less the distance from the nearest force.
  double Merit(const Truth& truth, Choice choice, int marker) const {
    const Eigen::Vector3d& rest = scene_.markers.points[marker].position;
    if (choice == Choice::kDisplacement) return (truth.places[marker] - rest).norm();
    double nearest = INFINITY;
    for (int s = 0; s < 4; ++s) {
      if (truth.forces(s) == 0) continue;
      nearest = std::min(nearest, (scene_.forces.candidates[s].position - rest).norm());
    }
    return -nearest;
  }

  const scene::Scene scene_;
  const camera::Rig no_cameras_;
  const pipeline::World world_;
  pipeline::World truth_world_;
};

}  // namespace
}  // namespace softforce

int main(int argc, char** argv) {
  using namespace softforce;
  const int loads = argc > 1 ? std::atoi(argv[1]) : 12;
  const int frames = argc > 2 ? std::atoi(argv[2]) : 10;
  if (loads < 1 || frames < 1) {
    fmt::print(stderr, "marker_choice: expected numbers of loads and frames, 1 or more\n");
    return 2;
  }
  Study study;
  std::vector<Truth> truths;
  for (int load = 0; load < loads; ++load) truths.push_back(study.Load(load));
  fmt::print("Nodes: {}, of the truth {}. {} loads, {} frames each.\n\n", study.num_nodes(),
             study.num_true_nodes(), loads, frames);
  fmt::print(
      "| markers | chosen by | force error, RMS, mN | frames without forces "
      "|\n|---|---|---|---|\n");
  bool best = true;
  for (const int count : {36, 4, 6, 9}) {
    double by_information = NAN;
    for (const Choice choice : {Choice::kAll, Choice::kInformation, Choice::kDisplacement,
                                Choice::kNearness, Choice::kRandom}) {
      if ((choice == Choice::kAll) != (count == 36)) continue;
      double squares = 0;
      int lost = 0;
      for (const Truth& truth : truths) {
        squares += study.SquaredErrors(truth, choice, count, frames, &lost);
      }
      const double rms = std::sqrt(squares / (4.0 * (loads * frames - lost)));
      if (choice == Choice::kInformation) by_information = rms;
      best = best && !(rms < by_information);
      fmt::print("| {} | {} | {:.1f} | {} |\n", count, Name(choice), 1e3 * rms, lost);
      std::fflush(stdout);
    }
  }
  return best ? 0 : 1;
}
