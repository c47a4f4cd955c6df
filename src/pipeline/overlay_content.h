#pragma once

#include "pipeline/frame_pipeline.h"
#include "softforce/pipeline/overlay_layers.h"
#include "softforce/pipeline/world.h"
#include "softforce/render/overlay.h"

namespace softforce::pipeline {

// What the overlay shows of a frame: its layers, and the caption. `u`, `x`: m, 3×N, displacements
// and places of the nodes; world and x must outlive the content.
render::OverlayScene OverlayContent(const scene::Scene& scene, const World& world,
                                    const OverlayLayers& layers, const FrameInWork& frame,
                                    const Eigen::Matrix3Xd& u, const Eigen::Matrix3Xd& x);

}  // namespace softforce::pipeline
