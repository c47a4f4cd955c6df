#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/design/expected_errors.h"
#include "softforce/design/influence.h"

namespace softforce::design {

// mesh::SpreadPoints puts about kFilling · area / spacing² points on an area.
inline constexpr double kFilling = 0.7;

// Candidates (places where forces may act) at a spacing, and what a layout of markers makes of
// forces on all of them at once.
struct CandidateGrid {
  double spacing = NAN;  // m
  int candidates = 0;
  int components = 0;  // of their forces
  // As many equations as unknowns at least (the paper's Theorem 4).
  bool enough_markers = false;
  double I_w = NAN;  // N/m, ‖W_ef⁺‖₁ of the paper; NaN unless enough_markers
  // N, standard deviation of the candidates' components from the markers' noise alone, the middle
  // one and the largest; infinite unless enough_markers.
  double force_sd = INFINITY, worst_force_sd = INFINITY;
  // Share of the components whose force, of the expected size, stands out from the noise of all the
  // others: it is more than what one that is not there shows once in a thousand times.
  double told_apart = 0;

  // Those beside a support never are.
  bool supported() const { return told_apart >= 0.9; }
};

// `response`: as ResponseTo gives for the markers; `expected`: N, the size of a load.
CandidateGrid JudgeCandidates(double spacing, const std::vector<PlacedLoad>& candidates,
                              const Eigen::MatrixXd& response,
                              const std::vector<MarkerSight>& markers, double expected);

// Spacings to judge, ascending (m): from the one at which about as many candidates stand on
// `area` (m²) as the markers have equations for (Theorem 4), each a quarter wider than the one
// before it, to the one at which two of them do.
std::vector<double> SpacingsToJudge(double area, int markers, int components_each);

// One force at a time: the spacing (m) at which its 95 % region lies within half a spacing around
// its place, at the middle one of the loads and at 90 % of them.
struct LocationSpacing {
  double median = NAN, most = NAN;
};
LocationSpacing SpacingOf(const std::vector<ExpectedError>& errors);

}  // namespace softforce::design
