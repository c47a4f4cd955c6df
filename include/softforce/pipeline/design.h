#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "softforce/design/candidate_spacing.h"
#include "softforce/design/choose_places.h"
#include "softforce/design/sight.h"

namespace softforce::pipeline {

struct DesignOptions {
  std::filesystem::path out = "design";  // folder; made if it is not there
  // Where markers may sit, and where forces may act: a surface group of the mesh or a selector (see
  // mesh::kSelectorHelp). Empty: all that the cameras see; the faces that the scene's candidates
  // are on.
  std::string on, loads;
  int count = 0;       // markers; 0: as many as the scene has
  double spacing = 0;  // m, between places that markers may have; 0: for some 300 places
  double load = 0.4;   // N, size of the forces to be found
  // m, standard deviation of a marker's coordinates, without regard to cameras; 0: as the cameras
  // see it, or as motion capture measures it.
  double noise = 0;
  design::SightOptions sight;  // its marker_size is the scene's
  double common_model_error = design::ErrorModel().common_model_error;
  double local_model_error = design::ErrorModel().local_model_error;
  design::Criterion criterion = design::Criterion::kLocation;
  int random_layouts = 100;
  unsigned int seed = 1;
  int registration_frames = 10;  // as for a run
  bool show_progress = true;
  const std::atomic<bool>* stop = nullptr;  // set from outside: end, with nothing written

  void Check() const;  // throws InputError naming the option
};

// What a layout of markers is expected to tell of the sampled loads.
struct LayoutErrors {
  double location = NAN;       // m, median over the loads
  double location_most = NAN;  // m, 90 % of the loads are known better
  double force = NAN;          // N, median
  double I_w = NAN;            // N/m, with the scene's candidates

  double location_of_unknown = NAN;  // m, of a load without any marker: the prior
};

struct DesignedMarker {
  Eigen::Vector3d position;  // m, body at rest
  int cameras = 0;           // that see it; 0 if there are none
  double sd = NAN;           // m, of its measured place, root mean square of the coordinates
};

struct DesignReport {
  int places = 0, loads = 0;
  double spacing = NAN;  // m, between places
  double load = NAN;     // N
  std::string rig_from;  // what told where the cameras stand; empty without cameras
  std::vector<DesignedMarker> markers;
  LayoutErrors best, own;
  // Random layouts of as many of the same places: medians over the layouts of their `location` and
  // `location_most`, and the best `location` of all of them.
  int random_layouts = 0;
  double random_location = NAN, random_location_most = NAN, random_best = NAN;  // m
  int exchanges = 0;
  bool settled = false;
  std::vector<design::CandidateGrid> grids;
  design::LocationSpacing spacing_of_one;
  std::vector<std::string> warnings;
  std::filesystem::path out;
  bool stopped = false;

  // Places are told at least twice as well as without markers.
  bool usable() const { return !stopped && best.location < best.location_of_unknown / 2; }
  // The closest spacing of candidates that can be told apart with forces on all of them; −1: none.
  int SupportedGrid() const;
  std::string BriefReport() const;  // one line
  std::string FullReport() const;
};

// Chooses the places of markers on a scene's body from which forces and their places are told best,
// and writes to the folder: markers.yaml (the section for a scene), markers.csv, design.png and
// location_error.vtu (expected location error over the body, with these markers and with the
// scene's own), summary.json. Throws InputError for input that cannot be used.
DesignReport Design(const std::filesystem::path& scene_file, const DesignOptions& options);

}  // namespace softforce::pipeline
