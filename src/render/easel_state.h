#pragma once

#include "render/alphabet.h"
#include "render/body_picture.h"
#include "render/surface_edges.h"
#include "softforce/render/easel.h"

namespace softforce::render {

struct Easel::State {
  cv::Mat1b mask;  // as large as any picture so far; 0 between drawings
  Alphabet alphabet;
  BodyPicture body;
  SurfaceEdges edges;
};

}  // namespace softforce::render
