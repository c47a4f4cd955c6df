#include <Eigen/SVD>
#include <algorithm>

#include "scene/rig_formats.h"
#include "softforce/geometry/rigid.h"

namespace softforce::scene {
namespace {

// Six decimals, as some tools write, leave a rotation off by some 1e-6 in each entry of R'R - I.
constexpr double kMaxRoundingDefect = 1e-4;

std::array<double, 4> Checked(const YamlValue& place, const std::array<double, 4>& intrinsics) {
  if (!(intrinsics[0] > 0) || !(intrinsics[1] > 0)) {
    place.Fail(fmt::format("got the focal lengths {} and {}, expected more than 0 px",
                           intrinsics[0], intrinsics[1]));
  }
  return intrinsics;
}

}  // namespace

LensNumbers NumbersOf(const camera::Camera& camera) {
  const camera::Lens& lens = camera.lens;
  LensNumbers numbers;
  numbers.fisheye = lens.model == camera::LensModel::kKannalaBrandt;
  numbers.intrinsics = {lens.fx, lens.fy, lens.cx, lens.cy};
  numbers.distortion.assign(lens.distortion.begin(),
                            lens.distortion.begin() + camera::NumDistortion(lens.model));
  return numbers;
}

void SetLens(const LensNumbers& numbers, camera::Camera& camera) {
  camera::Lens lens;
  lens.model =
      numbers.fisheye ? camera::LensModel::kKannalaBrandt : camera::LensModel::kBrownConrady;
  lens.fx = numbers.intrinsics[0];
  lens.fy = numbers.intrinsics[1];
  lens.cx = numbers.intrinsics[2];
  lens.cy = numbers.intrinsics[3];
  std::copy(numbers.distortion.begin(), numbers.distortion.end(), lens.distortion.begin());
  camera.lens = lens;
}

std::vector<double> ShortDistortion(const LensNumbers& lens) {
  std::vector<double> distortion = lens.distortion;
  if (lens.fisheye) return distortion;
  while (!distortion.empty() && distortion.back() == 0) distortion.pop_back();
  const size_t used = distortion.size();
  distortion.resize(used <= 4 ? 4 : used <= 5 ? 5 : 8, 0.0);
  return distortion;
}

YamlMatrix ReadMatrix(const YamlValue& value) {
  if (value.IsMap()) {
    YamlMap map(value);
    const int rows = map.Required("rows").Integer(0);
    const int cols = map.Required("cols").Integer(0);
    return {value, rows, cols, map.Required("data").Numbers({rows * cols})};
  }
  YamlMatrix matrix{value, 0, 0, {}};
  const std::vector<YamlValue> rows = value.Items();
  if (rows.empty() || !rows[0].IsList()) {
    matrix.numbers = value.Numbers({});
    matrix.rows = 1;
    matrix.cols = static_cast<int>(matrix.numbers.size());
    return matrix;
  }
  matrix.rows = static_cast<int>(rows.size());
  matrix.cols = static_cast<int>(rows[0].Items().size());
  for (const YamlValue& row : rows) {
    const std::vector<double> numbers = row.Numbers({matrix.cols});
    matrix.numbers.insert(matrix.numbers.end(), numbers.begin(), numbers.end());
  }
  return matrix;
}

YamlMatrix ReadMatrix(const YamlValue& value, int rows, int cols) {
  const YamlMatrix matrix = ReadMatrix(value);
  const bool vector = rows == 1 || cols == 1;
  const bool as_wanted = matrix.rows == rows && matrix.cols == cols;
  const bool turned = vector && matrix.rows == cols && matrix.cols == rows;
  const bool in_one_list = matrix.rows == 1 && matrix.cols == rows * cols;
  if (as_wanted || turned || in_one_list) return matrix;
  value.Fail(
      fmt::format("got a {}x{} matrix, expected {}x{}", matrix.rows, matrix.cols, rows, cols));
}

std::vector<double> Coefficients(const YamlMatrix& D, bool fisheye) {
  const size_t count = D.numbers.size();
  if (fisheye) {
    if (count != 4) D.place.Fail(fmt::format("got {} coefficients, expected 4", count));
    return D.numbers;
  }
  const std::vector<size_t> counts = {0, 4, 5, 8, 12, 14};
  if (std::count(counts.begin(), counts.end(), count) == 0) {
    D.place.Fail(fmt::format("got {} coefficients, expected 4, 5 or 8", count));
  }
  std::vector<double> numbers = D.numbers;
  if (count > 8 &&
      std::any_of(numbers.begin() + 8, numbers.end(), [](double k) { return k != 0; })) {
    D.place.Fail("got coefficients of thin prism or tilt, expected zeros after the eighth",
                 "softforce has no such lens. Calibrate with at most 8 coefficients.");
  }
  numbers.resize(count == 0 ? 4 : std::min<size_t>(count, 8));
  return numbers;
}

std::array<double, 4> ReadIntrinsics(const YamlValue& list) {
  const std::vector<double> numbers = list.Numbers({4});
  return Checked(list, {numbers[0], numbers[1], numbers[2], numbers[3]});
}

std::array<double, 4> IntrinsicsOfMatrix(const YamlMatrix& matrix) {
  const std::vector<double>& K = matrix.numbers;
  if (K[1] != 0 || K[3] != 0 || K[6] != 0 || K[7] != 0 || K[8] != 1) {
    matrix.place.Fail(
        fmt::format("got the camera matrix {}, expected [fx, 0, cx, 0, fy, cy, 0, 0, 1]", List(K)),
        "softforce has no skew. Calibrate without it.");
  }
  return Checked(matrix.place, {K[0], K[4], K[2], K[5]});
}

Eigen::Matrix3d RoundedRotation(const YamlValue& place, const std::vector<double>& rows) {
  const Eigen::Matrix3d R = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(rows.data());
  const double defect = geometry::RotationDefect(R);
  if (!(defect <= kMaxRoundingDefect)) {
    place.Fail(fmt::format("rotation has determinant {:.7g} and is off by {:.2g}, expected "
                           "determinant 1 and at most {:g} off in any entry of R'R - I",
                           R.determinant(), defect, kMaxRoundingDefect),
               "Copy all digits, as the calibration gave them.");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Eigen::Isometry3d Rigid(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R;
  T.translation() = t;
  return T;
}

Eigen::Isometry3d Between(const camera::Camera& target, const camera::Camera& source) {
  return target.T_camera_rig * source.T_camera_rig.inverse();
}

std::string Rows(const Eigen::Isometry3d& T, const std::string& indent) {
  std::string rows;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector4d row = T.matrix().row(i);
    rows += indent + "- " + List(row) + "\n";
  }
  return rows;
}

std::string Quoted(const std::string& text) { return YAML::Dump(YAML::Node(text)); }

}  // namespace softforce::scene
