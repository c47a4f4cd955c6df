#include "softforce/validation/model.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "softforce/base/input_error.h"
#include "softforce/mesh/read_mesh.h"

namespace softforce::validation {
namespace {

constexpr double kMetresPerUnit = 1e-3;  // of the mesh files
constexpr double kRounding = 1e-9;       // m; so that nodes on the edge of a clamp are held
constexpr double kSide = 0.2;            // m, of the sheet
constexpr double kClamp = 0.01;          // m, side of the squares held at its corners

bool IsHeld(BodyKind kind, const Eigen::Vector3d& X) {
  if (kind == BodyKind::kRobot) return X.z() < kRounding;
  const auto at_edge = [](double x) {
    return x < kClamp + kRounding || x > kSide - kClamp - kRounding;
  };
  return at_edge(X.x()) && at_edge(X.y());
}

// On the inner faces of two legs, halfway up; the guides stand beside the axis.
std::vector<fem::Cable> Cables(const Model& model) {
  struct Place {
    const char* name;
    Eigen::Vector3d attachment, guide;  // m
  };
  const std::array<Place, 2> places{{{"cable1", {0.028095745, 0, 0.05}, {0.005, 0, 0.006}},
                                     {"cable2", {0, 0.028095745, 0.05}, {0, 0.005, 0.006}}}};
  std::vector<fem::Cable> cables;
  for (const Place& place : places) {
    cables.push_back({place.name, {SiteAt(model, place.attachment).at}, place.guide});
  }
  return cables;
}

}  // namespace

mesh::TetMesh ReadBodyMesh(BodyKind body, const std::filesystem::path& meshes) {
  const std::filesystem::path file = meshes / fmt::format("{}.msh", Name(body));
  if (!std::filesystem::exists(file)) {
    throw base::InputError(
        "--meshes",
        fmt::format("{} does not exist; the study needs sheet.msh and robot.msh", file.string()),
        "Name the folder 'meshes' of the project.");
  }
  mesh::TetMesh mesh = mesh::ReadMesh(file, kMetresPerUnit);
  mesh::CheckMesh(mesh, file.string());
  return mesh;
}

Model MakeModel(BodyKind kind, mesh::TetMesh mesh, double youngs_modulus) {
  Model model;
  model.body.mesh = std::move(mesh);
  model.surface = mesh::ExtractSurface(model.body.mesh);
  model.body.materials.assign(model.body.mesh.region_names.size(),
                              {fem::MaterialModel::kNeoHookean, youngs_modulus, kPoissonsRatio});
  for (int node = 0; node < model.body.mesh.num_nodes(); ++node) {
    if (IsHeld(kind, model.body.mesh.nodes.col(node))) model.body.fixed_nodes.push_back(node);
  }
  if (kind == BodyKind::kRobot) model.body.cables = Cables(model);
  return model;
}

fem::Actuation Tensioned(const fem::Body& body, double excess) {
  fem::Actuation actuation = fem::NoActuation(body);
  for (fem::CableCommand& cable : actuation.cables) {
    cable = {fem::CableInput::kTension, kTension + excess};
  }
  return actuation;
}

mesh::NodalWeights PointAt(const Model& model, const Eigen::Vector3d& place) {
  return mesh::ShapeFunctions(
      model.surface, mesh::ClosestSurfacePoint(model.surface, model.body.mesh.nodes, place).at);
}

estimation::ForceSite SiteAt(const Model& model, const Eigen::Vector3d& place) {
  const mesh::SurfacePoint at =
      mesh::ClosestSurfacePoint(model.surface, model.body.mesh.nodes, place).at;
  return {
      fmt::format("({:.4g} {:.4g} {:.4g}) mm", 1e3 * place.x(), 1e3 * place.y(), 1e3 * place.z()),
      mesh::PatchWeights(model.surface, model.body.mesh.nodes, at, kPatch),
      Eigen::Matrix3d::Identity()};
}

}  // namespace softforce::validation
