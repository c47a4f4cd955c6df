#pragma once

#include <string>

namespace softforce::pipeline {

// What is drawn over the pictures.
struct OverlayLayers {
  bool net = true;           // edges of the body's surface
  bool displacement = true;  // as colour over the body, with a scale
  bool stress = false;       // von Mises, as colour over the body instead of displacement
  bool markers = true;       // by status
  bool regions = true;       // 95 % regions of hidden markers, forces and their places
  bool candidates = true;
  bool forces = true;
  bool cables = true;
  bool axes = true;   // of the robot frame
  bool chart = true;  // forces over time, below the pictures
};

// "all" (but stress, whose place displacement has), "none", or names separated by commas:
// "net,forces,chart". A name with a minus sign leaves that one out of all: "-axes,-candidates".
// Throws InputError naming `option`.
OverlayLayers ParseOverlayLayers(const std::string& text, const std::string& option);

// The names, separated by commas.
std::string OverlayLayerNames();

}  // namespace softforce::pipeline
