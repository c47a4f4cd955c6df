#include "softforce/camera/rig.h"

namespace softforce::camera {

std::optional<int> Rig::Find(const std::string& name) const {
  for (int c = 0; c < static_cast<int>(cameras.size()); ++c) {
    if (cameras[c].name == name) return c;
  }
  return std::nullopt;
}

}  // namespace softforce::camera
