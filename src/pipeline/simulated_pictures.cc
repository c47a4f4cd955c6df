#include "pipeline/simulated_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <utility>

#include "softforce/base/input_error.h"
#include "softforce/simulation/scenery.h"
#include "softforce/vision/tag_cells.h"

namespace softforce::pipeline {
namespace {

constexpr double kCableGrey = 110;

void PutTag(const std::string& family, int id, const std::string& where, render::Sticker* sticker) {
  const vision::TagCells tag = vision::DrawTag(family, id, where);
  sticker->cells = tag.cells;
  sticker->margin = tag.margin;
}

std::vector<render::Sticker> MarkersOn(const scene::Scene& scene,
                                       const scene::Simulation& simulation,
                                       const SimulatedWorld& world) {
  std::vector<render::Sticker> markers;
  for (const scene::MarkerPoint& point : scene.markers.points) {
    markers.push_back(simulation::StickerAt(world.surface, world.mesh().nodes, point.position,
                                            scene.markers.size, simulation.tag_up));
    if (scene.markers.type != scene::MarkerType::kAprilTag) continue;
    PutTag(scene.markers.family, point.id, scene.file.string() + ": markers", &markers.back());
  }
  return markers;
}

render::Sticker CardOf(const calibration::Fiducial& fiducial, const std::string& file) {
  const std::string where = fmt::format("{}: cameras: fiducials: id {}", file, fiducial.id);
  const auto& [tl, tr, br, bl] = fiducial.corners;
  render::Sticker card;
  card.centre = 0.25 * (tl + tr + br + bl);
  card.right = (tr + br - tl - bl).normalized();
  card.up = (tl + tr - bl - br).normalized();
  card.size = 0.25 * (tr + br - tl - bl).norm() + 0.25 * (tl + tr - bl - br).norm();
  const double half = card.size / 2;
  const double defect = std::max({(tl - card.centre - half * (card.up - card.right)).norm(),
                                  (tr - card.centre - half * (card.up + card.right)).norm(),
                                  (br - card.centre - half * (card.right - card.up)).norm(),
                                  (bl - card.centre + half * (card.right + card.up)).norm()});
  if (!(defect <= 1e-3 * card.size)) {
    throw base::InputError(
        where,
        fmt::format("its corners are {:.2g} mm off a square of {:.4g} mm, at most a thousandth of "
                    "its side is allowed",
                    1e3 * defect, 1e3 * card.size),
        "Give the corners in the order top left, top right, bottom right, bottom left.");
  }
  PutTag(fiducial.family, fiducial.id, where, &card);
  return card;
}

// H.264 stores colour for blocks of 2×2 pixels.
void RefuseOddSizes(const camera::Rig& rig, const std::string& file) {
  for (const camera::Camera& camera : rig.cameras) {
    if (camera.width % 2 == 0 && camera.height % 2 == 0) continue;
    throw base::InputError(fmt::format("{}: cameras: {}: resolution", file, camera.name),
                           fmt::format("got {} x {} px, expected even numbers for a video",
                                       camera.width, camera.height),
                           "Make the pictures a pixel larger or smaller.");
  }
}

// Where the cameras are, seen from the body.
Eigen::Vector3d TowardsCameras(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot,
                               const mesh::TetMesh& mesh) {
  const Eigen::Vector3d middle = mesh.nodes.rowwise().mean();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const camera::Camera& camera : rig.cameras) {
    const Eigen::Isometry3d T_robot_camera = (camera.T_camera_rig * T_rig_robot).inverse();
    sum += (T_robot_camera.translation() - middle).normalized();
  }
  return sum.norm() > 1e-6 ? sum.normalized() : Eigen::Vector3d::UnitZ();
}

}  // namespace

