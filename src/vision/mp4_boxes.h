#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "vision/h264_headers.h"

namespace softforce::vision {

// As much of the MP4 format (ISO 14496-12, 14496-15) as leads to the H.264 units in a file.

using Bytes = std::vector<uint8_t>;

Bytes ReadAll(const std::filesystem::path& file);

// Part of a file: a box's contents, or a unit of the stream. One that runs past the end is clipped
// there.
struct Span {
  size_t begin = 0, end = 0;
  bool clipped = false;

  size_t size() const { return end - begin; }
};

// The first box of a type at the file's top level.
std::optional<Span> TopLevelBox(const Bytes& bytes, const char* type);

// What the index says of the stream.
struct StreamParameters {
  std::vector<Span> parameter_sets;
  H264Sequence sequence;
  size_t length_size = 4;  // bytes of the length in front of each unit
};

// From the avcC record in the index of a complete file.
std::optional<StreamParameters> ReadParameters(const Bytes& bytes);

// The units of the stream in mdat, each with its length in front. Ends where something is no unit.
std::vector<Span> UnitsIn(const Bytes& bytes, const Span& mdat, size_t length_size);

}  // namespace softforce::vision
