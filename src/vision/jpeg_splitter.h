#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace softforce::vision {

// Finds the JPEG pictures in a stream of bytes: Motion JPEG as it is, or between the headers of a
// multipart message. A picture is there as soon as its last byte is; FFmpeg's own splitter waits
// for the first of the next one, a frame later.
class JpegSplitter {
 public:
  // Calls `take(std::vector<uint8_t>)` with each picture that these bytes complete.
  template <class Take>
  void Add(const uint8_t* bytes, size_t count, Take take) {
    for (size_t i = 0; i < count; ++i) {
      if (!Step(bytes[i])) continue;
      take(std::move(picture_));
      picture_.clear();
    }
  }

 private:
  enum class Place { kOutside, kMarkers, kLengthHigh, kLengthLow, kSegment, kScan };
  static constexpr size_t kLargest = size_t{1} << 26;  // bytes of a picture; more is no JPEG

  bool Step(uint8_t byte);  // true: the picture is complete
  bool Marker(uint8_t code);

  std::vector<uint8_t> picture_;
  Place place_ = Place::kOutside;
  uint8_t last_ = 0;
  uint8_t segment_ = 0;  // marker of the segment that is read
  size_t left_ = 0;      // bytes of it
};

}  // namespace softforce::vision
