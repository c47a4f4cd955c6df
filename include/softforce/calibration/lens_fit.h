#pragma once

#include <string>
#include <vector>

#include "softforce/camera/lens.h"

namespace softforce::calibration {

// A lens model to be fitted, with the number of distortion parameters that are free.
enum class LensFit { kBrownConrady4, kBrownConrady5, kBrownConrady8, kKannalaBrandt };

// "brown_conrady4", "brown_conrady5", "brown_conrady8", "kannala_brandt".
const char* Name(LensFit lens);

camera::LensModel ModelOf(LensFit lens);
int NumDistortion(LensFit lens);

// "fx", "fy", "cx", "cy", then the distortion: "k1", "k2", "p1", …
std::vector<std::string> ParameterNames(LensFit lens);

}  // namespace softforce::calibration
