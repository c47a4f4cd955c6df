#include "pipeline/frame_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

constexpr int kNodes = 5;

std::filesystem::path FileFor(const std::string& test) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / ("frame_file_" + test);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder / kFrameFile;
}

FrameInWork SomeFrame() {
  FrameInWork frame;
  frame.result.frame = 7;
  frame.result.time_s = 0.25;
  frame.result.status = estimation::ForceEstimate::Status::kOk;
  ForceResult force;
  force.identity = 3;
  force.candidate = 12;
  force.position = {0.01, 0.02, 0.03};
  force.rest = {0.011, 0.021, 0.031};
  force.force = {0.1, -0.2, 0.3};
  force.covariance = 0.01 * Eigen::Matrix3d::Identity();
  force.alternatives = {14, 9};
  frame.result.probability = 0.83;
  frame.result.forces.push_back(force);
  MarkerResult marker;
  marker.id = 4;
  marker.status = MarkerStatus::kRejected;
  marker.model = {0.1, 0.2, 0.3};
  marker.expected_absent = true;
  frame.result.markers.push_back(marker);
  frame.T_rig_robot = Eigen::Translation3d(1, 2, 3);
  frame.largest_displacement = 0.04;
  frame.u.resize(3, kNodes);
  for (int i = 0; i < kNodes; ++i) frame.u.col(i) << 1e-3 * i, -2e-3 * i, 3.3e-5 * i;
  frame.u(1, 2) = 0.03;
  return frame;
}

std::filesystem::path WriteFrames(const std::string& test, int count) {
  const std::filesystem::path file = FileFor(test);
  FrameFileWriter writer(file, kNodes);
  for (int i = 0; i < count; ++i) writer.Add(SomeFrame());
  writer.Commit();
  return file;
}

TEST(FrameFile, GivesBackWhatThePictureShows) {
  const FrameInWork frame = SomeFrame();
  const std::filesystem::path file = FileFor("gives_back");
  FrameFileWriter writer(file, kNodes);
  writer.Add(frame);
  writer.Commit();

  FrameFileReader reader(file, kNodes);
  const std::optional<FrameInWork> read = reader.Next();

  ASSERT_TRUE(read);
  EXPECT_EQ(read->result.frame, 7);
  EXPECT_EQ(read->result.time_s, 0.25);
  EXPECT_TRUE(read->result.ok());
  ASSERT_EQ(read->result.forces.size(), 1u);
  EXPECT_EQ(read->result.forces[0].identity, 3);
  EXPECT_EQ(read->result.forces[0].position, frame.result.forces[0].position);
  EXPECT_EQ(read->result.forces[0].force, frame.result.forces[0].force);
  EXPECT_EQ(read->result.forces[0].covariance, frame.result.forces[0].covariance);
  EXPECT_EQ(read->result.forces[0].alternatives, (std::vector<int>{14, 9}));
  EXPECT_EQ(read->result.probability, 0.83);
  ASSERT_EQ(read->result.markers.size(), 1u);
  EXPECT_EQ(read->result.markers[0].status, MarkerStatus::kRejected);
  EXPECT_EQ(read->result.markers[0].model, frame.result.markers[0].model);
  EXPECT_TRUE(read->result.markers[0].expected_absent);
  EXPECT_TRUE(read->result.markers[0].measured.hasNaN());
  EXPECT_EQ(read->T_rig_robot.matrix(), frame.T_rig_robot.matrix());
  EXPECT_EQ(read->largest_displacement, 0.04);
  // m: half a step, which is less than twice the largest component by 32767.
  EXPECT_LE((read->u - frame.u).cwiseAbs().maxCoeff(), 0.03 / 32767);
  EXPECT_FALSE(reader.Next());
}

TEST(FrameFile, KeepsEveryBitOfAShapeThatItGaveBack) {
  const Eigen::Matrix3Xd u = SomeFrame().u;
  for (const double size : {1.0, 0.7, 1.0 / 3, 1e-9, 32767 / 0.03, 16383.5 / 0.03}) {
    const Eigen::Matrix3Xd kept = AsKept(size * u);
    EXPECT_EQ(AsKept(kept), kept) << size;
  }
  EXPECT_EQ(AsKept(Eigen::Matrix3Xd::Zero(3, 2)), Eigen::Matrix3Xd::Zero(3, 2));
}

TEST(FrameFile, OfAnotherBodyIsRefused) {
  const std::filesystem::path file = WriteFrames("other_body", 1);
  try {
    FrameFileReader reader(file, kNodes + 1);
    FAIL() << "not refused";
  } catch (const base::InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("of a body of 5 nodes"));
  }
}

TEST(FrameFile, ThatWasCutOffAnywhereIsRefused) {
  const std::filesystem::path file = WriteFrames("cut_off", 1);
  const auto size = std::filesystem::file_size(file);
  const auto head = size_t{19 + 4};  // title, nodes
  for (size_t length = head + 1; length < size; length += 7) {
    const std::filesystem::path part = FileFor("cut_off_part");
    std::filesystem::copy_file(file, part);
    std::filesystem::resize_file(part, length);
    FrameFileReader reader(part, kNodes);
    EXPECT_THROW(reader.Next(), base::InputError) << length << " of " << size << " bytes";
  }
}

TEST(FrameFile, ThatIsSomethingElseIsRefused) {
  const std::filesystem::path file = FileFor("else");
  std::ofstream(file) << "frame,time_s\n";
  EXPECT_THROW(FrameFileReader(file, kNodes), base::InputError);
}

}  // namespace
}  // namespace softforce::pipeline
