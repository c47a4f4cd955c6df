#include "render/facets.h"

#include <algorithm>
#include <cmath>

namespace softforce::render {
namespace {

constexpr int kMaxCuts = 8;

// A corner of a facet within a triangle of the mesh.
struct Corner {
  std::array<double, 6> shape;             // values of the nodes' shape functions
  std::array<double, 6> along_a, along_b;  // their derivatives from corner 2 towards 0 and 1
};

Corner CornerAt(double a, double b, int nodes) {
  const double c = 1 - a - b;
  if (nodes == 3) return {{a, b, c}, {1, 0, -1}, {0, 1, -1}};
  return {{a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a},
          {4 * a - 1, 0, 1 - 4 * c, 4 * b, -4 * b, 4 * (c - a)},
          {0, 4 * b - 1, 1 - 4 * c, 4 * a, 4 * (c - b), -4 * a}};
}

Eigen::Vector3d Sum(const std::array<double, 6>& weights, const Eigen::Matrix3Xd& nodes,
                    const Eigen::Ref<const Eigen::VectorXi>& triangle) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < triangle.size(); ++i) sum += weights[i] * nodes.col(triangle(i));
  return sum;
}

// How far from its centre a sticker reaches, m.
double Radius(const Sticker& sticker) {
  if (sticker.cells.empty()) return sticker.size / 2;
  const double inner = sticker.cells.cols - 2 * sticker.margin;
  return sticker.size * sticker.cells.cols / inner * M_SQRT1_2;
}

std::vector<std::vector<int>> StickersOfTriangles(const PictureWorld& world) {
  constexpr double kMinFacing = 0.3;  // else the sticker is on the other side of a thin wall
  std::vector<std::vector<int>> lists(world.surface->num_triangles());
  for (int t = 0; t < world.surface->num_triangles(); ++t) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = world.X->col(world.surface->triangles(i, t));
    const Eigen::Vector3d middle = corners.rowwise().mean();
    const double radius = (corners.colwise() - middle).colwise().norm().maxCoeff();
    const Eigen::Vector3d normal =
        (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).normalized();
    for (int s = 0; s < static_cast<int>(world.stickers.size()); ++s) {
      const Sticker& sticker = world.stickers[s];
      const bool near = (sticker.centre - middle).norm() <= 1.1 * (radius + Radius(sticker));
      if (near && sticker.normal().dot(normal) > kMinFacing) lists[t].push_back(s);
    }
  }
  return lists;
}

}  // namespace

FacetMaker::FacetMaker(const PictureWorld& world, const View& view, const PictureOptions& options)
    : world_(world),
      view_(view),
      options_(options),
      stickers_(StickersOfTriangles(world)),
      no_stickers_(1) {}

float FacetMaker::LightOn(const Eigen::Vector3d& normal_robot) const {
  const double direct = std::max(0.0, normal_robot.normalized().dot(options_.light.normalized()));
  return static_cast<float>(options_.ambient + (1 - options_.ambient) * direct);
}

bool FacetMaker::Place(Facet* facet) const {
  const Eigen::Vector3d normal = (facet->p[1] - facet->p[0]).cross(facet->p[2] - facet->p[0]);
  if (!(normal.dot(facet->p[0]) < 0)) return false;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const Eigen::Vector3d& p : facet->p) {
    const camera::Projection projection = camera::Project(view_.camera->lens, p);
    if (!projection.visible) return false;
    low = low.cwiseMin(projection.pixel);
    high = high.cwiseMax(projection.pixel);
  }
  // The picture of a straight edge is curved: by less than this share of its length.
  const double slack = 1 + 0.05 * (high - low).maxCoeff();
  const double limit = 2.0 * std::max(view_.size.width, view_.size.height);
  low = (low.array() - slack).max(-limit);
  high = (high.array() + slack).min(limit);
  facet->reach =
      cv::Rect(cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
               cv::Point(static_cast<int>(high.x()) + 2, static_cast<int>(high.y()) + 2));
  return facet->reach.area() > 0;
}

