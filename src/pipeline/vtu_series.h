#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::pipeline {

// vtu/frame_00000.vtu, … and results.pvd, which ParaView opens as an animation over time.
class VtuSeries {
 public:
  explicit VtuSeries(const std::filesystem::path& folder);

  void Add(int frame, double time_s, const mesh::TetMesh& mesh, const Eigen::Matrix3Xd& u);
  void Commit();

 private:
  std::filesystem::path folder_;
  std::vector<std::string> entries_;
};

}  // namespace softforce::pipeline
