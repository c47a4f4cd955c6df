#include "pipeline/candidate_count.h"

#include <fmt/format.h>

namespace softforce::pipeline {

CandidateCount CountCandidates(const World& world) {
  CandidateCount count;
  count.candidates = static_cast<int>(world.sites.size());
  for (const estimation::ForceSite& site : world.sites) {
    count.components += static_cast<int>(site.directions.cols());
  }
  count.coordinates = 3 * static_cast<int>(world.markers.size());
  return count;
}

std::string CandidateCount::Brief() const {
  return fmt::format(
      "places of forces are looked for near {} candidates: {} force components, {} measured "
      "coordinates",
      candidates, components, coordinates);
}

std::string CandidateCount::Warning() const {
  return fmt::format(
      "{} candidates have {} force components, more than the {} coordinates of all markers: forces "
      "at many of them at once cannot be told apart (Theorem 4); few forces still can. More "
      "markers or fewer candidates settle it",
      candidates, components, coordinates);
}

}  // namespace softforce::pipeline
