#include "vision/mp4_boxes.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

namespace softforce::vision {
namespace {

uint64_t BigEndian(const Bytes& bytes, size_t at, int count) {
  uint64_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

}  // namespace

Bytes ReadAll(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// A box is: size, type, contents.
std::optional<Span> TopLevelBox(const Bytes& bytes, const char* type) {
  size_t at = 0;
  while (at + 8 <= bytes.size()) {
    uint64_t size = BigEndian(bytes, at, 4);
    size_t header = 8;
    if (size == 1 && at + 16 <= bytes.size()) {
      size = BigEndian(bytes, at + 8, 8);
      header = 16;
    }
    const bool clipped =
        size == 0 || size > bytes.size() - at;  // 0: the length was never filled in
    if (!clipped && size < header) return std::nullopt;
    const size_t end = clipped ? bytes.size() : at + static_cast<size_t>(size);
    if (std::memcmp(bytes.data() + at + 4, type, 4) == 0) {
      return Span{std::min(at + header, end), end, clipped};
    }
    at = end;
  }
  return std::nullopt;
}

std::optional<StreamParameters> ReadParameters(const Bytes& bytes) {
  const std::optional<Span> moov = TopLevelBox(bytes, "moov");
  if (!moov || moov->clipped) return std::nullopt;
  const std::string tag = "avcC";
  const auto found =
      std::search(bytes.begin() + static_cast<std::ptrdiff_t>(moov->begin),
                  bytes.begin() + static_cast<std::ptrdiff_t>(moov->end), tag.begin(), tag.end());
  size_t at = static_cast<size_t>(found - bytes.begin()) + tag.size();
  if (at + 7 > moov->end) return std::nullopt;
  StreamParameters parameters;
  parameters.length_size = (bytes[at + 4] & 3) + 1;
  at += 5;
  for (const int mask : {0x1f, 0xff}) {  // sequence, then picture parameter sets
    if (at >= moov->end) return std::nullopt;
    const int count = bytes[at++] & mask;
    for (int i = 0; i < count; ++i) {
      if (at + 2 > moov->end) return std::nullopt;
      const size_t size = BigEndian(bytes, at, 2);
      if (at + 2 + size > moov->end) return std::nullopt;
      parameters.parameter_sets.push_back({at + 2, at + 2 + size});
      at += 2 + size;
    }
  }
  if (parameters.parameter_sets.empty()) return std::nullopt;
  const Span& set = parameters.parameter_sets.front();
  const auto sequence = ReadSequence(bytes.data() + set.begin, set.size());
  if (!sequence) return std::nullopt;
  parameters.sequence = *sequence;
  return parameters;
}

std::vector<Span> UnitsIn(const Bytes& bytes, const Span& mdat, size_t length_size) {
  std::vector<Span> units;
  size_t at = mdat.begin;
  while (at + length_size < mdat.end) {
    const uint64_t size = BigEndian(bytes, at, static_cast<int>(length_size));
    at += length_size;
    const bool forbidden_bit = bytes[at] & 0x80;
    if (size == 0 || forbidden_bit) break;
    const bool clipped = size > mdat.end - at;
    units.push_back({at, clipped ? mdat.end : at + static_cast<size_t>(size), clipped});
    at = units.back().end;
  }
  return units;
}

}  // namespace softforce::vision
