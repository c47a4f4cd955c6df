// Forces from points of motion capture: the true places of the shipped recording's markers, made by
// another solver, with noise, in the files that users have.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "acceptance/program.h"
#include "softforce/scene/place_rig.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;

constexpr double kNoise = 0.05;    // mm, standard deviation of each coordinate
constexpr double kWeight = 0.559;  // N, both, in frames 20 to 29

// What a system saw: per frame, per marker, mm in its own frame; a third of them hidden in frames 8
// to 15.
struct Take {
  std::vector<std::vector<std::optional<Eigen::Vector3d>>> frames;

  explicit Take(const Folder& folder, const Eigen::Isometry3d& T_rig_robot_mm) {
    const auto truth = nlohmann::json::parse(testing::ReadText(folder / "truth.json"));
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, kNoise);
    for (const auto& frame : truth["frames"]) {
      frames.emplace_back();
      for (const auto& place : frame["markers"]["pos"]) {
        const Eigen::Vector3d p(place[0].get<double>(), place[1].get<double>(),
                                place[2].get<double>());
        const Eigen::Vector3d seen =
            T_rig_robot_mm * p + Eigen::Vector3d(noise(random), noise(random), noise(random));
        const size_t f = frames.size() - 1, m = frames.back().size();
        const bool hidden = f >= 8 && f < 16 && (m + f) % 3 == 0;
        frames.back().push_back(hidden ? std::nullopt : std::optional(seen));
      }
    }
  }

  // Laid out as Motive does, in centimetres; points without labels with two of clutter besides, in
  // columns that have nothing to do with the markers.
  std::string ToMotive(bool labels) const {
    const size_t columns = frames.front().size() + (labels ? 0 : 2);
    std::string text =
        "Format Version,1.23,Take Name,pull,Capture Frame Rate,30.000000,Rotation "
        "Type,Quaternion,Length Units,Centimeters,Coordinate Space,Global\n\n,Type";
    for (size_t c = 0; c < columns; ++c) text += ",Marker,Marker,Marker";
    text += "\n,Name";
    for (size_t c = 0; c < columns; ++c) {
      const std::string name =
          labels ? fmt::format("Sheet:{}", c) : fmt::format("Unlabeled {}", 1000 + c);
      for (int i = 0; i < 3; ++i) text += "," + name;
    }
    text += "\n,ID";
    for (size_t c = 0; c < 3 * columns; ++c) text += fmt::format(",\"{:X}\"", 5000 + c / 3);
    text += "\n,";
    for (size_t c = 0; c < 3 * columns; ++c) text += ",Position";
    text += "\nFrame,Time (Seconds)";
    for (size_t c = 0; c < columns; ++c) text += ",X,Y,Z";
    text += "\n";
    std::mt19937 random(8);
    for (size_t f = 0; f < frames.size(); ++f) {
      auto points = frames[f];
      if (!labels) {
        for (size_t c = frames[f].size(); c < columns; ++c) {
          points.emplace_back(*points.front() +
                              Eigen::Vector3d(20.0 + 3.0 * static_cast<double>(c), 25, 4));
        }
        std::shuffle(points.begin(), points.end(), random);
      }
      text += fmt::format("{},{:.6f}", f, static_cast<double>(f) / 30);
      for (const auto& p : points) {
        text +=
            p ? fmt::format(",{:.6f},{:.6f},{:.6f}", p->x() / 10, p->y() / 10, p->z() / 10) : ",,,";
      }
      text += "\n";
    }
    return text;
  }
};

// A folder with the shipped body and markers, and this section instead of cameras.
Folder MeasuredScene(const std::string& name, const std::string& section) {
  const Folder folder = testing::CopyOfDemo(name);
  const std::string scene = testing::ReadText(folder / "scene.yaml");
  testing::WriteText(folder / "scene.yaml", scene.substr(0, scene.find("cameras:")) + section);
  return folder;
}

// Somewhere in the lab; mm.
Eigen::Isometry3d Lab() {
  Eigen::Isometry3d T(Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.3, 1, -0.2).normalized()));
  T.translation() = Eigen::Vector3d(820, 95, -410);
  return T;
}

testing::ProgramResult RunScene(const Folder& folder, const std::string& options = "") {
  return testing::RunProgram(
      fmt::format("run '{0}/scene.yaml' --out '{0}/out' {1}", folder.string(), options));
}

