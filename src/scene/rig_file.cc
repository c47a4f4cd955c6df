#include "softforce/scene/rig_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "scene/sections.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
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

camera::Lens ReadLens(YamlMap& map) {
  camera::Lens lens;
  lens.model = map.Required("model").Choice<camera::LensModel>(
      {{"brown_conrady", camera::LensModel::kBrownConrady},
       {"kannala_brandt", camera::LensModel::kKannalaBrandt}});
  const YamlValue intrinsics = map.Required("intrinsics", "They are [fx, fy, cx, cy] in px.");
  const std::vector<double> numbers = intrinsics.Numbers({4});
  lens.fx = numbers[0];
  lens.fy = numbers[1];
  lens.cx = numbers[2];
  lens.cy = numbers[3];
  if (lens.fx <= 0 || lens.fy <= 0) {
    intrinsics.Fail(
        fmt::format("got the focal lengths {} and {}, expected more than 0 px", lens.fx, lens.fy));
  }
  const bool fisheye = lens.model == camera::LensModel::kKannalaBrandt;
  const std::vector<double> distortion =
      map.Required("distortion", fisheye ? "It is [k1, k2, k3, k4]."
                                         : "It is [k1, k2, p1, p2], then k3, then k4, k5, k6.")
          .Numbers(fisheye ? std::vector<int>{4} : std::vector<int>{4, 5, 8});
  std::copy(distortion.begin(), distortion.end(), lens.distortion.begin());
  return lens;
}

camera::Camera ReadCamera(YamlMap& map) {
  camera::Camera camera;
  camera.lens = ReadLens(map);
  const std::vector<YamlValue> resolution = map.Required("resolution").Items({2});
  camera.width = resolution[0].Integer(1);
  camera.height = resolution[1].Integer(1);
  camera.T_camera_rig = ReadTransform(map.Required("T_camera_rig"));
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

// The shortest digits that read back as the same double.
template <class Numbers>
std::string List(const Numbers& numbers) {
  return fmt::format("[{}]", fmt::join(numbers, ", "));
}

std::string Rows(const Eigen::Isometry3d& T, const std::string& indent) {
  std::string rows;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector4d row = T.matrix().row(i);
    rows += indent + "- " + List(row) + "\n";
  }
  return rows;
}

std::string ToYaml(const camera::Camera& camera) {
  const camera::Lens& lens = camera.lens;
  const std::array<double, 4> intrinsics = {lens.fx, lens.fy, lens.cx, lens.cy};
  std::string yaml = "  " + YAML::Dump(YAML::Node(camera.name)) + ":\n";
  const bool fisheye = lens.model == camera::LensModel::kKannalaBrandt;
  const std::vector<double> distortion(lens.distortion.begin(),
                                       lens.distortion.begin() + camera::NumDistortion(lens.model));
  yaml += fmt::format("    model: {}\n", fisheye ? "kannala_brandt" : "brown_conrady");
  yaml += fmt::format("    resolution: [{}, {}]\n", camera.width, camera.height);
  yaml += "    intrinsics: " + List(intrinsics) + "  # fx, fy, cx, cy in px\n";
  yaml += "    distortion: " + List(distortion) +
          (fisheye ? "  # k1, k2, k3, k4\n" : "  # k1, k2, p1, p2, k3, k4, k5, k6\n");
  yaml += "    T_camera_rig:  # metres\n" + Rows(camera.T_camera_rig, "      ");
  return yaml;
}

}  // namespace

camera::Rig LoadRig(const std::filesystem::path& file) {
  return ReadYamlFile(file, [](YamlMap& root) {
    camera::Rig rig;
    rig.cameras = root.Required("cameras").ReadMap(ReadRigCameras);
    if (const auto T = root.Optional("T_rig_robot")) rig.T_rig_robot = ReadTransform(*T);
    return rig;
  });
}

void SaveRig(const camera::Rig& rig, const std::filesystem::path& file) {
  std::string yaml = fmt::format("softforce: {}\ncameras:\n", kFormatVersion);
  for (const camera::Camera& camera : rig.cameras) yaml += ToYaml(camera);
  if (rig.T_rig_robot) yaml += "T_rig_robot:  # metres\n" + Rows(*rig.T_rig_robot, "  ");

  base::PendingFile pending(file);
  std::ofstream stream(pending.temporary());
  stream << yaml;
  stream.close();
  if (!stream) {
    throw base::InputError(file.string(), "cannot be written",
                           "Check that its folder exists, may be written to, and has room.");
  }
  pending.Commit();
}

}  // namespace softforce::scene
