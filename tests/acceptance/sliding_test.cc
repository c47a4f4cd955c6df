// A push that slides over the underside of the shipped sheet, looked for by the whole program in
// labelled points of motion capture. The truth is made on a mesh of bricks that has nothing to do
// with the recording's own, on which it is estimated.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <random>
#include <set>

#include "acceptance/program.h"
#include "softforce/pipeline/world.h"
#include "softforce/scene/scene.h"
#include "support/box_mesh.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;

constexpr int kFrames = 29;
constexpr double kStep = 3e-3;    // m a frame: 84 mm in all
constexpr double kPush = 0.4;     // N, upwards
constexpr double kNoise = 5e-5;   // m, standard deviation of each coordinate
constexpr double kStart = 0.058;  // m, x of the first place

Eigen::Vector3d PlaceIn(int frame) { return {kStart + kStep * frame, 0.088, 0}; }

// Where the markers are in every frame, as a table of a system of motion capture.
std::string TrueMarkers(scene::Scene scene) {
  scene.forces.candidates.clear();
  for (int frame = 0; frame < kFrames; ++frame) {
    scene.forces.candidates.emplace_back();
    scene.forces.candidates.back().id = frame;
    scene.forces.candidates.back().position = PlaceIn(frame);
  }
  const pipeline::World truth =
      pipeline::BuildWorld(scene, mesh::RaiseOrder(testing::MakeBox(20, 20, 1, {0.2, 0.2, 0.01})));
  fem::Equilibrium state = truth.solver->AtRest();
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 1e3 * kNoise);
  std::string table = "time_s,marker,x_mm,y_mm,z_mm\n";
  for (int frame = 0; frame < kFrames; ++frame) {
    fem::LoadCase load = fem::OwnWeight(truth.solver->body());
    const mesh::NodalWeights& at = truth.sites[frame].at;
    for (size_t i = 0; i < at.nodes.size(); ++i) {
      load.forces(2, at.nodes[i]) += kPush * at.weights[i];
    }
    EXPECT_TRUE(truth.solver->Solve(load, &state).ok()) << frame;
    const Eigen::Matrix3Xd x = truth.mesh().nodes + state.u;
    for (size_t m = 0; m < truth.markers.size(); ++m) {
      const Eigen::Vector3d p = 1e3 * (truth.markers[m].weights.Apply(x) + truth.markers[m].offset);
      table +=
          fmt::format("{:.3f},{},{:.4f},{:.4f},{:.4f}\n", frame / 30.0, scene.markers.points[m].id,
                      p.x() + noise(random), p.y() + noise(random), p.z() + noise(random));
    }
  }
  return table;
}

// The shipped sheet with twelve candidates under it, none of them on the way of the force.
void WriteScene(const Folder& folder) {
  std::string candidates;
  int id = 0;
  for (const int y : {50, 100, 150}) {
    for (const int x : {40, 80, 120, 160}) {
      candidates +=
          fmt::format("    - {{id: {}, position: {} {} 0 mm, direction: free}}\n", id++, x, y);
    }
  }
  const std::string scene = testing::ReadText(folder / "scene.yaml");
  testing::WriteText(folder / "scene.yaml",
                     scene.substr(0, scene.find("forces:")) +
                         "forces:\n  known: false\n  patch: 6 mm\n  candidates:\n" + candidates +
                         "measured: {file: take.csv, noise: 0.05 mm}\n");
}

TEST(SlidingForce, IsOneForceAllTheWay) {
  const Folder folder = testing::CopyOfDemo("sliding_force");
  testing::WriteText(folder / "take.csv", TrueMarkers(scene::LoadScene(folder / "scene.yaml")));
  WriteScene(folder);

  const auto run = testing::RunProgram(fmt::format(
      "run '{0}/scene.yaml' --out '{0}/out' --no-overlay --no-report", folder.string()));

  ASSERT_EQ(run.exit_code, 0) << run.errors;
  std::set<std::string> identities;
  int frames = 0;
  double furthest = 0, worst = 0, sideways = 0;  // mm, N, standard deviations
  for (auto& row : testing::ReadTable(folder / "out/forces.csv")) {
    ASSERT_EQ(row["status"], "ok") << row["frame"];
    ++frames;
    identities.insert(row["force"]);
    const Eigen::Vector3d place(std::stod(row["rest_x_mm"]), std::stod(row["rest_y_mm"]),
                                std::stod(row["rest_z_mm"]));
    furthest = std::max(furthest, (place - 1e3 * PlaceIn(std::stoi(row["frame"]))).norm());
    worst = std::max(worst, std::abs(std::stod(row["fz_N"]) - kPush));
    for (const char axis : {'x', 'y'}) {
      const double force = std::stod(row[fmt::format("f{}_N", axis)]);
      const double sd = std::stod(row[fmt::format("sd_{}_N", axis)]);
      sideways = std::max(sideways, std::abs(force) / sd);
    }
  }
  std::cout << fmt::format(
      "{} frames, places within {:.2f} mm, upwards within {:.1f} %, sideways {:.1f} sd\n", frames,
      furthest, 100 * worst / kPush, sideways);
  EXPECT_EQ(frames, kFrames) << "one force in every frame";
  EXPECT_EQ(identities.size(), 1u);
  EXPECT_LE(furthest, 5.5) << "mm; three standard deviations of 1.8 mm";
  EXPECT_LE(worst, 0.05 * kPush) << "the recording's mesh is coarse: 3 % at these places";
  EXPECT_LE(sideways, 4) << "what the markers tell little of is as uncertain as it says";
}

}  // namespace
}  // namespace softforce
