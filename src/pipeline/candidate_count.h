#pragma once

#include <string>

#include "softforce/pipeline/world.h"

namespace softforce::pipeline {

// What is measured against what is unknown if a force acts at every candidate (the paper's Theorem
// 4): forces of unknown place are found among candidates with certainty only if it is as much.
struct CandidateCount {
  int candidates = 0;
  int components = 0;   // of their forces
  int coordinates = 0;  // that are measured if all markers are seen by two cameras

  bool enough() const { return coordinates >= components; }
  std::string Brief() const;    // one line for the log
  std::string Warning() const;  // if they are not enough
};

CandidateCount CountCandidates(const World& world);

}  // namespace softforce::pipeline
