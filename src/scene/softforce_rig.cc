#include "scene/rig_formats.h"
#include "scene/sections.h"
#include "softforce/geometry/rigid.h"

namespace softforce::scene {
namespace {

constexpr double kMaxRotationDefect = 1e-6;

}  // namespace

Eigen::Isometry3d ReadTransform(const YamlValue& value) {
  Eigen::Matrix4d T;
  const std::vector<YamlValue> rows = value.Items({4});
  for (int i = 0; i < 4; ++i) T.row(i) = Eigen::Vector4d(rows[i].Numbers({4}).data());

  if (T.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    rows[3].Fail("got another last row, expected [0, 0, 0, 1]");
  }
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  const double defect = geometry::RotationDefect(R);
  if (!(defect <= kMaxRotationDefect)) {
    value.Fail(fmt::format("rotation has determinant {:.7g} and is off by {:.2g}, expected "
                           "determinant 1 and at most {:g} off in any entry of R'R - I",
                           R.determinant(), defect, kMaxRotationDefect),
               "Write the matrix with at least 7 digits, as the calibration gave it.");
  }
  return Eigen::Isometry3d(T);
}

namespace {

LensNumbers ReadLens(YamlMap& map) {
  LensNumbers lens;
  lens.fisheye =
      map.Required("model").Choice<bool>({{"brown_conrady", false}, {"kannala_brandt", true}});
  lens.intrinsics = ReadIntrinsics(map.Required("intrinsics", "They are [fx, fy, cx, cy] in px."));
  lens.distortion =
      lens.fisheye ? map.Required("distortion", "It is [k1, k2, k3, k4].").Numbers({4})
                   : map.Required("distortion", "It is [k1, k2, p1, p2], then k3, then k4, k5, k6.")
                         .Numbers({4, 5, 8});
  return lens;
}

camera::Camera ReadCamera(YamlMap& map) {
  camera::Camera camera;
  SetLens(ReadLens(map), camera);
  const std::vector<YamlValue> resolution = map.Required("resolution").Items({2});
  camera.width = resolution[0].Integer(1);
  camera.height = resolution[1].Integer(1);
  camera.T_camera_rig = ReadTransform(map.Required("T_camera_rig"));
  if (const auto offset = map.Optional("time_offset")) {
    camera.time_offset_s = offset->Quantity(base::Dimension::kTime);
  }
  if (const auto sd = map.Optional("time_offset_sd")) {
    camera.time_offset_sd_s = sd->PositiveQuantity(base::Dimension::kTime);
  }
  return camera;
}

std::vector<camera::Camera> ReadRigCameras(YamlMap& map) {
  std::vector<camera::Camera> cameras;
  for (const std::string& name : map.Keys()) {
    cameras.push_back(map.Required(name).ReadMap(ReadCamera));
    cameras.back().name = name;
  }
  if (cameras.empty()) map.value().Fail("got no cameras, expected at least one");
  return cameras;
}

// Where the rig stands, and how sure that is.
void ReadPlace(YamlMap& root, camera::Rig* rig) {
  if (const auto T = root.Optional("T_rig_robot")) rig->T_rig_robot = ReadTransform(*T);
  const auto covariance = root.Optional("T_rig_robot_covariance");
  if (!covariance) return;
  if (!rig->T_rig_robot) {
    covariance->Fail("there is no T_rig_robot, which it is the covariance of",
                     "Find the place anew: softforce register --help");
  }
  rig->T_rig_robot_covariance = ReadPlaceCovariance(*covariance);
}

std::string ToYaml(const camera::Camera& camera) {
  const LensNumbers lens = NumbersOf(camera);
  std::string yaml = "  " + Quoted(camera.name) + ":\n";
  yaml += fmt::format("    model: {}\n", lens.fisheye ? "kannala_brandt" : "brown_conrady");
  yaml += fmt::format("    resolution: [{}, {}]\n", camera.width, camera.height);
  yaml += "    intrinsics: " + List(lens.intrinsics) + "  # fx, fy, cx, cy in px\n";
  yaml += "    distortion: " + List(lens.distortion);
  yaml += lens.fisheye ? "  # k1, k2, k3, k4\n" : "  # k1, k2, p1, p2, k3, k4, k5, k6\n";
  yaml += "    T_camera_rig:  # metres\n" + Rows(camera.T_camera_rig, "      ");
  if (camera.time_offset_s != 0)
    yaml += fmt::format("    time_offset: {} s\n", camera.time_offset_s);
  if (camera.time_offset_sd_s > 0) {
    yaml += fmt::format("    time_offset_sd: {} s\n", camera.time_offset_sd_s);
  }
  return yaml;
}

}  // namespace

camera::Rig ReadSoftforceRig(const std::filesystem::path& file,
                             std::optional<RigStatistics>* statistics) {
  return ReadYamlFile(file, [&](YamlMap& root) {
    camera::Rig rig;
    rig.cameras = root.Required("cameras").ReadMap(ReadRigCameras);
    ReadPlace(root, &rig);
    if (const auto section = root.Optional("calibration")) {
      const RigStatistics read = section->ReadMap(ReadStatistics);
      if (statistics != nullptr) *statistics = read;
    }
    return rig;
  });
}

std::string SoftforceText(const camera::Rig& rig, const std::optional<RigStatistics>& statistics) {
  std::string yaml = fmt::format("softforce: {}\ncameras:\n", kFormatVersion);
  for (const camera::Camera& camera : rig.cameras) yaml += ToYaml(camera);
  if (rig.T_rig_robot) yaml += PlaceText(*rig.T_rig_robot, rig.T_rig_robot_covariance, "");
  if (statistics) yaml += StatisticsText(*statistics);
  return yaml;
}

}  // namespace softforce::scene