void ExpectTheWeights(const Folder& folder) {
  double mean[2] = {0, 0};  // N
  for (const auto& row : testing::ReadTable(folder / "out/forces.csv")) {
    ASSERT_EQ(row.at("status"), "ok") << row.at("frame");
    const int frame = std::stoi(row.at("frame"));
    const double weight = kWeight * std::min(1.0, frame / 19.0);
    const double force = std::stod(row.at("norm_N"));
    // N; one frame's noise (sd 0.012 N, and 0.02 N with a third of the markers hidden) three times,
    // and the mesh, which is 2.3 % too stiff.
    EXPECT_NEAR(force, weight, 0.045 + 0.03 * weight) << "frame " << frame;
    if (frame >= 20) mean[std::stoi(row.at("candidate"))] += force / 10;
  }
  // The mesh; the noise of ten frames is 0.7 %.
  for (const double force : mean) EXPECT_NEAR(force, kWeight, 0.045 * kWeight);
}

TEST(Measured, LabelledExportOfMotiveGivesTheForces) {
  const Folder folder = MeasuredScene(
      "measured_labelled", "measured: {file: take.csv, noise: 0.05 mm, rig: lab.yaml}\n");
  testing::WriteText(folder / "take.csv", Take(folder, Lab()).ToMotive(true));

  const auto registered =
      testing::RunProgram(fmt::format("register '{}/scene.yaml' --in-place", folder.string()));
  ASSERT_EQ(registered.exit_code, 0) << registered.errors;
  EXPECT_NE(registered.output.find("by 14 of 14 markers with labels"), std::string::npos)
      << registered.output;
  const testing::ProgramResult run = RunScene(folder);

  ASSERT_EQ(run.exit_code, 0) << run.errors << run.output;
  EXPECT_NE(run.output.find("no overlay.mp4"), std::string::npos) << run.output;
  EXPECT_FALSE(std::filesystem::exists(folder / "out/overlay.mp4"));
  ExpectTheWeights(folder);
  for (const auto& row : testing::ReadTable(folder / "out/markers.csv")) {
    const int frame = std::stoi(row.at("frame")), marker = std::stoi(row.at("marker"));
    const bool hidden = frame >= 8 && frame < 16 && (marker + frame) % 3 == 0;
    EXPECT_EQ(row.at("status"), hidden ? "hidden" : "seen") << frame << " " << marker;
  }
  const auto summary = nlohmann::json::parse(testing::ReadText(folder / "out/summary.json"));
  EXPECT_EQ(summary["registration"]["from"], "rig_file");
  EXPECT_EQ(summary["measured"]["file"], "take.csv");
}

TEST(Measured, PointsWithoutLabelsAreAllocatedAmongClutter) {
  const Folder folder =
      MeasuredScene("measured_unlabelled", "measured: {file: take.csv, noise: 0.05 mm}\n");
  const Take take(folder, Eigen::Isometry3d::Identity());
  testing::WriteText(folder / "take.csv", take.ToMotive(false));

  const testing::ProgramResult run = RunScene(folder);

  ASSERT_EQ(run.exit_code, 0) << run.errors << run.output;
  ExpectTheWeights(folder);
  for (const auto& row : testing::ReadTable(folder / "out/markers.csv")) {
    const auto& truth = take.frames[std::stoi(row.at("frame"))][std::stoi(row.at("marker"))];
    ASSERT_EQ(row.at("status"), truth ? "seen" : "hidden") << row.at("frame") << row.at("marker");
    if (!truth) continue;
    EXPECT_NEAR(std::stod(row.at("x_mm")), truth->x(), 1e-3);  // mm; digits of the table
    EXPECT_NEAR(std::stod(row.at("y_mm")), truth->y(), 1e-3);
  }
}

TEST(Measured, PointsWithoutLabelsAreAllocatedOverAJumpToTheFullLoad) {
  const Folder folder =
      MeasuredScene("measured_jump", "measured: {file: points.csv, noise: 0.05 mm}\n");
  const Take take(folder, Eigen::Isometry3d::Identity());
  std::string table = "frame,time_s,x_mm,y_mm,z_mm\n";
  for (const size_t f : {0, 29}) {
    for (const auto& p : take.frames[f]) {  // the centre moves by 10 mm
      table += fmt::format("{},{},{:.5f},{:.5f},{:.5f}\n", f, static_cast<double>(f) / 30, p->x(),
                           p->y(), p->z());
    }
  }
  testing::WriteText(folder / "points.csv", table);

  const testing::ProgramResult run = RunScene(folder);

  ASSERT_EQ(run.exit_code, 0) << run.errors << run.output;
  for (const auto& row : testing::ReadTable(folder / "out/markers.csv")) {
    EXPECT_EQ(row.at("status"), "seen") << row.at("frame") << " " << row.at("marker");
    const auto& p = take.frames[std::stoi(row.at("frame"))][std::stoi(row.at("marker"))];
    EXPECT_NEAR(std::stod(row.at("x_mm")), p->x(), 1e-3);  // mm; digits of the table
    EXPECT_NEAR(std::stod(row.at("y_mm")), p->y(), 1e-3);
  }
  for (const auto& row : testing::ReadTable(folder / "out/forces.csv")) {
    if (row.at("frame") != "29") continue;
    // N; as in ExpectTheWeights.
    EXPECT_NEAR(std::stod(row.at("norm_N")), kWeight, 0.045 + 0.03 * kWeight);
  }
}

