#pragma once

#include "softforce/pipeline/register.h"
#include "softforce/scene/scene.h"

namespace softforce::pipeline {

// Where the frame of a scene's motion capture is, from the labelled markers of a body on which
// nothing but its actuators and its own weight acts, in one frame: the best rigid fit, whose
// covariance comes from how badly the markers fit, but not better than the points' own noise. A
// marker that is far from where the others put it is left out, with a warning. Throws InputError,
// with advice, if the markers do not tell it.
RegisterReport RegisterByPoints(const scene::Scene& scene, const RegisterOptions& options);

}  // namespace softforce::pipeline
