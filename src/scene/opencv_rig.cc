#include <algorithm>

#include "scene/rig_formats.h"
#include "softforce/base/input_error.h"

namespace softforce::scene {
namespace {

// What cv::FileStorage writes of one camera or of a pair. OpenCV fixes no names for the keys: those
// of its own samples and of common scripts are known here.

using Names = std::vector<std::string>;

// A longer baseline is taken for one that is not in metres.
constexpr double kMaxBaseline = 2;

// The keys of all files together.
class Keys {
 public:
  explicit Keys(const std::vector<YamlValue>& files) {
    for (const YamlValue& file : files) maps_.emplace_back(file);
  }

  std::optional<YamlValue> Find(const Names& names) {
    for (YamlMap& map : maps_) {
      for (const std::string& name : names) {
        if (const auto value = map.Optional(name)) return value;
      }
    }
    return std::nullopt;
  }

  YamlValue Need(const Names& names, const std::string& advice) {
    if (const auto value = Find(names)) return *value;
    Names got;
    for (const YamlMap& map : maps_) {
      for (const std::string& key : map.Keys()) got.push_back(key);
    }
    maps_[0].value().Fail(
        fmt::format("missing key \"{}\", got only {}", fmt::join(names, "\" or \""), Join(got)),
        advice);
  }

  const YamlValue& first() const { return maps_[0].value(); }

 private:
  std::vector<YamlMap> maps_;
};

// With the number of the camera, "1" or "2", or "" for a single one.
Names MatrixNames(const std::string& number) {
  Names names = {"cameraMatrix" + number, "camera_matrix" + number, "K" + number};
  names.push_back(number.empty() ? "Camera_Matrix" : "M" + number);
  return names;
}

Names DistortionNames(const std::string& number) {
  Names names = {"distCoeffs" + number, "distortion_coefficients" + number, "D" + number};
  if (number.empty()) names.insert(names.end(), {"dist_coeffs", "Distortion_Coefficients"});
  return names;
}

LensNumbers ReadLens(Keys& keys, const std::string& number) {
  LensNumbers lens;
  const YamlValue K = keys.Need(MatrixNames(number), "It is the 3x3 camera matrix.");
  const YamlValue D = keys.Need(DistortionNames(number), "They are OpenCV's coefficients.");
  const auto fisheye = keys.Find({"fisheye_model"});
  lens.fisheye = fisheye && fisheye->Integer(0) != 0;
  lens.intrinsics = IntrinsicsOfMatrix(ReadMatrix(K, 3, 3));
  lens.distortion = Coefficients(ReadMatrix(D), lens.fisheye);
  return lens;
}

std::array<int, 2> ReadResolution(Keys& keys, const RigReadOptions& options) {
  for (const auto& [width, height] : std::vector<std::pair<const char*, const char*>>{
           {"image_width", "image_height"}, {"image_Width", "image_Height"}, {"width", "height"}}) {
    const auto value = keys.Find({width});
    if (value) return {value->Integer(1), keys.Need({height}, "").Integer(1)};
  }
  if (const auto size = keys.Find({"image_size", "imageSize", "img_size", "resolution"})) {
    const std::vector<YamlValue> sides = size->Items({2});
    return {sides[0].Integer(1), sides[1].Integer(1)};
  }
  if (options.resolution) return *options.resolution;
  keys.first().Fail("missing keys \"image_width\" and \"image_height\"",
                    "Add them, or convert the file with: softforce rig FILES --resolution "
                    "640x480 -o rig.yaml");
}

// The second camera's T_camera_rig.
Eigen::Isometry3d ReadStereo(Keys& keys, const RigReadOptions& options) {
  const std::string advice =
      "stereoCalibrate gives R and T. If they are in another file, convert both with: softforce "
      "rig intrinsics.yml extrinsics.yml -o rig.yaml";
  const YamlMatrix R = ReadMatrix(keys.Need({"R"}, advice), 3, 3);
  const YamlMatrix T = ReadMatrix(keys.Need({"T"}, advice), 3, 1);
  const Eigen::Matrix3d rotation = RoundedRotation(R.place, R.numbers);
  Eigen::Vector3d translation(T.numbers.data());
  if (const auto unit = keys.Find({"unit"})) {
    translation *= base::UnitInSi(unit->Text(), base::Dimension::kLength, unit->where());
  } else if (options.metres_per_unit) {
    translation *= *options.metres_per_unit;
  } else if (translation.norm() > kMaxBaseline) {
    T.place.Fail(fmt::format("the cameras are {:.5g} apart, expected metres, at most {:g}",
                             translation.norm(), kMaxBaseline),
                 "OpenCV's T has the unit of the board. Add a line \"unit: mm\" (mm, cm or m) to "
                 "the file, or convert it with: softforce rig FILES --unit mm -o rig.yaml");
  }
  return Rigid(rotation, translation);
}

Names ReadCameraNames(Keys& keys, const Names& usual) {
  const auto list = keys.Find({"camera_names"});
  if (!list) return usual;
  Names names;
  for (const YamlValue& name : list->Items({static_cast<int>(usual.size())})) {
    names.push_back(name.Text());
  }
  RefuseRepeated(*list, names, [](const std::string& name) { return "camera " + name; });
  return names;
}

std::string MatrixText(const std::string& name, int rows, int cols,
                       const std::vector<double>& numbers) {
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: {}\n", name,
                     rows, cols, List(numbers));
}

std::string LensText(const camera::Camera& camera, const std::string& K, const std::string& D) {
  const LensNumbers lens = NumbersOf(camera);
  const auto& [fx, fy, cx, cy] = lens.intrinsics;
  const std::vector<double> distortion = ShortDistortion(lens);
  return MatrixText(K, 3, 3, {fx, 0, cx, 0, fy, cy, 0, 0, 1}) +
         MatrixText(D, 1, static_cast<int>(distortion.size()), distortion);
}

std::string StereoText(const camera::Rig& rig) {
  const Eigen::Isometry3d T = Between(rig.cameras[1], rig.cameras[0]);
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R = T.linear();
  const Eigen::Vector3d t = T.translation();
  return LensText(rig.cameras[0], "M1", "D1") + LensText(rig.cameras[1], "M2", "D2") +
         MatrixText("R", 3, 3, {R.data(), R.data() + 9}) +
         MatrixText("T", 3, 1, {t.x(), t.y(), t.z()}) + "unit: m\n";
}

// Throws InputError if OpenCV has no usual form for such a rig.
void CheckHolds(const camera::Rig& rig, const std::string& where) {
  const auto is_fisheye = [](const camera::Camera& camera) { return NumbersOf(camera).fisheye; };
  const camera::Camera& first = rig.cameras[0];
  for (const camera::Camera& camera : rig.cameras) {
    if (camera.width != first.width || camera.height != first.height) {
      throw base::InputError(where, "OpenCV's file has one image size, the cameras have several",
                             "Use Kalibr's format, which has one for each camera.");
    }
    if (is_fisheye(camera) != is_fisheye(first)) {
      throw base::InputError(where, "OpenCV's file has one lens model, the cameras have two",
                             "Use Kalibr's format, which has one for each camera.");
    }
  }
  if (rig.cameras.size() > 2) {
    throw base::InputError(
        where,
        fmt::format("OpenCV's file has at most 2 cameras, the rig has {}", rig.cameras.size()),
        "Use Kalibr's format, which has any number.");
  }
}

}  // namespace

