#include "vision/h264_headers.h"

#include <algorithm>
#include <array>

namespace softforce::vision {
namespace {

constexpr int kSlice = 1;
constexpr int kIdrSlice = 5;
constexpr int kSupplement = 6;
constexpr int kDelimiter = 9;  // 7 and 8 are parameter sets

int TypeOf(uint8_t unit_header) { return unit_header & 0x1f; }

// Reads the bits of a unit after its header byte, without the bytes that keep start codes out (0,
// 0, 3). Past the end it reads zeros and is no longer ok().
class BitReader {
 public:
  BitReader(const uint8_t* unit, size_t size) : unit_(unit), size_(size) {}

  int Bit() {
    if (bit_ == 8) NextByte();
    if (byte_ >= size_) {
      ok_ = false;
      return 0;
    }
    return unit_[byte_] >> (7 - bit_++) & 1;
  }
  int Bits(int count) {
    int value = 0;
    for (int i = 0; i < count; ++i) value = value << 1 | Bit();
    return value;
  }
  // Exponential Golomb code, "ue(v)".
  int Golomb() {
    int zeros = 0;
    while (ok_ && Bit() == 0) ++zeros;
    if (zeros > 30) ok_ = false;
    return ok_ ? (1 << zeros) - 1 + Bits(zeros) : 0;
  }
  bool ok() const { return ok_; }

 private:
  void NextByte() {
    bit_ = 0;
    ++byte_;
    if (byte_ >= 3 && byte_ < size_ && unit_[byte_] == 3 && unit_[byte_ - 1] == 0 &&
        unit_[byte_ - 2] == 0) {
      ++byte_;
    }
  }

  const uint8_t* unit_;
  size_t size_;
  size_t byte_ = 0;
  int bit_ = 8;
  bool ok_ = true;
};

bool DescribesColour(int profile) {
  constexpr std::array<int, 9> kProfiles{100, 110, 122, 244, 44, 83, 86, 118, 128};
  return std::find(kProfiles.begin(), kProfiles.end(), profile) != kProfiles.end();
}

}  // namespace

std::optional<H264Sequence> ReadSequence(const uint8_t* unit, size_t size) {
  BitReader bits(unit, size);
  H264Sequence sequence;
  const int profile = bits.Bits(8);
  bits.Bits(16);  // constraints, level
  bits.Golomb();  // id
  if (DescribesColour(profile)) {
    const int chroma_format = bits.Golomb();
    if (chroma_format == 3) sequence.separate_planes = bits.Bit() == 1;
    bits.Golomb();  // depth of luma
    bits.Golomb();  // depth of chroma
    bits.Bit();     // lossless
    const bool scaling_matrix = bits.Bit() == 1;
    if (scaling_matrix) return std::nullopt;
  }
  sequence.frame_number_bits = bits.Golomb() + 4;
  const int order_type = bits.Golomb();
  if (order_type == 1) return std::nullopt;
  if (order_type == 0) sequence.order_bits = bits.Golomb() + 4;
  bits.Golomb();  // reference pictures
  bits.Bit();     // gaps allowed
  bits.Golomb();  // width
  bits.Golomb();  // height
  const bool frames_only = bits.Bit() == 1;
  if (!bits.ok() || !frames_only || sequence.frame_number_bits > 16 || sequence.order_bits > 16) {
    return std::nullopt;
  }
  return sequence;
}

bool IsSlice(uint8_t unit_header) {
  const int type = TypeOf(unit_header);
  return type == kSlice || type == kIdrSlice;
}

bool StandsBeforePicture(uint8_t unit_header) {
  const int type = TypeOf(unit_header);
  return type >= kSupplement && type <= kDelimiter;
}

std::optional<H264Slice> ReadSlice(const H264Sequence& sequence, const uint8_t* unit, size_t size) {
  if (size == 0 || !IsSlice(unit[0])) return std::nullopt;
  BitReader bits(unit, size);
  H264Slice slice;
  slice.starts_picture = bits.Golomb() == 0;  // its first macroblock
  bits.Golomb();                              // kind of slice
  bits.Golomb();                              // picture parameter set
  if (sequence.separate_planes) bits.Bits(2);
  bits.Bits(sequence.frame_number_bits);
  slice.starts_sequence = TypeOf(unit[0]) == kIdrSlice;
  if (slice.starts_sequence) bits.Golomb();  // which IDR picture
  slice.order = bits.Bits(sequence.order_bits);
  if (!bits.ok()) return std::nullopt;
  return slice;
}

}  // namespace softforce::vision
