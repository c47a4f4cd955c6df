#include <fmt/format.h>

#include <algorithm>

#include "scene/sections.h"

namespace softforce::scene {
namespace {

using base::Dimension;

MeshFile ReadMesh(YamlMap& map, SceneFiles files) {
  MeshFile mesh;
  mesh.file = FileOf(map.Required("file"), files);
  const YamlValue unit = map.Required("unit", "Mesh files do not say their unit: mm, m, …");
  mesh.metres_per_unit = base::UnitInSi(unit.Text(), Dimension::kLength, unit.where());
  if (const auto order = map.Optional("order")) {
    mesh.order = order->Choice<int>({{"1", 1}, {"2", 2}});
  }
  return mesh;
}

fem::MaterialModel ReadMaterialModel(const YamlValue& value) {
  const std::string name = value.Text();
  if (const auto model = fem::MaterialModelByName(name)) return *model;
  std::vector<std::string> names;
  for (const auto model :
       {fem::MaterialModel::kCorotational, fem::MaterialModel::kStVenantKirchhoff,
        fem::MaterialModel::kNeoHookean, fem::MaterialModel::kNeoHookeanLogarithmic}) {
    names.push_back(fem::Name(model));
  }
  value.Fail("got \"" + name + "\", expected " + Join(names), DidYouMean(name, names));
}

// From the softest gels to diamond: beyond these a unit went wrong.
constexpr double kSoftest = 100, kStiffest = 1.3e12;  // Pa

double ReadYoungsModulus(const YamlValue& value) {
  const double modulus = value.Quantity(Dimension::kPressure);
  if (modulus > 0 && (modulus < kSoftest || modulus > kStiffest)) {
    value.Fail(
        fmt::format("got {:.3g} Pa, expected {:.3g} to {:.3g} Pa", modulus, kSoftest, kStiffest),
        "Silicone has 50 kPa to 2 MPa. Check the unit.");
  }
  return modulus;
}

fem::Material ReadMaterial(YamlMap& map) {
  fem::Material material;
  material.model = ReadMaterialModel(map.Required("model"));
  material.youngs_modulus = ReadYoungsModulus(map.Required("youngs_modulus"));
  material.poissons_ratio = map.Required("poissons_ratio").Number();
  material.Check(map.value().where());
  return material;
}

// Whether "material" holds a map of materials rather than one material.
bool NamesRegions(const YamlValue& material) {
  YamlMap map(material);
  const std::vector<std::string> keys = map.Keys();
  return !keys.empty() && std::all_of(keys.begin(), keys.end(), [&](const std::string& key) {
    return map.Required(key).IsMap();
  });
}

}  // namespace

std::map<std::string, fem::Material> ReadMaterials(const YamlValue& value) {
  if (!NamesRegions(value)) return {{"", value.ReadMap(ReadMaterial)}};
  return value.ReadMap([](YamlMap& regions) {
    std::map<std::string, fem::Material> materials;
    for (const std::string& region : regions.Keys()) {
      materials[region] = regions.Required(region).ReadMap(ReadMaterial);
    }
    return materials;
  });
}

namespace {

FixedRegion ReadFixedRegion(YamlMap& map) {
  FixedRegion region;
  const auto box = map.Optional("box");
  const auto group = map.Optional("group");
  if (box.has_value() == group.has_value()) {
    map.value().Fail(box ? "got both a box and a group, expected one of them"
                         : "got neither, expected a box or a group",
                     "Write for example: {box: {min: 0 0 0 mm, max: 10 10 10 mm}}");
  }
  if (group) {
    region.group = group->Text();
    return region;
  }
  return box->ReadMap([&](YamlMap& corners) {
    region.box_min = corners.Required("min").Vector(Dimension::kLength);
    region.box_max = corners.Required("max").Vector(Dimension::kLength);
    if ((region.box_min.array() > region.box_max.array()).any()) {
      box->Fail("got a min greater than the max, expected min ≤ max in x, y and z");
    }
    return region;
  });
}

std::vector<FixedRegion> ReadFixed(const YamlValue& value, const std::string& why) {
  value.RefuseEmptyList(why);
  return value.ReadMaps(ReadFixedRegion);
}

}  // namespace

void ReadBody(const YamlValue& value, SceneFiles files, Scene& scene) {
  YamlMap body(value);
  scene.mesh = body.Required("mesh").ReadMap([&](YamlMap& map) { return ReadMesh(map, files); });
  scene.materials = ReadMaterials(body.Required("material"));

  const std::string why_fixed = "With nothing fixed the body would float away.";
  scene.fixed = ReadFixed(body.Required("fixed", why_fixed), why_fixed);

  if (const auto gravity = body.Optional("gravity")) {
    scene.gravity = gravity->Vector(Dimension::kAcceleration);
  }
  if (!scene.gravity.isZero(0)) body.Required("density", "Gravity pulls in proportion to it.");
  if (const auto density = body.Optional("density")) {
    scene.density = density->PositiveQuantity(Dimension::kDensity);
  }
  body.RefuseOtherKeys();
}

}  // namespace softforce::scene
