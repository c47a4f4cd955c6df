#pragma once

#include <opencv2/core.hpp>

namespace softforce::render {

// The colours of Okabe and Ito, told apart with every common colour vision deficiency. Blue green
// red.
inline const cv::Vec3b kBlack(0, 0, 0);
inline const cv::Vec3b kWhite(255, 255, 255);
inline const cv::Vec3b kOrange(0, 159, 230);
inline const cv::Vec3b kSkyBlue(233, 180, 86);
inline const cv::Vec3b kGreen(115, 158, 0);
inline const cv::Vec3b kYellow(66, 228, 240);
inline const cv::Vec3b kVermillion(0, 94, 213);
inline const cv::Vec3b kPurple(167, 121, 204);

}  // namespace softforce::render
