#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace softforce::vision {

// As much of H.264's headers (ITU-T H.264, clause 7.3) as tells where pictures begin and in which
// order they are shown: with B-pictures that is not the order in which they are stored.

// From a sequence parameter set.
struct H264Sequence {
  bool separate_planes = false;
  int frame_number_bits = 0;
  int order_bits =
      0;  // of the picture order count; 0 if pictures are shown in the order of storage
};

// Nothing for what cameras do not write: fields, scaling matrices, order counts of type 1.
std::optional<H264Sequence> ReadSequence(const uint8_t* unit, size_t size);

// From a slice's header.
struct H264Slice {
  bool starts_picture = false;
  bool starts_sequence = false;  // an IDR picture: everything before it is shown before it
  int order = 0;                 // modulo 2^order_bits
};

bool IsSlice(uint8_t unit_header);

// Parameter sets, and what is said of a picture in front of it.
bool StandsBeforePicture(uint8_t unit_header);

// Nothing if the unit ends within its header.
std::optional<H264Slice> ReadSlice(const H264Sequence& sequence, const uint8_t* unit, size_t size);

}  // namespace softforce::vision