// What a swap of labels in the motion-capture program does.
TEST(Measured, TwoLabelsThatWereSwappedAreRejected) {
  const Folder folder =
      MeasuredScene("measured_swap", "measured: {file: points.csv, noise: 0.05 mm}\n");
  const Take take(folder, Eigen::Isometry3d::Identity());
  std::string table = "time_s,marker,x_mm,y_mm,z_mm\n";
  for (size_t f = 18; f < 24; ++f) {
    for (size_t m = 0; m < take.frames[f].size(); ++m) {
      const size_t label = f < 21 ? m : m == 4 ? 5 : m == 5 ? 4 : m;
      const Eigen::Vector3d& p = *take.frames[f][m];
      table += fmt::format("{},{},{:.5f},{:.5f},{:.5f}\n", static_cast<double>(f) / 30, label,
                           p.x(), p.y(), p.z());
    }
  }
  testing::WriteText(folder / "points.csv", table);

  const testing::ProgramResult run = RunScene(folder);

  ASSERT_EQ(run.exit_code, 0) << run.errors << run.output;
  for (const auto& row : testing::ReadTable(folder / "out/markers.csv")) {
    const int marker = std::stoi(row.at("marker"));
    const bool swapped = std::stoi(row.at("frame")) >= 3 && (marker == 4 || marker == 5);
    EXPECT_EQ(row.at("status"), swapped ? "rejected" : "seen") << row.at("frame") << " " << marker;
  }
  for (const auto& row : testing::ReadTable(folder / "out/forces.csv")) {
    EXPECT_NEAR(std::stod(row.at("norm_N")), kWeight, 0.045 + 0.06 * kWeight) << row.at("frame");
  }
}

TEST(Measured, ForcesComeFromTheMostTellingMarkersIfAsked) {
  const Folder folder =
      MeasuredScene("measured_choice", "measured: {file: take.csv, noise: 0.05 mm}\n");
  testing::WriteText(folder / "take.csv",
                     Take(folder, Eigen::Isometry3d::Identity()).ToMotive(true));

  const testing::ProgramResult run = RunScene(folder, "--max-markers 6 --frames 20:23");

  ASSERT_EQ(run.exit_code, 0) << run.errors << run.output;
  std::map<std::string, int> used;
  std::map<std::string, double> shares;
  for (const auto& row : testing::ReadTable(folder / "out/information.csv")) {
    used[row.at("frame")] += std::stoi(row.at("used"));
    shares[row.at("frame")] += std::stod(row.at("information_share"));
  }
  ASSERT_EQ(used.size(), 3u);
  for (const auto& [frame, count] : used) {
    EXPECT_EQ(count, 6) << frame;
    EXPECT_NEAR(shares[frame], 1, 1e-3) << frame;  // digits of the table
  }
}

TEST(Measured, KnownWeightsGiveTheModulus) {
  const Folder folder =
      MeasuredScene("measured_identify", "measured: {file: take.csv, noise: 0.05 mm}\n");
  testing::WriteText(folder / "take.csv",
                     Take(folder, Eigen::Isometry3d::Identity()).ToMotive(true));

  const auto found = testing::RunProgram(
      fmt::format("identify '{0}/scene.yaml' --weights '20:30: 0 = 0.559 N, 1 = 0.559 N' -o "
                  "'{0}/found.yaml'",
                  folder.string()));

  ASSERT_EQ(found.exit_code, 0) << found.errors << found.output;
  const std::string scene = testing::ReadText(folder / "found.yaml");
  const size_t at = scene.find("youngs_modulus: ");
  ASSERT_NE(at, std::string::npos);
  // kPa; less than the truth's 290 by what the mesh is too stiff, 2.3 %, and noise of 0.7 %.
  EXPECT_NEAR(std::stod(scene.substr(at + 16)), 290 / 1.023, 6);
}

