#include "pipeline/tag_oddities.h"

#include <fmt/format.h>

#include <algorithm>

namespace softforce::pipeline {
namespace {

// Pictures in which a tag must be seen, for it to be a tag and not a chance likeness of one.
constexpr long kMinPictures = 3;

}  // namespace

bool TagOddities::Known(const vision::Tag& tag) const {
  const auto& markers = scene_.markers.points;
  const auto& fiducials = scene_.cameras.fiducials;
  return std::any_of(markers.begin(), markers.end(),
                     [&](const auto& marker) { return marker.id == tag.id; }) ||
         std::any_of(fiducials.begin(), fiducials.end(), [&](const auto& fiducial) {
           return fiducial.family == tag.family && fiducial.id == tag.id;
         });
}

void TagOddities::Add(const std::vector<CameraDetections>& cameras) {
  for (size_t c = 0; c < cameras.size(); ++c) {
    std::map<int, int> seen;
    for (const vision::Tag& tag : cameras[c].tags) {
      ++seen[tag.id];
      if (!Known(tag)) ++unknown_[tag.id];
    }
    for (const auto& [id, count] : seen) {
      if (count > 1) ++twice_[{c, id}];
    }
  }
}

std::vector<std::string> TagOddities::Messages() const {
  std::vector<std::string> messages;
  for (const auto& [place, pictures] : twice_) {
    if (pictures < kMinPictures) continue;
    messages.push_back(fmt::format(
        "camera \"{}\": tag {} was there twice in {} pictures, where neither was used; cover or "
        "take away the second print",
        rig_.cameras[place.first].name, place.second, pictures));
  }
  std::string ids;
  for (const auto& [id, pictures] : unknown_) {
    if (pictures >= kMinPictures) ids += (ids.empty() ? "" : ", ") + std::to_string(id);
  }
  if (!ids.empty()) {
    messages.push_back(fmt::format(
        "tags of {} were seen that the scene does not know and that were not used: {}; if they are "
        "on the body, add them to the scene's markers",
        scene_.markers.family, ids));
  }
  return messages;
}

}  // namespace softforce::pipeline
