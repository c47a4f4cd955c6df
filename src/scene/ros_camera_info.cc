#include "scene/ros_camera_info.h"

#include <cctype>

#include "scene/rig_formats.h"

namespace softforce::scene {
namespace {

struct Model {
  bool fisheye = false;
  std::vector<size_t> counts;  // of coefficients
};

Model ModelOf(const YamlValue& word) {
  return word.Choice<Model>({{"plumb_bob", {false, {4, 5}}},
                             {"rational_polynomial", {false, {8, 12, 14}}},
                             {"equidistant", {true, {4}}},
                             {"fisheye", {true, {4}}}});
}

// Found under its name in the tools' files, under a letter in the message.
YamlValue Matrix(YamlMap& map, const std::string& name, char letter) {
  for (const char key : {letter, static_cast<char>(std::tolower(letter))}) {
    if (const auto list = map.Optional(std::string(1, key))) return *list;
  }
  return map.Required(name);
}

LensNumbers ReadLens(YamlMap& map) {
  const Model model = ModelOf(map.Required("distortion_model"));
  LensNumbers lens;
  lens.fisheye = model.fisheye;
  lens.intrinsics = IntrinsicsOfMatrix(ReadMatrix(Matrix(map, "camera_matrix", 'K'), 3, 3));
  const YamlMatrix D = ReadMatrix(Matrix(map, "distortion_coefficients", 'D'));
  if (std::count(model.counts.begin(), model.counts.end(), D.numbers.size()) == 0) {
    D.place.Fail(fmt::format("got {} coefficients, expected {}", D.numbers.size(),
                             fmt::join(model.counts, " or ")));
  }
  lens.distortion = Coefficients(D, lens.fisheye);
  return lens;
}

int Side(YamlMap& map, const std::string& name) {
  if (const auto value = map.Optional("image_" + name)) return value->Integer(1);
  return map.Required(name).Integer(1);
}

std::string MatrixText(const std::string& name, int rows, int cols, const std::string& data) {
  return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: {}\n", name, rows, cols, data);
}

std::string ModelName(bool fisheye, size_t coefficients) {
  if (fisheye) return "equidistant";
  return coefficients == 8 ? "rational_polynomial" : "plumb_bob";
}

}  // namespace

CameraInfo ReadCameraInfo(const YamlValue& file) {
  YamlMap map(file);  // its other keys (header, binning, region of interest) are of no use here
  CameraInfo info;
  info.file_stem = file.file().stem().string();
  const auto name = map.Optional("camera_name");
  info.camera.name = name ? name->Text() : info.file_stem;
  info.camera.width = Side(map, "width");
  info.camera.height = Side(map, "height");
  SetLens(ReadLens(map), info.camera);
  const YamlValue R = Matrix(map, "rectification_matrix", 'R');
  info.R = RoundedRotation(R, ReadMatrix(R, 3, 3).numbers);
  const YamlMatrix P = ReadMatrix(Matrix(map, "projection_matrix", 'P'), 3, 4);
  std::copy(P.numbers.begin(), P.numbers.end(), info.P.begin());
  if (!(info.P[0] > 0) || !(info.P[5] > 0)) {
    P.place.Fail(fmt::format("got the focal lengths {} and {}, expected more than 0 px", info.P[0],
                             info.P[5]));
  }
  return info;
}

std::string CameraInfoText(const CameraInfo& info) {
  const LensNumbers lens = NumbersOf(info.camera);
  const auto& [fx, fy, cx, cy] = lens.intrinsics;
  std::vector<double> D = ShortDistortion(lens);
  if (!lens.fisheye && D.size() == 4) D.push_back(0);  // a plumb bob has five
  const std::array<double, 9> K = {fx, 0, cx, 0, fy, cy, 0, 0, 1};
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R = info.R;
  return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", info.camera.width,
                     info.camera.height, Quoted(info.camera.name)) +
         MatrixText("camera_matrix", 3, 3, List(K)) +
         "distortion_model: " + ModelName(lens.fisheye, D.size()) + "\n" +
         MatrixText("distortion_coefficients", 1, static_cast<int>(D.size()), List(D)) +
         MatrixText("rectification_matrix", 3, 3,
                    List(std::vector<double>(R.data(), R.data() + 9))) +
         MatrixText("projection_matrix", 3, 4, List(info.P));
}

}  // namespace softforce::scene
