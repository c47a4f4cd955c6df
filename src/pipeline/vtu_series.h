#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/frame_pipeline.h"
#include "softforce/fem/body.h"

namespace softforce::pipeline {

// results.pvd, which ParaView opens as an animation over time, and what it binds together: for each
// frame vtu/frame_00000.vtu with the body, vtu/forces_00000.vtu and vtu/markers_00000.vtu with
// points.
class VtuSeries {
 public:
  explicit VtuSeries(const std::filesystem::path& folder);

  void Add(const FrameInWork& frame, const fem::Body& body);
  void Commit();

 private:
  void Bind(const FrameInWork& frame, int part, const std::string& file);

  std::filesystem::path folder_;
  std::vector<std::string> entries_;
};

}  // namespace softforce::pipeline
