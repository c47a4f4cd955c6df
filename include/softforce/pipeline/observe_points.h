#pragma once

#include <vector>

#include "softforce/pipeline/observe.h"
#include "softforce/scene/measured.h"

namespace softforce::pipeline {

// Which points of motion capture belong to which features, and where those are. A point with a
// label is its marker, wherever it is: only the fit may find that it cannot be. Points without are
// allocated to the features that are left, by prediction, gate, threshold displacement (m) and
// global assignment in space. `markers`: of each feature, by number in the scene's list.
std::vector<FeatureObservation> ObservePoints(const Eigen::Isometry3d& T_rig_robot,
                                              const std::vector<PredictedFeature>& predicted,
                                              const std::vector<int>& markers,
                                              const std::vector<scene::MeasuredPoint>& points,
                                              double threshold_displacement,
                                              const allocation::AllocationOptions& options);

}  // namespace softforce::pipeline