// A parabola through the ends of an edge and its middle node is cut into so many chords that none
// is further off than the flatness allows.
int FacetMaker::CutsFor(const Eigen::Matrix3Xd& x) const {
  if (world_.surface->order() == 1) return 1;
  double sag = 0;
  for (const auto triangle : world_.surface->triangles.colwise()) {
    for (int e = 0; e < 3; ++e) {
      sag = std::max(
          sag, (x.col(triangle(3 + e)) - 0.5 * (x.col(triangle(e)) + x.col(triangle((e + 1) % 3))))
                   .norm());
    }
  }
  const double cuts = std::ceil(std::sqrt(sag / PictureMaker::kFlatness));
  return static_cast<int>(std::clamp(cuts, 1.0, static_cast<double>(kMaxCuts)));
}

void FacetMaker::AddTriangle(int triangle, const Eigen::Matrix3Xd& x, int cuts,
                             std::vector<Facet>* facets) const {
  const auto nodes = world_.surface->triangles.col(triangle);
  struct Vertex {
    Eigen::Vector3d X, p;
    float light;
  };
  std::vector<Vertex> vertices;  // row by row, from corner 2 towards corner 1
  const auto index = [cuts](int i, int j) { return j * (cuts + 1) - j * (j - 1) / 2 + i; };
  for (int j = 0; j <= cuts; ++j) {
    for (int i = 0; i + j <= cuts; ++i) {
      const Corner at = CornerAt(static_cast<double>(i) / cuts, static_cast<double>(j) / cuts,
                                 static_cast<int>(nodes.size()));
      const Eigen::Vector3d normal = Sum(at.along_a, x, nodes).cross(Sum(at.along_b, x, nodes));
      vertices.push_back({Sum(at.shape, *world_.X, nodes),
                          view_.T_camera_robot * Sum(at.shape, x, nodes), LightOn(normal)});
    }
  }
  const auto add = [&](int a, int b, int c) {
    const Vertex &A = vertices[a], &B = vertices[b], &C = vertices[c];
    Facet facet{{A.X, B.X, C.X},
                {A.p, B.p, C.p},
                {A.light, B.light, C.light},
                &stickers_[triangle],
                -1,
                {}};
    if (Place(&facet)) facets->push_back(facet);
  };
  for (int j = 0; j < cuts; ++j) {
    for (int i = 0; i + j < cuts; ++i) {
      add(index(i + 1, j), index(i, j + 1), index(i, j));
      if (i + j + 1 < cuts) add(index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
    }
  }
}

// A tag is a square with its margin; a disc is cut out of one when it is painted.
void FacetMaker::AddCard(int card, std::vector<Facet>* facets) const {
  const Sticker& sticker = world_.cards[card];
  const double half = sticker.cells.empty() ? sticker.size / 2 : Radius(sticker) * M_SQRT1_2;
  std::array<Eigen::Vector3d, 4> corners;  // counter-clockwise
  for (int i = 0; i < 4; ++i) {
    corners[i] = sticker.centre + half * ((i == 1 || i == 2 ? 1 : -1) * sticker.right +
                                          (i >= 2 ? 1 : -1) * sticker.up);
  }
  const float light = LightOn(sticker.normal());
  for (const auto& [a, b, c] : {std::array<int, 3>{0, 1, 2}, std::array<int, 3>{0, 2, 3}}) {
    Facet facet{{corners[a], corners[b], corners[c]},
                {view_.T_camera_robot * corners[a], view_.T_camera_robot * corners[b],
                 view_.T_camera_robot * corners[c]},
                {light, light, light},
                no_stickers_.data(),
                card,
                {}};
    if (Place(&facet)) facets->push_back(facet);
  }
}

std::vector<Facet> FacetMaker::Make(const Eigen::Matrix3Xd& x) const {
  std::vector<Facet> facets;
  const int cuts = CutsFor(x);
  for (int t = 0; t < world_.surface->num_triangles(); ++t) AddTriangle(t, x, cuts, &facets);
  for (int c = 0; c < static_cast<int>(world_.cards.size()); ++c) AddCard(c, &facets);
  return facets;
}

}  // namespace softforce::render