TEST(Measured, OptionsOfCamerasAreRefused) {
  const Folder folder = MeasuredScene("measured_options", "measured: take.csv\n");
  testing::WriteText(folder / "take.csv",
                     Take(folder, Eigen::Isometry3d::Identity()).ToMotive(true));

  for (const std::string option :
       {"--camera left=left.mp4", "--record raw", "--overlay-width 800", "--frames 30:40"}) {
    const testing::ProgramResult run = RunScene(folder, option);
    EXPECT_EQ(run.exit_code, 2) << option;
    EXPECT_NE(run.errors.find(option.substr(0, option.find(' '))), std::string::npos) << run.errors;
  }
}

TEST(Measured, AFrameWithoutLabelsDoesNotPlaceTheSystem) {
  const Folder folder = MeasuredScene("measured_register", "measured: take.csv\n");
  testing::WriteText(folder / "take.csv",
                     Take(folder, Eigen::Isometry3d::Identity()).ToMotive(false));

  const auto registered =
      testing::RunProgram(fmt::format("register '{}/scene.yaml'", folder.string()));

  EXPECT_EQ(registered.exit_code, 2);
  EXPECT_NE(registered.errors.find("frame 0 has 0 points with labels, expected 4 or more"),
            std::string::npos)
      << registered.errors;
}

TEST(Measured, SwappedLabelsDoNotPlaceTheSystemWrongly) {
  const Folder folder = MeasuredScene("measured_swapped_register", "measured: points.csv\n");
  const Take take(folder, Lab());
  std::string table = "time_s,marker,x_mm,y_mm,z_mm\n";
  for (size_t m = 0; m < take.frames[0].size(); ++m) {
    const Eigen::Vector3d& p = *take.frames[0][m];
    table += fmt::format("0,{},{:.5f},{:.5f},{:.5f}\n",
                         m == 4   ? 5
                         : m == 5 ? 4
                                  : m,
                         p.x(), p.y(), p.z());
  }
  testing::WriteText(folder / "points.csv", table);

  const auto registered = testing::RunProgram(
      fmt::format("register '{0}/scene.yaml' -o '{0}/place.yaml'", folder.string()));

  ASSERT_EQ(registered.exit_code, 0) << registered.errors;
  EXPECT_NE(registered.output.find("by 12 of 14 markers with labels"), std::string::npos)
      << registered.output;
  EXPECT_NE(registered.output.find("marker 4 is "), std::string::npos) << registered.output;
  EXPECT_NE(registered.output.find("marker 5 is "), std::string::npos) << registered.output;
  // m; 0.05 mm of noise over twelve markers 0.9 m away, whose turn is known to 0.3 mrad; fourfold.
  const scene::RigPlace place = scene::LoadPlace(folder / "place.yaml");
  EXPECT_LT((place.T_rig_robot.translation() - 1e-3 * Lab().translation()).norm(), 1.2e-3);
  EXPECT_LT(Eigen::AngleAxisd(place.T_rig_robot.linear() * Lab().linear().transpose()).angle(),
            1.2e-3);  // rad
}

TEST(Measured, WhatSimulateWritesWithoutPicturesIsRun) {
  const Folder folder = testing::CopyOfDemo("measured_simulated");
  testing::WriteText(
      folder / "scene.yaml",
      testing::ReadText(folder / "scene.yaml") +
          "simulation:\n"
          "  frames: 3\n"
          "  pictures: false\n"
          "  mesh: {refine: 0}\n"
          "  forces:\n"
          "    - {candidate: 0, history: [{time: 0 s, force: 0 0 0 N}, {time: 0.05 s, force: 0 0 "
          "-0.5 N}]}\n");
  const auto simulated = testing::RunProgram(
      fmt::format("simulate '{0}/scene.yaml' --out '{0}/recording'", folder.string()));
  ASSERT_EQ(simulated.exit_code, 0) << simulated.errors;

  const auto run = testing::RunProgram(
      fmt::format("run '{0}/recording/scene.yaml' --out '{0}/out'", folder.string()));

  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const auto& row : testing::ReadTable(folder / "out/forces.csv")) {
    const double truth = row.at("candidate") == "1" ? 0 : 0.25 * std::stoi(row.at("frame"));
    // N; the same mesh and no noise, but the written places are rounded to 10 nm, and both the
    // simulation and the estimate stop short of exact equilibrium.
    if (std::stoi(row.at("frame")) < 2) continue;
    EXPECT_NEAR(std::stod(row.at("norm_N")), std::min(truth, 0.5), 2e-3) << row.at("frame");
  }
}

}  // namespace
}  // namespace softforce
