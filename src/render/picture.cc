#include "softforce/render/picture.h"

#include <algorithm>
#include <cmath>

#include "render/lens_blur.h"
#include "render/sticker_area.h"
#include "render/tile.h"
#include "softforce/base/input_error.h"

namespace softforce::render {
namespace {

constexpr int kTileSide = 64;  // px

// The part of the picture in which a rod may be seen: nothing if it is not before the camera.
cv::Rect ReachOf(const Rod& rod, const View& view) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const Eigen::Vector3d& end : {rod.begin, rod.end}) {
    const Eigen::Vector3d p = view.T_camera_robot * end;
    const camera::Projection at = camera::Project(view.camera->lens, p);
    if (!at.visible || !(p.z() > rod.diameter)) return {};
    const double radius = view.camera->lens.fx * rod.diameter / p.z() + 2;  // twice, for the lens
    low = low.cwiseMin((at.pixel.array() - radius).matrix());
    high = high.cwiseMax((at.pixel.array() + radius).matrix());
  }
  const Eigen::Vector2d slack = 0.05 * (high - low);  // straight lines are curved in the picture
  low = (low - slack).cwiseMax(-1e5);
  high = (high + slack).cwiseMin(1e5);
  return {cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
          cv::Point(static_cast<int>(high.x()) + 1, static_cast<int>(high.y()) + 1)};
}

// Which things reach into which tile.
struct TileContent {
  cv::Rect core;
  std::vector<int> facets, rods;
};

std::vector<TileContent> TilesOf(cv::Size size, int margin, const std::vector<Facet>& facets,
                                 const std::vector<cv::Rect>& rods) {
  const cv::Rect picture({}, size);
  const int columns = (size.width + kTileSide - 1) / kTileSide;
  const int rows = (size.height + kTileSide - 1) / kTileSide;
  std::vector<TileContent> tiles;
  for (int i = 0; i < rows * columns; ++i) {
    tiles.push_back(
        {cv::Rect(i % columns * kTileSide, i / columns * kTileSide, kTileSide, kTileSide) & picture,
         {},
         {}});
  }
  const auto sort_in = [&](const cv::Rect& reach, int number, std::vector<int> TileContent::*list) {
    const cv::Rect wide =
        cv::Rect(reach.tl() - cv::Point(margin, margin), reach.br() + cv::Point(margin, margin)) &
        picture;
    if (wide.empty()) return;
    for (int row = wide.y / kTileSide; row <= (wide.br().y - 1) / kTileSide; ++row) {
      for (int column = wide.x / kTileSide; column <= (wide.br().x - 1) / kTileSide; ++column) {
        (tiles[row * columns + column].*list).push_back(number);
      }
    }
  };
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    sort_in(facets[f].reach, f, &TileContent::facets);
  }
  for (int r = 0; r < static_cast<int>(rods.size()); ++r) sort_in(rods[r], r, &TileContent::rods);
  return tiles;
}

// From light to numbers: uneven light, contrast, noise, 8 bits.
cv::Mat Expose(cv::Mat1f light, const PictureOptions& options, std::uint32_t seed) {
  for (int y = 0; y < light.rows; ++y) {
    for (int x = 0; x < light.cols; ++x) {
      const double gradient = options.light_gradient.x() * ((x + 0.5) / light.cols - 0.5) +
                              options.light_gradient.y() * ((y + 0.5) / light.rows - 0.5);
      light(y, x) =
          static_cast<float>(light(y, x) * (1 + gradient) * options.contrast + options.brightness);
    }
  }
  if (options.noise > 0) {
    cv::Mat1f noise(light.size());
    cv::RNG random(0x9E3779B97F4A7C15ull ^ (static_cast<std::uint64_t>(seed) + 1));
    random.fill(noise, cv::RNG::NORMAL, 0, options.noise);
    light += noise;
  }
  cv::Mat grey;
  light.convertTo(grey, CV_8U);
  return grey;
}

}  // namespace

void PictureOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("pictures: ") + option, rule);
  };
  require(blur >= 0 && blur <= 10, "blur", "must lie between 0 and 10 px");
  require(noise >= 0 && noise <= 100, "noise", "must lie between 0 and 100 grey levels");
  require(rays >= 1 && rays <= 16, "rays", "must lie between 1 and 16");
  require(contrast > 0 && contrast <= 10, "contrast", "must be above 0 and at most 10");
  require(std::abs(brightness) <= 255, "brightness", "must lie between -255 and 255 grey levels");
  require(light_gradient.cwiseAbs().sum() < 2, "light_gradient",
          "would make a corner darker than black: the two shares must add up to less than 2");
  require(ambient >= 0 && ambient <= 1, "ambient", "must lie between 0 and 1");
  require(light.allFinite() && light.norm() > 0, "light", "must be a direction");
}

struct PictureMaker::State {
  camera::Camera camera;
  PictureWorld world;
  PictureOptions options;
  View view;
  LensBlur blur;
  RayTable rays;
  FacetMaker facets;
  std::vector<StickerArea> areas;

  State(const camera::Camera& camera_in, const Eigen::Isometry3d& T_camera_robot,
        const PictureWorld& world_in, const PictureOptions& options_in)
      : camera(camera_in),
        world(world_in),
        options(options_in),
        view{&camera, T_camera_robot, {camera.width, camera.height}, 1},
        blur(options.blur, options.rays),
        rays(camera, blur.margin()),
        facets(world, view, options) {
    for (const Sticker& sticker : world.stickers) areas.emplace_back(sticker, world);
  }

  cv::Mat1f PaintTile(const TileContent& content, const std::vector<Facet>& seen_facets,
                      const std::vector<Rod>& rods, std::vector<int>* seen) const {
    const int margin = blur.margin();
    const cv::Rect area(content.core.tl() - cv::Point(margin, margin),
                        content.core.size() + cv::Size(2 * margin, 2 * margin));
    Tile tile(area, rays, world, options, seen_facets);
    for (const int f : content.facets) tile.AddFacet(f);
    for (const int r : content.rods) {
      tile.AddRod(view.T_camera_robot * rods[r].begin, view.T_camera_robot * rods[r].end,
                  rods[r].diameter, rods[r].grey);
    }
    return blur.Apply(tile.Shade(content.core, seen));
  }
};

PictureMaker::PictureMaker(const camera::Camera& camera, const Eigen::Isometry3d& T_camera_robot,
                           const PictureWorld& world, const PictureOptions& options) {
  options.Check();
  state_ = std::make_unique<State>(camera, T_camera_robot, world, options);
}
PictureMaker::~PictureMaker() = default;
PictureMaker::PictureMaker(PictureMaker&&) noexcept = default;

Picture PictureMaker::Take(const Eigen::Matrix3Xd& x, const std::vector<Rod>& rods,
                           std::uint32_t seed) const {
  const State& state = *state_;
  const std::vector<Facet> facets = state.facets.Make(x);
  std::vector<cv::Rect> rod_reach;
  for (const Rod& rod : rods) rod_reach.push_back(ReachOf(rod, state.view));
  const std::vector<TileContent> tiles =
      TilesOf(state.view.size, state.blur.margin(), facets, rod_reach);

  cv::Mat1f light(state.view.size, static_cast<float>(state.options.ground));
  const size_t count = state.world.stickers.size();
  std::vector<std::vector<int>> seen(tiles.size(), std::vector<int>(count, 0));
  cv::parallel_for_({0, static_cast<int>(tiles.size())}, [&](const cv::Range& range) {
    for (int t = range.start; t < range.end; ++t) {
      if (tiles[t].facets.empty() && tiles[t].rods.empty()) continue;
      state.PaintTile(tiles[t], facets, rods, &seen[t]).copyTo(light(tiles[t].core));
    }
  });

  Picture picture;
  picture.grey = Expose(light, state.options, seed);
  for (size_t s = 0; s < count; ++s) {
    int rays = 0;
    for (const std::vector<int>& in_tile : seen) rays += in_tile[s];
    const double area = state.areas[s].At(state.view, x) * state.options.rays * state.options.rays;
    picture.visible_share.push_back(area > 0 ? std::min(1.0, rays / area) : 0);
  }
  return picture;
}

}  // namespace softforce::render
