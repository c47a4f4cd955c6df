#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "softforce/scene/scene.h"

namespace softforce::pipeline {

// Frames in which all external forces are known.
struct KnownWeights {
  int first_frame = 0;
  int end_frame = 0;  // one past the last
  // N, by the candidate's number in the scene's list: along its direction, or three components of a
  // free one. Candidates that are not named carry nothing.
  std::map<int, Eigen::VectorXd> forces;

  bool Contains(int frame) const { return first_frame <= frame && frame < end_frame; }
};

// How a spec is written, for help texts.
extern const char* const kWeightsHelp;

// Reads specs such as "20:30: 0 = 0.559 N, 1 = 0.559 N", "29: 0 = 0.1 0 -0.5 N" or "0:10: none".
// What is the name of a file stands for its lines, one spec each; empty ones and those that begin
// with # are skipped. Throws InputError naming the spec for one it does not understand, a candidate
// that the scene does not have, a frame in two specs, …
std::vector<KnownWeights> ParseWeights(const std::vector<std::string>& specs,
                                       const scene::Scene& scene);

// Those of the specs that are names of files.
std::vector<std::filesystem::path> WeightsFiles(const std::vector<std::string>& specs);

}  // namespace softforce::pipeline
