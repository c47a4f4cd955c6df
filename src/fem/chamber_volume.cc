#include "fem/chamber_volume.h"

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "softforce/geometry/rigid.h"

namespace softforce::fem {
namespace {

// Shape functions of a triangle and their derivatives by the second and third barycentric
// coordinate, at one integration point.
struct WallPoint {
  double weight;  // of the reference triangle of area 1/2
  Eigen::VectorXd N, N_s, N_t;
};

WallPoint FlatPoint(double weight, double s, double t) {
  WallPoint p{weight, Eigen::VectorXd(3), Eigen::VectorXd(3), Eigen::VectorXd(3)};
  p.N << 1 - s - t, s, t;
  p.N_s << -1, 1, 0;
  p.N_t << -1, 0, 1;
  return p;
}

WallPoint CurvedPoint(double weight, double s, double t) {
  const double r = 1 - s - t;
  WallPoint p{weight, Eigen::VectorXd(6), Eigen::VectorXd(6), Eigen::VectorXd(6)};
  p.N << r * (2 * r - 1), s * (2 * s - 1), t * (2 * t - 1), 4 * r * s, 4 * s * t, 4 * t * r;
  p.N_s << 1 - 4 * r, 4 * s - 1, 0, 4 * (r - s), 4 * t, -4 * t;
  p.N_t << 1 - 4 * r, 0, 4 * t - 1, -4 * s, 4 * s, 4 * (r - t);
  return p;
}

// The integrand is a polynomial of degree 1 (flat walls: one point is exact) or 4 (curved: the
// six-point rule of degree 4, Dunavant 1985).
std::vector<WallPoint> WallPoints(Eigen::Index nodes) {
  if (nodes == 3) return {FlatPoint(0.5, 1.0 / 3, 1.0 / 3)};
  constexpr double kA = 0.445948490915965, kWeightA = 0.223381589678011 / 2;
  constexpr double kB = 0.091576213509771, kWeightB = 0.109951743655322 / 2;
  return {CurvedPoint(kWeightA, kA, kA),         CurvedPoint(kWeightA, 1 - 2 * kA, kA),
          CurvedPoint(kWeightA, kA, 1 - 2 * kA), CurvedPoint(kWeightB, kB, kB),
          CurvedPoint(kWeightB, 1 - 2 * kB, kB), CurvedPoint(kWeightB, kB, 1 - 2 * kB)};
}

// Position and tangents of a wall at an integration point.
struct Frame {
  Eigen::Vector3d x, x_s, x_t;
};

Frame FrameAt(const Eigen::Matrix3Xd& corners, const WallPoint& p) {
  return {corners * p.N, corners * p.N_s, corners * p.N_t};
}

// Calls visit(triangle's nodes, their positions, point) for every integration point. Chambers'
// walls are oriented out of the body, hence into the chamber: volume = −1/3 ∫ x · (x_s × x_t).
template <typename Visit>
void ForEachWallPoint(const Chamber& chamber, const Eigen::Matrix3Xd& x, const Visit& visit) {
  const std::vector<WallPoint> points = WallPoints(chamber.walls.rows());
  Eigen::Matrix3Xd corners(3, chamber.walls.rows());
  for (Eigen::Index t = 0; t < chamber.walls.cols(); ++t) {
    for (Eigen::Index i = 0; i < corners.cols(); ++i) {
      corners.col(i) = x.col(chamber.walls(i, t));
    }
    for (const WallPoint& p : points) visit(t, FrameAt(corners, p), p);
  }
}

}  // namespace

double ChamberVolume(const Chamber& chamber, const Eigen::Matrix3Xd& x) {
  double volume = 0;
  ForEachWallPoint(chamber, x, [&](Eigen::Index, const Frame& f, const WallPoint& p) {
    volume -= p.weight / 3 * f.x.dot(f.x_s.cross(f.x_t));
  });
  return volume;
}

void AddChamberVolumeGradient(const Chamber& chamber, const Eigen::Matrix3Xd& x, double scale,
                              Eigen::Matrix3Xd* field) {
  ForEachWallPoint(chamber, x, [&](Eigen::Index t, const Frame& f, const WallPoint& p) {
    const double w = -scale * p.weight / 3;
    const Eigen::Vector3d by_x = w * f.x_s.cross(f.x_t);
    const Eigen::Vector3d by_s = w * f.x_t.cross(f.x);
    const Eigen::Vector3d by_t = w * f.x.cross(f.x_s);
    for (Eigen::Index i = 0; i < chamber.walls.rows(); ++i) {
      field->col(chamber.walls(i, t)) += p.N(i) * by_x + p.N_s(i) * by_s + p.N_t(i) * by_t;
    }
  });
}

void ForEachChamberVolumeCurvature(
    const Chamber& chamber, const Eigen::Matrix3Xd& x, double scale,
    const std::function<void(int, int, const Eigen::Matrix3d&)>& add) {
  // The determinant det(x, x_s, x_t) is linear in each of its columns; moving two of them by α and
  // β leaves the third, w: det(α, β, w) = −αᵀ Skew(w) β, with the sign of the columns' order.
  ForEachWallPoint(chamber, x, [&](Eigen::Index t, const Frame& f, const WallPoint& p) {
    const double w = -scale * p.weight / 3;
    const Eigen::Matrix3d X = w * geometry::Skew(f.x);
    const Eigen::Matrix3d X_s = w * geometry::Skew(f.x_s);
    const Eigen::Matrix3d X_t = w * geometry::Skew(f.x_t);
    for (Eigen::Index a = 0; a < chamber.walls.rows(); ++a) {
      for (Eigen::Index b = 0; b < chamber.walls.rows(); ++b) {
        if (a == b) continue;  // the determinant of two equal columns
        const double by_x_s = p.N(a) * p.N_s(b) - p.N_s(a) * p.N(b);
        const double by_x_t = p.N(a) * p.N_t(b) - p.N_t(a) * p.N(b);
        const double by_s_t = p.N_s(a) * p.N_t(b) - p.N_t(a) * p.N_s(b);
        add(chamber.walls(a, t), chamber.walls(b, t), by_x_t * X_s - by_x_s * X_t - by_s_t * X);
      }
    }
  });
}

}  // namespace softforce::fem
