#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace softforce::validation {

// The two bodies of the simulated study (paper VI), see meshes/README.md.
enum class BodyKind { kSheet, kRobot };

const char* Name(BodyKind body);  // "sheet", "robot": also their files in the meshes' folder

// A force that the direct model is loaded with.
struct AppliedForce {
  Eigen::Vector3d place;  // m, on the body's surface
  Eigen::Vector3d force;  // N
};

// One inverse model of Table I: where forces are looked for, and what is seen of the body.
struct Layout {
  std::string name;  // "s1"
  BodyKind body = BodyKind::kSheet;
  std::string direct;                       // the direct model it watches: "S0"
  std::vector<Eigen::Vector3d> candidates;  // m; the loaded places first, three components each
  std::vector<Eigen::Vector3d> markers;     // m
};

// The forces of the study: 0.4 N up at one place, 0.4 N down at another.
std::vector<AppliedForce> AppliedForces(BodyKind body);

// A weight that the bodies are calibrated with: where no candidate is.
AppliedForce KnownWeight(BodyKind body);

// s2 … s4 watch S0 through the same markers and differ in candidates, s1 with fewer candidates and
// more markers; s5 … s8 watch S1 with the same candidates and differ in markers. Likewise r1 … r8.
std::vector<Layout> SheetLayouts();
std::vector<Layout> RobotLayouts();

}  // namespace softforce::validation
