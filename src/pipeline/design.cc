#include "softforce/pipeline/design.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/design_task.h"
#include "pipeline/open_recording.h"
#include "pipeline/refusals.h"
#include "softforce/base/input_error.h"
#include "softforce/base/progress.h"

namespace softforce::pipeline {
namespace {

constexpr double kLoads = 150;         // sampled places of loads, about
constexpr double kTagRoom = 1.5;       // sides of its black square: to the corners, and white
constexpr double kUsualMarker = 6e-3;  // m, where the scene does not say
constexpr double kSample = 10;         // places that show how many components loads have
constexpr int kMapAtATime = 2000;      // triangles, so that memory stays in tens of megabytes
constexpr double kMost = 0.9;          // share of the loads for `location_most`

using design::ExpectedError;
using design::ExpectedErrors;

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  const auto at =
      std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

std::vector<double> Locations(const std::vector<ExpectedError>& errors) {
  std::vector<double> values;
  values.reserve(errors.size());
  for (const ExpectedError& error : errors) values.push_back(error.location);
  return values;
}

// The body as it stands in the first frame: under its weight and actuation, without forces.
fem::Equilibrium AsItStands(const scene::Scene& scene, World* world) {
  fem::LoadCase load = fem::OwnWeight(world->solver->body());
  if (!scene.actuation.time_s.empty()) {
    load.actuation = ActuationAt(scene, scene.actuation.time_s.front());
  }
  fem::Equilibrium state = world->solver->AtRest();
  const fem::SolveSummary summary = world->solver->Solve(load, &state);
  if (!summary.ok()) {
    throw base::InputError(
        scene.file.string() + ": body",
        "it has no equilibrium under its weight and first actuation: " + summary.BriefReport(),
        summary.Advice());
  }
  return state;
}

// m, the diameter of what must lie flat and be seen of a marker.
double RoomOf(const scene::Markers& markers) {
  if (!std::isfinite(markers.size)) return kUsualMarker;
  return markers.type == scene::MarkerType::kAprilTag ? kTagRoom * markers.size : markers.size;
}

class Job {
 public:
  Job(const std::filesystem::path& scene_file, const DesignOptions& options)
      : options_(options),
        scene_(scene::LoadScene(scene_file, scene::SceneFiles::kToDesign)),
        world_(BuildWorld(scene_)) {
    RefuseToOverwrite(FilesOf(scene_, SourcesOf(scene_, {})), options_.out);
    report_.out = options_.out;
    report_.load = options_.load;
    options_.sight.marker_size = RoomOf(scene_.markers);
    if (options_.count == 0) options_.count = static_cast<int>(world_.markers.size());
  }

  DesignReport Finish();

 private:
  bool Stopped() { return report_.stopped = options_.stop != nullptr && *options_.stop; }
  std::vector<design::PlacedLoad> Place(const std::vector<mesh::SurfacePoint>& places) const;
  void CollectPoints(const MarkerEyes& eyes);
  design::ErrorModel Model(const std::vector<mesh::SurfacePoint>& loads) const;
  ExpectedErrors PrepareErrors(const std::vector<design::PlacedLoad>& loads);
  void Choose(const ExpectedErrors& errors);
  void CompareWithRandom(const ExpectedErrors& errors);
  LayoutErrors Judge(const ExpectedErrors& errors, const std::vector<int>& layout) const;
  Eigen::MatrixXd ResponseOf(const std::vector<int>& layout);
  std::vector<design::MarkerSight> SightsOf(const std::vector<int>& layout) const;
  void JudgeSpacings(const Eigen::MatrixXd& response);
  double IndexWithCandidates(const Eigen::MatrixXd& response, const std::vector<int>& layout) const;
  DesignMaps Map(const Eigen::MatrixXd& best, const Eigen::MatrixXd& own) const;
  std::vector<Eigen::Vector3d> Positions(const std::vector<int>& layout) const;

