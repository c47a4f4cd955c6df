#include "softforce/pipeline/simulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <sstream>
#include <thread>

#include "softforce/base/input_error.h"
#include "softforce/mesh/write_mesh.h"
#include "softforce/scene/rig_file.h"
#include "softforce/scene/scene.h"
#include "softforce/vision/dots.h"
#include "softforce/vision/recording.h"
#include "softforce/vision/tags.h"
#include "support/box_mesh.h"
#include "support/stereo_rig.h"

namespace softforce::pipeline {
namespace {

namespace fs = std::filesystem;

// A plate of 160 × 120 × 8 mm that is held along x = 0, pulled by a cable at its far end and by a
// weight, with six markers on its upper face, 0.45 m before a stereo rig.
constexpr char kScene[] = R"(softforce: 1
name: plate
body:
  mesh: {file: plate.msh, unit: mm, order: 2}
  material: {model: neo_hookean, youngs_modulus: 300 kPa, poissons_ratio: 0.45}
  fixed: [{box: {min: 0 0 0 mm, max: 0 120 8 mm}}]
actuators:
  - {name: pull, type: cable, points: [160 60 4 mm], guide: 0 60 60 mm, input: displacement, patch: 6 mm}
actuation: actuation.csv
markers:
  type: dot
  size: 6 mm
  points:
    - {id: 3, position: 40 30 8 mm}
    - {id: 4, position: 80 28 8 mm}
    - {id: 5, position: 120 31 8 mm}
    - {id: 6, position: 41 90 8 mm}
    - {id: 7, position: 80 91 8 mm}
    - {id: 8, position: 120 90 8 mm}
forces:
  known: true
  patch: 6 mm
  candidates: [{id: 2, position: 100 60 8 mm, direction: free}]
cameras:
  rig: rig.yaml
  sources: {left: left.mp4, right: right.mp4}
)";

std::string ReadText(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class Simulated : public ::testing::Test {
 protected:
  Simulated() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / "softforce_simulate" / test->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    mesh::WriteMesh(folder_ / "plate.msh", testing::MakeBox(8, 6, 1, {0.16, 0.12, 0.008}), 1e-3);
    std::ofstream(folder_ / "actuation.csv") << "time_s,pull_mm\n0,0\n1,5\n";
    camera::Rig rig = testing::MakeStereoRig();
    Eigen::Isometry3d T_camera_robot = Eigen::Isometry3d::Identity();  // the plate's z towards it
    T_camera_robot.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    T_camera_robot.translation() << -0.08, 0.06, 0.45;
    rig.T_rig_robot = T_camera_robot;
    scene::SaveRig(rig, folder_ / "rig.yaml");
  }

  // Simulates the scene with a section of these lines, and says where.
  fs::path Make(const std::string& section, const std::string& name = "out",
                const std::string& scene = kScene) {
    std::ofstream(folder_ / (name + ".yaml")) << scene << "simulation:\n" << section;
    SimulateOptions options;
    options.out = folder_ / name;
    options.show_progress = false;
    report_ = Simulate(folder_ / (name + ".yaml"), options);
    return options.out;
  }

  std::string Refusal(const std::string& section) {
    try {
      Make(section);
    } catch (const base::InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "it was accepted";
    return "";
  }

  static nlohmann::json Truth(const fs::path& out) {
    return nlohmann::json::parse(ReadText(out / "truth.json"));
  }
  static Eigen::Vector3d MarkerAt(const nlohmann::json& truth, int frame, int marker) {
    const auto p = truth["frames"][frame]["markers"]["pos"][marker].get<std::vector<double>>();
    return {p[0], p[1], p[2]};  // mm
  }
  static std::vector<vision::FrameSet> Frames(const fs::path& out) {
    const scene::Scene scene = scene::LoadScene(out / "scene.yaml");
    std::vector<vision::Recording::Source> sources;
    for (const auto& [camera, file] : scene.cameras.sources) sources.push_back({camera, file});
    vision::Recording recording(scene::LoadRig(scene.cameras.rig), sources);
    std::vector<vision::FrameSet> frames;
    while (auto frame = recording.Next()) frames.push_back(std::move(*frame));
    return frames;
  }

  fs::path folder_;
  SimulateReport report_;
};

const char* const kLoaded =
    "  frames: 2\n"
    "  rate: 2 Hz\n"
    "  mesh: {refine: 0}\n"
    "  forces: [{candidate: 2, history: [{time: 0 s, force: 0 0 0 N}, "
    "{time: 1 s, force: 0.02 0 -0.1 N}]}]\n";

TEST_F(Simulated, HasItsDotsWhereTheTruthSays) {
  const fs::path out = Make(kLoaded);
  const nlohmann::json truth = Truth(out);
  const std::vector<vision::FrameSet> frames = Frames(out);

  ASSERT_EQ(frames.size(), 2u);
  EXPECT_NEAR(frames[1].time_s, 0.5, 1e-6);
  EXPECT_GT((MarkerAt(truth, 1, 2) - MarkerAt(truth, 0, 2)).norm(), 1);  // mm; it has moved
  double squares = 0;
  int count = 0;
  for (const vision::FrameSet& frame : frames) {
    for (int c = 0; c < 2; ++c) {
      const std::vector<vision::Dot> dots = vision::DetectDots(frame.pictures[c]);
      const auto& entry = truth["frames"][frame.frame];
      for (const auto& pixel : entry["pixels"][c == 0 ? "left" : "right"]) {
        double nearest = 1e9;
        for (const vision::Dot& dot : dots) {
          nearest = std::min(nearest, (dot.centroid - Eigen::Vector2d(pixel[0].get<double>(),
                                                                      pixel[1].get<double>()))
                                          .squaredNorm());
        }
        squares += nearest;
        ++count;
      }
      for (const auto& visible : entry["visible"][c == 0 ? "left" : "right"]) EXPECT_TRUE(visible);
    }
  }
  ASSERT_EQ(count, 24);
  // px, of the 2-D distance to the projected centre, from which the centroid of the picture of a
  // disc differs by up to 0.03 px; the rest is noise and compression.
  EXPECT_LT(std::sqrt(squares / count), 0.05);
}

TEST_F(Simulated, TellsLoadsAndActuationInTheTruth) {
  const fs::path out = Make(std::string(kLoaded) +
                            "  pictures: false\n"
                            "  actuator_offsets: {pull: 0.5 mm}\n");
  const nlohmann::json truth = Truth(out);

  EXPECT_EQ(truth["frames"][1]["forces"][0]["name"], "F2");
  EXPECT_EQ(truth["frames"][1]["forces"][0]["F"], nlohmann::json({0.01, 0, -0.05}));
  // mm: shortened by 2.5 as told, and by 0.5 more.
  EXPECT_NEAR(truth["frames"][1]["cables"]["displacement"][0], 3, 1e-5);
  EXPECT_GT(truth["frames"][1]["cables"]["tension"][0], 0);
  EXPECT_EQ(ReadText(out / "actuation.csv"),
            "time_s,pull_mm\n0.000000,0.0000000\n0.500000,2.5000000\n");
}

TEST_F(Simulated, PullsByTheOffsetOfTheSceneUnlessItHasItsOwn) {
  std::string scene = kScene;
  scene.replace(scene.find("patch: 6 mm}"), 12, "patch: 6 mm, offset: 0.5 mm}");
  const std::string section = "  frames: 1\n  mesh: {refine: 0}\n  pictures: false\n";
  const nlohmann::json as_known = Truth(Make(section, "known", scene));
  const nlohmann::json other =
      Truth(Make(section + "  actuator_offsets: {pull: 0.2 mm}\n", "other", scene));

  // mm; nothing is told in frame 0.
  EXPECT_NEAR(as_known["frames"][0]["cables"]["displacement"][0], 0.5, 1e-5);
  EXPECT_NEAR(as_known["simulation"]["actuator_offsets"]["pull_mm"], 0.5, 1e-12);
  EXPECT_NEAR(other["frames"][0]["cables"]["displacement"][0], 0.2, 1e-5);
}

TEST_F(Simulated, GivesTheSameFilesForOneSeedAndOthersForAnother) {
  const std::string section = "  frames: 1\n  mesh: {refine: 0}\n";
  const fs::path first = Make(section, "first"), again = Make(section, "again");
  const fs::path other = Make(section + "  seed: 2\n", "other");

  for (const char* name : {"left.mp4", "right.mp4", "markers3d.csv", "truth.json", "scene.yaml",
                           "rig.yaml", "plate.msh", "actuation.csv"}) {
    EXPECT_EQ(ReadText(first / name), ReadText(again / name)) << name;
    EXPECT_FALSE(ReadText(first / name).empty()) << name;
  }
  EXPECT_NE(ReadText(first / "left.mp4"), ReadText(other / "left.mp4"));
  EXPECT_NE(ReadText(first / "markers3d.csv"), ReadText(other / "markers3d.csv"));
}

TEST_F(Simulated, HidesMarkersBehindAnOccluderAndShowsDecoys) {
  const fs::path out = Make(
      "  frames: 2\n"
      "  rate: 1 Hz\n"
      "  mesh: {refine: 0}\n"
      "  pictures:\n"
      "    decoys: [100 60 8 mm]\n"
      "    cable_diameter: 0 mm\n"
      "    occluders: [{position: 40 30 30 mm, diameter: 24 mm, from: 1 s}]\n");
  const nlohmann::json truth = Truth(out);
  const std::vector<vision::FrameSet> frames = Frames(out);

  EXPECT_EQ(vision::DetectDots(frames[0].pictures[0]).size(), 7u);  // six markers and the decoy
  EXPECT_TRUE(truth["frames"][0]["visible"]["left"][0]);
  EXPECT_FALSE(truth["frames"][1]["visible"]["left"][0]);
  EXPECT_EQ(truth["frames"][1]["visible_fraction"]["left"][0], 0);
  EXPECT_TRUE(truth["frames"][1]["visible"]["left"][5]);
}

TEST_F(Simulated, PaintsTagsThatTheDetectorReads) {
  std::string scene = kScene;
  scene.replace(scene.find("type: dot"), 9, "type: apriltag\n  family: tag36h11");
  scene.replace(scene.find("size: 6 mm"), 10, "size: 16 mm");
  const fs::path out =
      Make("  frames: 1\n  mesh: {refine: 0}\n  pictures: {tag_up: [1, 1, 0]}\n", "out", scene);
  const nlohmann::json truth = Truth(out);

  const auto tags = vision::TagDetector("tag36h11").Detect(Frames(out)[0].pictures[1]);

  ASSERT_EQ(tags.size(), 6u);
  for (size_t t = 0; t < tags.size(); ++t) {
    EXPECT_EQ(tags[t].id, static_cast<int>(t) + 3);
    const auto& c = tags[t].corners;
    // The lines between opposite corners cross in the middle, whatever the perspective.
    const Eigen::Vector3d middle = c[0].homogeneous()
                                       .cross(c[2].homogeneous())
                                       .cross(c[1].homogeneous().cross(c[3].homogeneous()));
    const auto& pixel = truth["frames"][0]["pixels"]["right"][t];
    const Eigen::Vector2d expected(pixel[0].get<double>(), pixel[1].get<double>());
    EXPECT_LT((middle.hnormalized() - expected).norm(), 0.1);            // px
    EXPECT_LT(std::abs((c[0] - c[2]).x()), 0.2 * (c[0] - c[2]).norm());  // stands on a corner
  }
}

TEST_F(Simulated, MovesTheWholeBodyByARegistrationOffset) {
  const std::string section = std::string(kLoaded) + "  pictures: false\n";
  const nlohmann::json straight = Truth(Make(section, "straight"));
  const nlohmann::json moved = Truth(
      Make(section + "  registration: {translation: 1 2 3 mm, rotation: 0 0 90 deg}\n", "moved"));

  // Nothing acts in frame 0.
  const Eigen::Vector3d at_rest = MarkerAt(straight, 0, 1);
  const Eigen::Vector3d expected(1 - at_rest.y(), 2 + at_rest.x(), 3 + at_rest.z());
  EXPECT_LT((MarkerAt(moved, 0, 1) - expected).norm(), 1e-5);  // mm
  EXPECT_EQ(moved["frames"][1]["forces"][0]["F"], straight["frames"][1]["forces"][0]["F"]);
  EXPECT_EQ(straight["cables"][0]["guide"], nlohmann::json({0, 60, 60}));
  EXPECT_EQ(moved["cables"][0]["guide"], nlohmann::json({-59, 2, 63}));  // turned, then shifted
  EXPECT_EQ(moved["markers"][1]["rest"], straight["markers"][1]["rest"]);
}

TEST_F(Simulated, TurnsTheForcesIntoTheFrameOfAMovedBody) {
  const auto section = [](const char* force, const char* more) {
    return std::string("  frames: 1\n  mesh: {refine: 0}\n  pictures: false\n") + more +
           "  forces: [{candidate: 2, history: [{time: 0 s, force: " + force + "}]}]\n";
  };
  const nlohmann::json straight = Truth(Make(section("0.03 0 -0.1 N", ""), "straight"));
  const nlohmann::json turned =
      Truth(Make(section("0 0.03 -0.1 N", "  registration: {rotation: 0 0 90 deg}\n"), "turned"));

  const Eigen::Vector3d p = MarkerAt(straight, 0, 2);
  EXPECT_LT((MarkerAt(turned, 0, 2) - Eigen::Vector3d(-p.y(), p.x(), p.z())).norm(), 1e-5);  // mm
}

TEST_F(Simulated, TakesAMaterialOfItsOwn) {
  const std::string section = std::string(kLoaded) + "  pictures: false\n";
  const nlohmann::json soft = Truth(Make(section, "soft"));
  const nlohmann::json stiff =
      Truth(Make(section + "  material: {model: corotational, youngs_modulus: 600 kPa, "
                           "poissons_ratio: 0.45}\n",
                 "stiff"));

  const auto sag = [](const nlohmann::json& truth) {
    return (MarkerAt(truth, 1, 2) - MarkerAt(truth, 0, 2)).z();
  };
  EXPECT_EQ(stiff["material"]["law"], "corotational");
  // The cable prescribes most of the motion: the weight alone is halved.
  EXPECT_GT(std::abs(sag(soft) - sag(stiff)), 0.1);  // mm
}

TEST_F(Simulated, NeedsNoCamerasForMeasuredMarkers) {
  const fs::path out = Make(
      "  frames: 3\n  rate: 10 Hz\n  mesh: {refine: 0}\n  pictures: false\n"
      "  markers: {noise: 0.2 mm, dropouts: [{ids: [4], until: 0.15 s}]}\n");

  std::istringstream rows(ReadText(out / "markers3d.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "frame,time_s,marker,x_mm,y_mm,z_mm,sd_mm");
  int count = 0, of_four = 0;
  while (std::getline(rows, row)) {
    ++count;
    of_four += row.find(",4,") != std::string::npos;
    EXPECT_EQ(row.substr(row.rfind(',') + 1), "0.20000");
  }
  EXPECT_EQ(count, 16);
  EXPECT_EQ(of_four, 1);
  EXPECT_FALSE(fs::exists(out / "left.mp4"));
  EXPECT_NE(ReadText(out / "scene.yaml").find("measured: markers3d.csv"), std::string::npos);
  EXPECT_EQ(report_.FullReport().find("Try: softforce run"), std::string::npos);
}

TEST_F(Simulated, TellsTheFrameWithoutEquilibriumAndLeavesNothing) {
  const std::string message = Refusal(
      "  frames: 3\n  rate: 1 Hz\n  mesh: {refine: 0}\n  pictures: false\n"
      "  material: {model: st_venant_kirchhoff, youngs_modulus: 300 kPa, poissons_ratio: 0.45}\n"
      "  forces: [{candidate: 2, history: [{time: 1 s, force: 0 0 0 N}, "
      "{time: 2 s, force: -500 0 -500 N}]}]\n");
  EXPECT_NE(message.find("frame 2"), std::string::npos) << message;
  EXPECT_TRUE(fs::is_empty(folder_ / "out"));
}

TEST_F(Simulated, RefusesWhatCannotBeSimulated) {
  EXPECT_NE(Refusal("  forces: [{position: 900 0 0 mm, history: [{time: 0 s, force: 0 0 1 N}]}]\n")
                .find("simulation: forces: P0: (900 0 0) mm lies 740 mm off the body"),
            std::string::npos);
  EXPECT_NE(Refusal("  mesh: {refine: 0}\n  pictures: {decoys: [500 0 0 mm]}\n").find("decoys"),
            std::string::npos);
  EXPECT_NE(Refusal("  forces: nowhere.csv\n").find("nowhere.csv"), std::string::npos);
  camera::Rig rig = testing::MakeStereoRig();
  scene::SaveRig(rig, folder_ / "rig.yaml");
  EXPECT_NE(Refusal("  mesh: {refine: 0}\n").find("where the cameras stand"), std::string::npos);
  rig.cameras[1].width = 1279;
  scene::SaveRig(rig, folder_ / "rig.yaml");
  EXPECT_NE(Refusal("  mesh: {refine: 0}\n"
                    "  rig: {position: 80 60 500 mm, looks_at: 80 60 0 mm}\n")
                .find("1279"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "out" / "scene.yaml"));
}

TEST_F(Simulated, DoesNotWriteOverItsInputs) {
  std::ofstream(folder_ / "scene.yaml") << kScene;
  SimulateOptions options;
  options.out = folder_;
  options.show_progress = false;
  EXPECT_THROW(Simulate(folder_ / "scene.yaml", options), base::InputError);
  EXPECT_EQ(ReadText(folder_ / "scene.yaml"), kScene);
}

TEST_F(Simulated, WritesIntoNoFolderThatHoldsAnyFileOfTheScene) {
  const std::vector<std::pair<std::string, std::string>> named{
      {"left.mp4", ""},
      {"markers3d.csv", "  forces: kept/markers3d.csv\n"},
      {"actuation.csv", "  actuation: kept/actuation.csv\n"},
      {"plate.msh", "  mesh: {file: kept/plate.msh, unit: mm}\n"}};
  fs::create_directories(folder_ / "kept");
  fs::copy(folder_ / "plate.msh", folder_ / "kept");
  fs::copy(folder_ / "actuation.csv", folder_ / "kept");
  std::ofstream(folder_ / "kept/markers3d.csv") << "time_s,2_z_N\n0,0\n1,-0.2\n";
  std::ofstream(folder_ / "kept/left.mp4") << "a video";
  for (const auto& [file, section] : named) {
    std::string scene = kScene;
    if (file == "left.mp4") scene.replace(scene.find("left: left"), 10, "left: kept/left");
    std::ofstream(folder_ / "scene.yaml")
        << scene << "simulation:\n  frames: 1\n  pictures: false\n"
        << section;
    SimulateOptions options;
    options.out = folder_ / "kept";
    options.show_progress = false;
    const std::string before = ReadText(folder_ / "kept" / file);

    try {
      Simulate(folder_ / "scene.yaml", options);
      ADD_FAILURE() << file << " was not noticed";
    } catch (const base::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    }
    EXPECT_EQ(ReadText(folder_ / "kept" / file), before);
  }
}

TEST_F(Simulated, LeavesNothingWhenItIsStopped) {
  std::ofstream(folder_ / "scene.yaml") << kScene << "simulation: {mesh: {refine: 0}}\n";
  const std::atomic<bool> stop{true};
  SimulateOptions options;
  options.out = folder_ / "out";
  options.show_progress = false;
  options.stop = &stop;

  EXPECT_TRUE(Simulate(folder_ / "scene.yaml", options).stopped);

  EXPECT_TRUE(fs::is_empty(options.out));
}

TEST_F(Simulated, LeavesNothingWhenItIsStoppedInItsLastFrame) {
  std::ofstream(folder_ / "scene.yaml")
      << kScene << "simulation: {frames: 1, pictures: false, actuator_offsets: {pull: 5 mm}}\n";
  std::atomic<bool> stop{false};
  SimulateOptions options;
  options.out = folder_ / "out";
  options.show_progress = false;
  options.stop = &stop;
  // The table is begun just before the first frame, which takes a second.
  std::thread stopper([&] {
    while (!fs::exists(options.out / "markers3d.partial.csv")) std::this_thread::yield();
    stop = true;
  });

  const SimulateReport report = Simulate(folder_ / "scene.yaml", options);
  stopper.join();

  EXPECT_TRUE(report.stopped);
  EXPECT_TRUE(fs::is_empty(options.out));
}

TEST_F(Simulated, TakesForcesFromATableAndPutsTheCameraWhereItIsTold) {
  std::ofstream(folder_ / "loads.csv") << "time_s,2_z_N\n0,0\n1,-0.2\n";
  const fs::path out = Make(
      "  frames: 2\n  rate: 2 Hz\n  mesh: {refine: 0}\n  forces: loads.csv\n"
      "  rig: {position: 80 -200 400 mm, looks_at: 80 60 0 mm}\n");
  const nlohmann::json truth = Truth(out);

  EXPECT_EQ(truth["frames"][1]["forces"][0]["F"], nlohmann::json({0, 0, -0.1}));
  Eigen::Matrix4d T;
  for (int i = 0; i < 16; ++i) {
    T(i / 4, i % 4) = truth["cameras"]["left"]["T_camera_robot"][i / 4][i % 4];
  }
  const Eigen::Vector4d looked_at = T * Eigen::Vector4d(80, 60, 0, 1);  // mm
  EXPECT_NEAR(looked_at.head<2>().norm(), 0, 1e-9);
  EXPECT_NEAR(looked_at.z(), std::hypot(260, 400), 1e-9);
  EXPECT_LT((T * Eigen::Vector4d(80, 60, 50, 1)).y(), 0);  // what is higher is higher up
}

}  // namespace
}  // namespace softforce::pipeline