camera::Rig ReadOpenCvRig(const std::vector<YamlValue>& files, const RigReadOptions& options) {
  Keys keys(files);
  const bool pair = keys.Find(MatrixNames("1")) || keys.Find(MatrixNames("2")) ||
                    (keys.Find({"R"}) && keys.Find({"T"}));
  const Names numbers = pair ? Names{"1", "2"} : Names{""};
  const Names names = ReadCameraNames(keys, pair ? Names{"left", "right"} : Names{"camera"});
  camera::Rig rig;
  for (size_t c = 0; c < numbers.size(); ++c) {
    camera::Camera camera;
    camera.name = names[c];
    SetLens(ReadLens(keys, numbers[c]), camera);
    rig.cameras.push_back(camera);
  }
  if (pair) rig.cameras[1].T_camera_rig = ReadStereo(keys, options);
  const std::array<int, 2> resolution = ReadResolution(keys, options);
  for (camera::Camera& camera : rig.cameras) {
    camera.width = resolution[0];
    camera.height = resolution[1];
  }
  return rig;
}

std::string OpenCvText(const camera::Rig& rig, const std::string& where) {
  CheckHolds(rig, where);
  const camera::Camera& first = rig.cameras[0];
  Names names;
  for (const camera::Camera& camera : rig.cameras) names.push_back(Quoted(camera.name));
  return fmt::format("%YAML:1.0\n---\nimage_width: {}\nimage_height: {}\n", first.width,
                     first.height) +
         "camera_names: " + List(names) + "\n" +
         fmt::format("fisheye_model: {}\n", NumbersOf(first).fisheye ? 1 : 0) +
         (rig.cameras.size() == 2 ? StereoText(rig)
                                  : LensText(first, "camera_matrix", "distortion_coefficients"));
}

}  // namespace softforce::scene