SimulatedPictures::SimulatedPictures(const scene::Scene& scene, const scene::Simulation& simulation,
                                     const SimulatedWorld& world, const camera::Rig& rig,
                                     const Eigen::Isometry3d& T_rig_robot,
                                     const std::filesystem::path& folder)
    : simulation_(simulation), world_(world), rig_(rig) {
  RefuseOddSizes(rig, scene.cameras.rig.string());
  const Eigen::Matrix3Xd& X = world.mesh().nodes;
  const Eigen::Vector3d towards_cameras = TowardsCameras(rig, T_rig_robot, world.mesh());
  render::PictureWorld painted{&world.surface, &X, MarkersOn(scene, simulation, world), {}};
  const std::vector<render::Sticker> strewn =
      simulation::StrewDecoys(world.surface, X, simulation.strewn_decoys, scene.markers.size,
                              towards_cameras, painted.stickers, simulation.seed);
  num_decoys_ = static_cast<int>(strewn.size());
  painted.stickers.insert(painted.stickers.end(), strewn.begin(), strewn.end());
  for (const Eigen::Vector3d& place : simulation.decoys) {
    PlaceOnSurface(
        world.surface, X, place,
        scene.file.string() + ": simulation: pictures: decoys");  // refuses what is off it
    painted.stickers.push_back(simulation::DiscAt(world.surface, X, place, scene.markers.size));
  }
  for (const calibration::Fiducial& fiducial : scene.cameras.fiducials) {
    painted.cards.push_back(CardOf(fiducial, scene.file.string()));
  }
  render::PictureOptions options = simulation.picture;
  if (!simulation.light_given) options.light = towards_cameras;
  for (const camera::Camera& camera : rig.cameras) {
    makers_.emplace_back(camera, camera.T_camera_rig * T_rig_robot, painted, options);
    writers_.emplace_back(folder / (camera.name + ".mp4"), simulation.rate,
                          vision::VideoQuality::kMeasuring);
  }
}

std::map<std::string, std::string> SimulatedPictures::Files() const {
  std::map<std::string, std::string> files;
  for (const camera::Camera& camera : rig_.cameras) files[camera.name] = camera.name + ".mp4";
  return files;
}

VisibleShares SimulatedPictures::Add(int frame, double time_s, const fem::Equilibrium& shape) {
  const Eigen::Isometry3d& T = simulation_.T_robot_mesh;
  const Eigen::Matrix3Xd in_mesh = world_.mesh().nodes + shape.u;
  const Eigen::Matrix3Xd x = (T.linear() * in_mesh).colwise() + T.translation();
  std::vector<render::Rod> rods;
  for (const simulation::Occluder& occluder : simulation_.occluders) {
    if (const auto rod = occluder.At(time_s)) rods.push_back(*rod);
  }
  for (const fem::Cable& cable : world_.direct->body().cables) {
    if (simulation_.cable_diameter == 0) break;
    for (size_t i = 0; i < cable.points.size(); ++i) {
      const bool last = i + 1 == cable.points.size();
      const Eigen::Vector3d end =
          last ? Eigen::Vector3d(T * cable.guide) : cable.points[i + 1].Apply(x);
      rods.push_back({cable.points[i].Apply(x), end, simulation_.cable_diameter, kCableGrey});
    }
  }
  VisibleShares shares;
  for (size_t c = 0; c < makers_.size(); ++c) {
    std::seed_seq mixed{simulation_.seed, static_cast<std::uint32_t>(frame),
                        static_cast<std::uint32_t>(c)};
    std::uint32_t seed = 0;
    mixed.generate(&seed, &seed + 1);
    render::Picture picture = makers_[c].Take(x, rods, seed);
    writers_[c].Add(picture.grey);
    picture.visible_share.resize(world_.markers.size());  // the decoys come after the markers
    shares.push_back(std::move(picture.visible_share));
  }
  return shares;
}

void SimulatedPictures::Commit() {
  for (vision::VideoWriter& writer : writers_) writer.Commit();
}

}  // namespace softforce::pipeline
