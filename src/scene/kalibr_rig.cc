#include <algorithm>

#include "scene/rig_formats.h"
#include "softforce/base/input_error.h"

namespace softforce::scene {
namespace {

// camchain.yaml as Kalibr writes it: cam0, cam1, …, each with the transform from the one before.

// Refuses a word that names another model, with what there is instead.
void Expect(const YamlValue& value, const std::vector<std::string>& known,
            const std::string& advice) {
  const std::string word = value.Text();
  if (std::count(known.begin(), known.end(), word) > 0) return;
  value.Fail(fmt::format("got \"{}\", expected {}", word, fmt::join(known, " or ")), advice);
}

LensNumbers ReadLens(YamlMap& map) {
  Expect(map.Required("camera_model"), {"pinhole"},
         "softforce has no lens of this model. Run Kalibr with pinhole-radtan or pinhole-equi.");
  const YamlValue model = map.Required("distortion_model");
  Expect(model, {"radtan", "equi", "none"},
         "softforce has no lens of this model. Run Kalibr with pinhole-radtan or pinhole-equi.");
  LensNumbers lens;
  lens.fisheye = model.Text() == "equi";
  lens.intrinsics = ReadIntrinsics(map.Required("intrinsics", "They are [fu, fv, pu, pv] in px."));
  const YamlValue coefficients = map.Required("distortion_coeffs");
  if (model.Text() == "none") {
    coefficients.Numbers({0});
    lens.distortion.assign(4, 0.0);
  } else {
    lens.distortion = coefficients.Numbers({4});
  }
  return lens;
}

Eigen::Isometry3d ReadChainLink(const YamlValue& value) {
  const std::vector<YamlValue> rows = value.Items({4});
  std::vector<double> rotation;
  Eigen::Vector3d translation;
  for (int i = 0; i < 3; ++i) {
    const std::vector<double> row = rows[i].Numbers({4});
    rotation.insert(rotation.end(), row.begin(), row.begin() + 3);
    translation[i] = row[3];
  }
  if (rows[3].Numbers({4}) != std::vector<double>{0, 0, 0, 1}) {
    rows[3].Fail("got another last row, expected [0, 0, 0, 1]");
  }
  return Rigid(RoundedRotation(value, rotation), translation);
}

camera::Camera ReadCamera(const YamlValue& value, const std::string& key,
                          const camera::Camera* before) {
  YamlMap map(value);  // its other keys (overlaps, topic, IMU) are of no use here
  camera::Camera camera;
  const auto name = map.Optional("camera_name");
  camera.name = name ? name->Text() : key;
  SetLens(ReadLens(map), camera);
  const std::vector<YamlValue> resolution = map.Required("resolution").Items({2});
  camera.width = resolution[0].Integer(1);
  camera.height = resolution[1].Integer(1);
  if (before == nullptr) return camera;
  const YamlValue link = map.Required(
      "T_cn_cnm1", "It says how this camera stands to the one before. Calibrate both together.");
  camera.T_camera_rig = ReadChainLink(link) * before->T_camera_rig;
  return camera;
}

std::string CameraText(const camera::Camera& camera, const std::vector<int>& overlaps,
                       const std::string& where) {
  LensNumbers lens = NumbersOf(camera);
  lens.distortion = ShortDistortion(lens);
  if (lens.distortion.size() > 4) {
    throw base::InputError(
        where,
        fmt::format("camera \"{}\" has {} coefficients of distortion, Kalibr's radtan has 4",
                    camera.name, lens.distortion.size()),
        "Calibrate with --model brown4 if you need this file.");
  }
  return "  cam_overlaps: " + List(overlaps) +
         "\n  camera_model: pinhole\n  camera_name: " + Quoted(camera.name) +
         "\n  distortion_coeffs: " + List(lens.distortion) +
         "\n  distortion_model: " + (lens.fisheye ? "equi" : "radtan") +
         "\n  intrinsics: " + List(lens.intrinsics) +
         fmt::format("\n  resolution: [{}, {}]\n", camera.width, camera.height);
}

}  // namespace

camera::Rig ReadKalibrRig(const YamlValue& file) {
  YamlMap root(file);
  camera::Rig rig;
  for (int c = 0;; ++c) {
    const std::string key = fmt::format("cam{}", c);
    const auto value = root.Optional(key);
    if (!value) break;
    const camera::Camera* before = c == 0 ? nullptr : &rig.cameras.back();
    rig.cameras.push_back(ReadCamera(*value, key, before));
  }
  root.RefuseOtherKeys();
  return rig;
}

std::string KalibrText(const camera::Rig& rig, const std::string& where) {
  std::string yaml;
  const int count = static_cast<int>(rig.cameras.size());
  for (int c = 0; c < count; ++c) {
    std::vector<int> overlaps;
    for (int other = 0; other < count; ++other) {
      if (other != c) overlaps.push_back(other);
    }
    yaml += fmt::format("cam{}:\n", c);
    if (c > 0) {
      yaml += "  T_cn_cnm1:\n" + Rows(Between(rig.cameras[c], rig.cameras[c - 1]), "  ");
    }
    yaml += CameraText(rig.cameras[c], overlaps, where);
  }
  return yaml;
}

}  // namespace softforce::scene
