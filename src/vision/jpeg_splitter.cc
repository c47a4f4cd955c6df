#include "vision/jpeg_splitter.h"

namespace softforce::vision {
namespace {

constexpr uint8_t kStart = 0xD8, kEnd = 0xD9, kStartOfScan = 0xDA, kRestart0 = 0xD0,
                  kRestart7 = 0xD7, kTemporary = 0x01;

}  // namespace

// After 0xFF and a code outside of a segment's content; true at the end of the picture.
bool JpegSplitter::Marker(uint8_t code) {
  if (code == kEnd) {
    place_ = Place::kOutside;
    return true;
  }
  const bool alone = code == kStart || code == kTemporary || code == 0 || code == 0xFF ||
                     (code >= kRestart0 && code <= kRestart7);
  if (alone) return false;
  segment_ = code;
  place_ = Place::kLengthHigh;
  return false;
}

bool JpegSplitter::Step(uint8_t byte) {
  const uint8_t last = last_;
  last_ = byte;
  if (place_ == Place::kOutside) {
    if (last == 0xFF && byte == kStart) {
      picture_ = {0xFF, kStart};
      place_ = Place::kMarkers;
      last_ = 0;
    }
    return false;
  }
  picture_.push_back(byte);
  if (picture_.size() > kLargest) {
    picture_.clear();
    place_ = Place::kOutside;
    return false;
  }
  switch (place_) {
    case Place::kMarkers:
    case Place::kScan:
      return last == 0xFF && Marker(byte);
    case Place::kLengthHigh:
      left_ = size_t{byte} << 8;
      place_ = Place::kLengthLow;
      return false;
    case Place::kLengthLow:
      left_ += byte;
      left_ = left_ > 2 ? left_ - 2 : 0;  // the length counts itself
      last_ = 0;
      place_ =
          left_ > 0 ? Place::kSegment : (segment_ == kStartOfScan ? Place::kScan : Place::kMarkers);
      return false;
    case Place::kSegment:
      if (--left_ > 0) return false;
      last_ = 0;
      place_ = segment_ == kStartOfScan ? Place::kScan : Place::kMarkers;
      return false;
    case Place::kOutside:
      break;
  }
  return false;
}

}  // namespace softforce::vision
