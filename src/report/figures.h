#pragma once

#include "softforce/report/calibration_report.h"

namespace softforce::report {

// Figures that text and page share.

struct Centre {
  double value = NAN;  // px, projection uncertainty in the middle of the picture
  double worst = NAN;  // px, anywhere in it
};

Centre UncertaintyOf(const calibration::ProjectionUncertainty& uncertainty);

// Distance of a camera from the first, m.
struct Baseline {
  double distance = NAN, sd = NAN;
};

Baseline BaselineOf(const calibration::Calibration& result, int camera);

int ViewsUsed(const calibration::Calibration& result);

// "usable", "usable, but read the advice", or "not usable".
enum class Verdict { kGood, kAdvice, kNotUsable };
Verdict VerdictOf(const calibration::Calibration& result);
const char* Text(Verdict verdict);

// What was held out, in words: "0.25 px, 0.168 mm between neighbouring points, …"; empty if nothing
// was.
std::string HoldOutText(const calibration::HoldOut& hold_out);

// How many pictures were left out for each reason, the commonest first: "3 blurred, 1 no board".
std::string LeftOutText(const std::vector<LeftOutPicture>& pictures);

}  // namespace softforce::report
