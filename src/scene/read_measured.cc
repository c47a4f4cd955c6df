#include <cmath>

#include "scene/sections.h"

namespace softforce::scene {
namespace {

using base::Dimension;

// The points themselves may not be measured yet.
std::filesystem::path PointsFile(const YamlValue& value, SceneFiles files) {
  return files == SceneFiles::kToDesign ? value.Path() : FileOf(value, files);
}

Measured ReadKeys(YamlMap& map, SceneFiles files) {
  Measured measured;
  measured.file = PointsFile(map.Required("file"), files);
  if (const auto unit = map.Optional("unit")) {
    measured.metres_per_unit = base::UnitInSi(unit->Text(), Dimension::kLength, unit->where());
  }
  if (const auto rate = map.Optional("rate")) {
    measured.rate = rate->PositiveQuantity(Dimension::kFrequency);
  }
  if (const auto noise = map.Optional("noise")) {
    measured.noise = noise->PositiveQuantity(Dimension::kLength);
  }
  if (const auto labels = map.Optional("labels")) {
    measured.labels = labels->Choice<bool>({{"true", true}, {"false", false}});
  }
  if (const auto ignore = map.Optional("ignore")) {
    for (const YamlValue& label : ignore->Items()) measured.ignore.push_back(label.Text());
  }
  if (const auto rig = map.Optional("rig")) {
    measured.rig = files == SceneFiles::kToRegister ? rig->Path() : FileOf(*rig, files);
  }
  if (const auto T = map.Optional("T_rig_robot")) {
    if (!measured.rig.empty()) {
      T->Fail("got both \"rig\" and \"T_rig_robot\", expected one of them");
    }
    measured.T_rig_robot = ReadTransform(*T);
  }
  return measured;
}

}  // namespace

Measured ReadMeasured(const YamlValue& value, SceneFiles files) {
  if (value.IsMap()) return value.ReadMap([&](YamlMap& map) { return ReadKeys(map, files); });
  Measured measured;
  measured.file = PointsFile(value, files);
  return measured;
}

}  // namespace softforce::scene
