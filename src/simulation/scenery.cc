#include "softforce/simulation/scenery.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace softforce::simulation {

std::optional<render::Rod> Occluder::At(double time_s) const {
  if (time_s < from_s || time_s >= until_s) return std::nullopt;
  const double share = std::isfinite(until_s) ? (time_s - from_s) / (until_s - from_s) : 0;
  const Eigen::Vector3d place = begin + share * (end - begin);
  return render::Rod{place, place + reach, diameter, grey};
}

render::Sticker StickerAt(const mesh::Surface& surface, const Eigen::Matrix3Xd& X,
                          const Eigen::Vector3d& place, double size, const Eigen::Vector3d& up) {
  const mesh::SurfaceProjection found = mesh::ClosestSurfacePoint(surface, X, place);
  const Eigen::Vector3d normal = mesh::Normal(surface, X, found.at);
  render::Sticker sticker;
  sticker.centre = found.position;
  const Eigen::Vector3d in_surface = up - up.dot(normal) * normal;
  sticker.up = in_surface.norm() > 1e-3 * up.norm() ? in_surface.normalized()
                                                    : Eigen::Vector3d(normal.unitOrthogonal());
  sticker.right = sticker.up.cross(normal);
  sticker.size = size;
  return sticker;
}

render::Sticker DiscAt(const mesh::Surface& surface, const Eigen::Matrix3Xd& X,
                       const Eigen::Vector3d& place, double diameter) {
  return StickerAt(surface, X, place, diameter, Eigen::Vector3d::UnitZ());
}

std::vector<render::Sticker> StrewDecoys(const mesh::Surface& surface, const Eigen::Matrix3Xd& X,
                                         int count, double diameter, const Eigen::Vector3d& facing,
                                         const std::vector<render::Sticker>& keep_clear,
                                         std::uint32_t seed) {
  std::vector<double> areas;  // m², of the triangles that face that way, else 0
  for (const auto triangle : surface.triangles.colwise()) {
    const Eigen::Vector3d a = X.col(triangle(0)), b = X.col(triangle(1)), c = X.col(triangle(2));
    const Eigen::Vector3d normal = 0.5 * (b - a).cross(c - a);
    const bool faces = normal.dot(facing) > 0.5 * normal.norm() * facing.norm();
    areas.push_back(faces ? normal.norm() : 0);
  }
  std::vector<render::Sticker> decoys;
  if (*std::max_element(areas.begin(), areas.end()) == 0) return decoys;

  const auto clear_of = [&](const std::vector<render::Sticker>& others, const Eigen::Vector3d& p) {
    return std::all_of(others.begin(), others.end(), [&](const render::Sticker& other) {
      // The rim of a tag reaches as far as 0.9 of its size.
      const double radius = other.cells.empty() ? 0.5 * other.size : 0.9 * other.size;
      return (p - other.centre).norm() > radius + diameter;
    });
  };
  std::mt19937_64 random(seed);
  std::discrete_distribution<int> pick(areas.begin(), areas.end());
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int tries = 0; tries < 200 * count && static_cast<int>(decoys.size()) < count; ++tries) {
    const auto triangle = surface.triangles.col(pick(random));
    const double root = std::sqrt(uniform(random)), share = uniform(random);
    const Eigen::Vector3d place = (1 - root) * X.col(triangle(0)) +
                                  root * (1 - share) * X.col(triangle(1)) +
                                  root * share * X.col(triangle(2));
    if (!clear_of(keep_clear, place) || !clear_of(decoys, place)) continue;
    decoys.push_back(DiscAt(surface, X, place, diameter));
  }
  return decoys;
}

}  // namespace softforce::simulation
