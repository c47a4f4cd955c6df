#include "pipeline/result_tables.h"

#include <gtest/gtest.h>

#include <sstream>

namespace softforce::pipeline {
namespace {

std::filesystem::path FreshFolder(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

std::string ReadText(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

FrameResult GoodFrame() {
  FrameResult result;
  result.frame = 3;
  result.time_s = 0.1;
  result.status = estimation::ForceEstimate::Status::kOk;
  result.forces.push_back({0,
                           7,
                           {0.01, 0.02, 0.03},
                           {0.011, 0.02, 0.03},
                           {0, 0, -0.5},
                           Eigen::Vector3d(0.01, 0.02, 0.03).cwiseAbs2().asDiagonal()});
  MarkerResult hidden;
  hidden.id = 2;
  hidden.model = {0.001, 0.002, 0.003};
  result.markers.push_back(hidden);
  result.cables.push_back({"left", 0.9, 0.008});
  return result;
}

TEST(ResultTables, WriteTheColumnsThatScriptsRead) {
  const std::filesystem::path folder = FreshFolder("result_tables_columns");
  ResultTables tables(folder, {true, false});
  tables.Add(GoodFrame());
  tables.Commit();

  EXPECT_EQ(ReadText(folder / "forces.csv"),
            "frame,time_s,force,candidate,status,x_mm,y_mm,z_mm,rest_x_mm,rest_y_mm,rest_z_mm,fx_N,"
            "fy_N,fz_N,"
            "norm_N,sd_x_N,sd_y_N,sd_z_N,sd_location_mm\n"
            "3,0.100000,0,7,ok,10.0000,20.0000,30.0000,11.0000,20.0000,30.0000,0.000000,0.000000,-"
            "0.500000,"
            "0.500000,0.010000,0.020000,0.030000,0.0000\n");
  EXPECT_EQ(ReadText(folder / "markers.csv"),
            "frame,time_s,marker,status,x_mm,y_mm,z_mm,sd_mm,model_x_mm,model_y_mm,model_z_mm,"
            "residual_mm\n"
            "3,0.100000,2,hidden,,,,,1.0000,2.0000,3.0000,\n");
  EXPECT_EQ(ReadText(folder / "information.csv"),
            "frame,time_s,marker,used,information_share\n3,0.100000,2,0,\n");
  EXPECT_EQ(ReadText(folder / "actuation.csv"),
            "frame,time_s,actuator,tension_N,displacement_mm\n3,0.100000,left,0.900000,8.00000\n");
}

TEST(ResultTables, GiveCablesAndChambersTheirOwnColumns) {
  const std::filesystem::path folder = FreshFolder("result_tables_chambers");
  FrameResult frame = GoodFrame();
  frame.chambers.push_back({"belly", 12.5e3});
  ResultTables tables(folder, {true, true});
  tables.Add(frame);
  tables.Commit();

  EXPECT_EQ(ReadText(folder / "actuation.csv"),
            "frame,time_s,actuator,tension_N,displacement_mm,pressure_kPa\n"
            "3,0.100000,left,0.900000,8.00000,\n3,0.100000,belly,,,12.50000\n");
}

TEST(ResultTables, GiveAForceItsIdentityAndHowSureItsPlaceIs) {
  const std::filesystem::path folder = FreshFolder("result_tables_place");
  FrameResult frame = GoodFrame();
  frame.forces[0].identity = 4;
  frame.forces[0].place_covariance = Eigen::Vector3d(1e-6, 4e-6, 0).asDiagonal();  // m²
  FrameResult none = GoodFrame();
  none.forces.clear();
  ResultTables tables(folder, {});
  tables.Add(frame);
  tables.Add(none);
  tables.Commit();

  const std::string text = ReadText(folder / "forces.csv");
  EXPECT_NE(text.find("\n3,0.100000,4,7,ok,"), std::string::npos) << text;
  EXPECT_NE(text.find(",0.030000,2.0000\n3,0.100000,,,none,,,,,,,,,,,,,,\n"), std::string::npos)
      << text;
}

TEST(ResultTables, SayWhereElseAForceMayAct) {
  const std::filesystem::path folder = FreshFolder("result_tables_locations");
  FrameResult frame = GoodFrame();
  frame.probability = 0.75;
  frame.forces[0].identity = 4;
  frame.forces[0].alternatives = {2, 9};
  frame.forces[0].place_covariance = Eigen::Vector3d(1e-6, 4e-6, 0).asDiagonal();  // m²
  FrameResult none = GoodFrame();
  none.forces.clear();
  none.probability = 1;
  ResultTables tables(folder, {false, false, true});
  tables.Add(frame);
  tables.Add(none);
  tables.Commit();

  // Half axes: 1 and 2 mm times the root of 5.9915, the 95 % quantile of chi squared with 2 degrees
  // of freedom.
  EXPECT_EQ(ReadText(folder / "locations.csv"),
            "frame,time_s,force,probability,alternatives,long_mm,short_mm,long_x,long_y,long_z\n"
            "3,0.100000,4,0.750000,2 9,4.8955,2.4477,0.00000,1.00000,0.00000\n"
            "3,0.100000,,1.000000,,,,,,\n");
}

TEST(ResultTables, SayWhyAFrameIsNotUsable) {
  const std::filesystem::path folder = FreshFolder("result_tables_lost");
  FrameResult lost = GoodFrame();
  lost.forces.clear();
  lost.status = estimation::ForceEstimate::Status::kTooFewObservations;
  ResultTables tables(folder, {});
  tables.Add(lost);
  tables.Commit();

  const std::string text = ReadText(folder / "forces.csv");
  EXPECT_NE(text.find("\n3,0.100000,,,too_few_markers,,,,,,,,,,,,,,\n"), std::string::npos) << text;
  EXPECT_FALSE(std::filesystem::exists(folder / "actuation.csv"));
}

// A program that is killed commits nothing, but what it had found must be on the disk.
TEST(ResultTables, HaveEveryRowInThePartialFilesAtOnce) {
  const std::filesystem::path folder = FreshFolder("result_tables_flushed");
  ResultTables tables(folder, {true, false});
  tables.Add(GoodFrame());

  for (const char* name : {"forces.partial.csv", "markers.partial.csv", "actuation.partial.csv"}) {
    const std::string text = ReadText(folder / name);
    EXPECT_NE(text.find("\n3,0.100000,"), std::string::npos) << name << ": " << text;
  }
}

TEST(ResultTables, LeaveNothingUnlessCommitted) {
  const std::filesystem::path folder = FreshFolder("result_tables_abandoned");
  {
    ResultTables tables(folder, {true, false});
    tables.Add(GoodFrame());
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

}  // namespace
}  // namespace softforce::pipeline