  DesignOptions options_;
  scene::Scene scene_;
  World world_;
  fem::Equilibrium state_;
  Eigen::Matrix3Xd x_;  // nodes as the body stands
  DesignEyes eyes_;
  LoadSurface load_surface_;
  design::ErrorModel model_;
  // Places for markers, then the scene's own markers.
  std::vector<mesh::SurfacePoint> at_;
  std::vector<mesh::NodalWeights> points_;
  std::vector<design::MarkerSight> sights_;
  std::vector<int> chosen_, own_;
  DesignReport report_;
};

std::vector<design::PlacedLoad> Job::Place(const std::vector<mesh::SurfacePoint>& places) const {
  std::vector<design::PlacedLoad> loads;
  loads.reserve(places.size());
  for (const mesh::SurfacePoint& at : places) {
    loads.emplace_back(world_.surface, world_.mesh().nodes,
                       LoadAt(world_, scene_, at, options_.load), scene_.forces.patch);
  }
  return loads;
}

void Job::CollectPoints(const MarkerEyes& eyes) {
  at_ = MarkerPlaces(world_, MarkerTriangles(world_, options_), eyes, options_, &report_.spacing);
  report_.places = static_cast<int>(at_.size());
  design::CheckRoom(options_.count, report_.places);
  for (const mesh::SurfacePoint& at : at_) {
    points_.push_back(mesh::ShapeFunctions(world_.surface, at));
    sights_.push_back(eyes.Of(at));
  }
  for (size_t i = 0; i < world_.markers.size(); ++i) {
    own_.push_back(static_cast<int>(at_.size()));
    at_.push_back(world_.markers[i].at);
    points_.push_back(world_.markers[i].weights);
    sights_.push_back(eyes.Of(at_.back()));
    if (eyes.NumCameras(at_.back()) >= eyes.needed()) continue;
    report_.warnings.push_back(fmt::format(
        "the scene's marker {} is wholly seen by {} of the cameras only, in the first frame",
        scene_.markers.points[i].id, eyes.NumCameras(at_.back())));
  }
}

design::ErrorModel Job::Model(const std::vector<mesh::SurfacePoint>& loads) const {
  design::ErrorModel model;
  model.force_sd = options_.load;
  model.common_model_error = options_.common_model_error;
  model.local_model_error = options_.local_model_error;
  model.registration = eyes_.registration;
  // Spread as the places are, half of the variance along each tangent.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  const auto count = static_cast<double>(loads.size());
  const auto place = [&](const mesh::SurfacePoint& at) {
    return mesh::Position(world_.surface, world_.mesh().nodes, at);
  };
  for (const mesh::SurfacePoint& at : loads) centre += place(at) / count;
  double variance = 0;
  for (const mesh::SurfacePoint& at : loads) variance += (place(at) - centre).squaredNorm() / count;
  model.location_sd = std::sqrt(variance / 2);
  return model;
}

ExpectedErrors Job::PrepareErrors(const std::vector<design::PlacedLoad>& loads) {
  base::Progress progress("answers of the body", static_cast<int>(points_.size()));
  const design::Influence influence =
      design::ComputeInfluence(world_.solver.get(), state_, points_, loads, [&](int done) {
        if (options_.show_progress) progress.Update(done);
      });
  if (options_.show_progress) progress.Finish();
  return {influence, loads, sights_, model_};
}

void Job::Choose(const ExpectedErrors& errors) {
  design::ChoiceOptions options;
  options.count = options_.count;
  options.among = report_.places;
  options.criterion = options_.criterion;
  base::Progress progress("choices of markers", 0);
  const design::Choice choice = design::ChoosePlaces(errors, options, [&](int done) {
    if (options_.show_progress) progress.Update(done);
  });
  if (options_.show_progress) progress.Finish();
  chosen_ = choice.places;
  report_.exchanges = choice.exchanges;
  report_.settled = choice.settled;
}

LayoutErrors Job::Judge(const ExpectedErrors& errors, const std::vector<int>& layout) const {
  const std::vector<ExpectedError> expected = errors.Expect(layout);
  std::vector<double> forces;
  forces.reserve(expected.size());
  for (const ExpectedError& error : expected) forces.push_back(error.force);
  LayoutErrors judged;
  judged.location = design::MedianLocation(expected);
  judged.location_most = Quantile(Locations(expected), kMost);
  judged.force = Quantile(forces, 0.5);
  judged.location_of_unknown = std::sqrt(2.0) * model_.location_sd;
  return judged;
}

void Job::CompareWithRandom(const ExpectedErrors& errors) {
  std::vector<double> medians, most;
  for (const std::vector<int>& layout : design::RandomLayouts(
           report_.places, options_.count, options_.random_layouts, options_.seed)) {
    const std::vector<ExpectedError> expected = errors.Expect(layout);
    medians.push_back(design::MedianLocation(expected));
    most.push_back(Quantile(Locations(expected), kMost));
  }
  report_.random_layouts = options_.random_layouts;
  report_.random_location = Quantile(medians, 0.5);
  report_.random_location_most = Quantile(most, 0.5);
  report_.random_best = Quantile(medians, 0);
}

Eigen::MatrixXd Job::ResponseOf(const std::vector<int>& layout) {
  std::vector<mesh::NodalWeights> points;
  points.reserve(layout.size());
  for (const int i : layout) points.push_back(points_[i]);
  return design::ResponseTo(world_.solver.get(), state_, points);
}

std::vector<design::MarkerSight> Job::SightsOf(const std::vector<int>& layout) const {
  std::vector<design::MarkerSight> sights;
  sights.reserve(layout.size());
  for (const int i : layout) sights.push_back(sights_[i]);
  return sights;
}

std::vector<Eigen::Vector3d> Job::Positions(const std::vector<int>& layout) const {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(layout.size());
  for (const int i : layout) positions.push_back(sights_[i].position);
  return positions;
}

void Job::JudgeSpacings(const Eigen::MatrixXd& response) {
  const std::vector<design::PlacedLoad> sample =
      Place(LoadPlaces(world_, load_surface_, std::sqrt(load_surface_.area / kSample)));
  int components = 1;
  for (const design::PlacedLoad& load : sample) {
    components = std::max(components, load.num_directions());
  }
  for (const double spacing :
       design::SpacingsToJudge(load_surface_.area, options_.count, components)) {
    const std::vector<design::PlacedLoad> candidates =
        Place(LoadPlaces(world_, load_surface_, spacing));
    if (candidates.size() < 2) break;
    report_.grids.push_back(
        design::JudgeCandidates(spacing, candidates, response, SightsOf(chosen_), options_.load));
  }
}

double Job::IndexWithCandidates(const Eigen::MatrixXd& response,
                                const std::vector<int>& layout) const {
  std::vector<mesh::SurfacePoint> places;
  for (const scene::Candidate& candidate : scene_.forces.candidates) {
    places.push_back(
        mesh::ClosestSurfacePoint(world_.surface, world_.mesh().nodes, candidate.position).at);
  }
  return design::JudgeCandidates(0, Place(places), response, SightsOf(layout), options_.load).I_w;
}

// The expected error of a load on every triangle of the surface.
DesignMaps Job::Map(const Eigen::MatrixXd& best, const Eigen::MatrixXd& own) const {
  const int num_best = static_cast<int>(chosen_.size());
  const int num_own = static_cast<int>(own_.size());
  std::vector<design::MarkerSight> sights = SightsOf(chosen_);
  const std::vector<design::MarkerSight> own_sights = SightsOf(own_);
  sights.insert(sights.end(), own_sights.begin(), own_sights.end());
  std::vector<int> best_layout(num_best), own_layout(num_own);
  std::iota(best_layout.begin(), best_layout.end(), 0);
  std::iota(own_layout.begin(), own_layout.end(), num_best);

  DesignMaps maps;
  maps.best = maps.own = Eigen::VectorXd::Constant(world_.surface.num_triangles(), NAN);
  const std::vector<mesh::SurfacePoint> middles = FreeTriangles(world_);
  for (size_t first = 0; first < middles.size(); first += kMapAtATime) {
    const size_t last = std::min(middles.size(), first + kMapAtATime);
    const std::vector<mesh::SurfacePoint> part(middles.begin() + static_cast<std::ptrdiff_t>(first),
                                               middles.begin() + static_cast<std::ptrdiff_t>(last));
    const std::vector<design::PlacedLoad> loads = Place(part);
    design::Influence influence(num_best + num_own, static_cast<int>(loads.size()));
    for (int j = 0; j < influence.num_loads(); ++j) {
      for (int i = 0; i < num_best; ++i) influence.At(i, j) = loads[j].Rows(best, i);
      for (int i = 0; i < num_own; ++i) influence.At(num_best + i, j) = loads[j].Rows(own, i);
    }
    const ExpectedErrors errors(influence, loads, sights, model_);
    const std::vector<ExpectedError> of_best = errors.Expect(best_layout);
    const std::vector<ExpectedError> of_own = errors.Expect(own_layout);
    for (size_t j = 0; j < part.size(); ++j) {
      maps.best(part[j].triangle) = of_best[j].location;
      maps.own(part[j].triangle) = of_own[j].location;
    }
  }
  return maps;
}

DesignReport Job::Finish() {
  // What can be refused at once comes first.
  load_surface_ = LoadsOn(world_, scene_, options_);
  MarkerTriangles(world_, options_);
  state_ = AsItStands(scene_, &world_);
  x_ = world_.mesh().nodes + state_.u;
  eyes_ = FindEyes(scene_, options_);
  report_.rig_from = eyes_.from;
  const MarkerEyes eyes(eyes_, world_, x_, options_.sight);
  CollectPoints(eyes);
  const std::vector<mesh::SurfacePoint> places =
      LoadPlaces(world_, load_surface_, std::sqrt(design::kFilling * load_surface_.area / kLoads));
  PrepareFolder(options_.out, DesignFiles());
  report_.loads = static_cast<int>(places.size());
  model_ = Model(places);
  if (Stopped()) return report_;
  const ExpectedErrors errors = PrepareErrors(Place(places));
  if (Stopped()) return report_;
  Choose(errors);
  if (Stopped()) return report_;
  CompareWithRandom(errors);
  const Eigen::MatrixXd best = ResponseOf(chosen_), own = ResponseOf(own_);
  report_.best = Judge(errors, chosen_);
  report_.own = Judge(errors, own_);
  report_.best.I_w = IndexWithCandidates(best, chosen_);
  report_.own.I_w = IndexWithCandidates(own, own_);
  JudgeSpacings(best);
  report_.spacing_of_one = design::SpacingOf(errors.Expect(chosen_));
  for (const int i : chosen_) {
    const Eigen::Matrix3d covariance = sights_[i].information.inverse();
    report_.markers.push_back({mesh::Position(world_.surface, world_.mesh().nodes, at_[i]),
                               eyes.NumCameras(at_[i]), std::sqrt(covariance.trace() / 3)});
  }
  const DesignMaps maps = Map(best, own);
  if (Stopped()) return report_;
  WriteDesign(scene_, world_, x_, eyes_, load_surface_, maps, Positions(chosen_), Positions(own_),
              report_);
  return report_;
}

}  // namespace

void DesignOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(option, rule);
  };
  require(count >= 0, "--count", "must be 1 or more, or 0 for as many as the scene has");
  require(spacing >= 0 && std::isfinite(spacing), "--spacing", "must be 0 or more");
  require(load > 0 && std::isfinite(load), "--load", "must be greater than 0 N");
  require(noise >= 0 && std::isfinite(noise), "--noise", "must be 0 or more");
  require(random_layouts >= 1, "--random", "must be 1 or more");
  require(registration_frames >= 1, "--registration-frames", "must be 1 or more");
  require(common_model_error >= 0 && common_model_error < 1, "--common-model-error",
          "must be at least 0 and below 1");
  require(local_model_error >= 0 && local_model_error < 1, "--local-model-error",
          "must be at least 0 and below 1");
  sight.Check();
}

int DesignReport::SupportedGrid() const {
  for (size_t i = 0; i < grids.size(); ++i) {
    if (grids[i].supported()) return static_cast<int>(i);
  }
  return -1;
}

DesignReport Design(const std::filesystem::path& scene_file, const DesignOptions& options) {
  options.Check();
  return Job(scene_file, options).Finish();
}

}  // namespace softforce::pipeline
