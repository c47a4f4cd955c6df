#include "softforce/calibration/lens_fit.h"

namespace softforce::calibration {

const char* Name(LensFit lens) {
  switch (lens) {
    case LensFit::kBrownConrady4:
      return "brown_conrady4";
    case LensFit::kBrownConrady5:
      return "brown_conrady5";
    case LensFit::kBrownConrady8:
      return "brown_conrady8";
    case LensFit::kKannalaBrandt:
      return "kannala_brandt";
  }
  return "";
}

camera::LensModel ModelOf(LensFit lens) {
  return lens == LensFit::kKannalaBrandt ? camera::LensModel::kKannalaBrandt
                                         : camera::LensModel::kBrownConrady;
}

int NumDistortion(LensFit lens) {
  switch (lens) {
    case LensFit::kBrownConrady5:
      return 5;
    case LensFit::kBrownConrady8:
      return 8;
    case LensFit::kBrownConrady4:
    case LensFit::kKannalaBrandt:
      return 4;
  }
  return 0;
}

std::vector<std::string> ParameterNames(LensFit lens) {
  const bool fisheye = lens == LensFit::kKannalaBrandt;
  std::vector<std::string> names = {"fx", "fy", "cx", "cy"};
  const std::vector<std::string> distortion =
      fisheye ? std::vector<std::string>{"k1", "k2", "k3", "k4"}
              : std::vector<std::string>{"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  names.insert(names.end(), distortion.begin(), distortion.begin() + NumDistortion(lens));
  return names;
}

}  // namespace softforce::calibration
