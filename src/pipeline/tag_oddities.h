#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "softforce/pipeline/observe.h"
#include "softforce/scene/scene.h"

namespace softforce::pipeline {

// Tags that cannot be used as they are seen: those that the scene does not know, and those of which
// there are two in one picture, so that neither can be trusted. For the report of a run.
class TagOddities {
 public:
  // The scene and the rig must outlive it.
  TagOddities(const scene::Scene& scene, const camera::Rig& rig) : scene_(scene), rig_(rig) {}

  void Add(const std::vector<CameraDetections>& cameras);

  // One sentence each, with what to do.
  std::vector<std::string> Messages() const;

 private:
  bool Known(const vision::Tag& tag) const;

  const scene::Scene& scene_;
  const camera::Rig& rig_;
  std::map<int, long> unknown_;                   // pictures, by id
  std::map<std::pair<size_t, int>, long> twice_;  // pictures, by camera and id
};

}  // namespace softforce::pipeline
