#include "softforce/vision/frame_source.h"

#include <fmt/format.h>

namespace softforce::vision {
namespace {

std::string Name(CameraReport::State state) {
  switch (state) {
    case CameraReport::State::kOpening:
      return "opening";
    case CameraReport::State::kRunning:
      return "running";
    case CameraReport::State::kAway:
      return "away";
    case CameraReport::State::kEnded:
      return "ended";
  }
  return "";
}

void Append(std::string* text, int64_t count, const char* of_what) {
  if (count > 0) *text += fmt::format(", {} {}", count, of_what);
}

}  // namespace

std::string CameraReport::BriefReport() const {
  std::string text = fmt::format("{}: {}, {} pictures", camera, Name(state), received);
  if (std::isfinite(rate_hz)) text += fmt::format(" ({:.1f} per second)", rate_hz);
  Append(&text, unpaired, "unpaired");
  Append(&text, unsure, "of uncertain time");
  Append(&text, missed, "missed");
  Append(&text, reopened, "times opened again");
  return text;
}

std::string SourceReport::BriefReport() const {
  return fmt::format("{} sets, {} dropped, {} waiting", delivered, dropped, queued);
}

std::string SourceReport::FullReport() const {
  std::string text = BriefReport() + "\n";
  for (const CameraReport& camera : cameras) text += "  " + camera.BriefReport() + "\n";
  if (!truncation.empty()) text += "  " + truncation + "\n";
  return text;
}

}  // namespace softforce::vision
