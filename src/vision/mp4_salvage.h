#pragma once

#include <filesystem>
#include <optional>

namespace softforce::vision {

// A temporary raw H.264 file; removed with this object.
class SalvagedVideo {
 public:
  SalvagedVideo(std::filesystem::path file, int announced_frames, int whole_frames,
                double frames_per_second);
  ~SalvagedVideo();
  SalvagedVideo(SalvagedVideo&& other) noexcept;
  SalvagedVideo& operator=(SalvagedVideo&& other) noexcept;

  const std::filesystem::path& file() const { return file_; }
  int announced_frames() const { return announced_frames_; }
  // Frames 0 … whole_frames − 1 are all there. The file may hold later ones too, of which the cut
  // took the predecessors: pictures are not stored in the order in which they are shown.
  int whole_frames() const { return whole_frames_; }
  double frames_per_second() const { return frames_per_second_; }

 private:
  std::filesystem::path file_;
  int announced_frames_;
  int whole_frames_;
  double frames_per_second_;
};

// Whether a file is an MP4 with pictures (mdat) but without the index that says where they are
// (moov), or with a piece of it only. Recorders write the index last, so that is what a file looks
// like that was cut off.
bool IsMp4WithoutIndex(const std::filesystem::path& file);

// Rewrites the pictures of an MP4 without index as raw H.264, up to the cut. What the index would
// say of the stream (its parameter sets, length, rate) is taken from `sibling`, a complete file
// recorded with the same settings, as the other cameras' are. Nothing if either file is not of that
// kind, holds anything besides pictures (sound), or no frame is whole.
std::optional<SalvagedVideo> SalvageMp4(const std::filesystem::path& file,
                                        const std::filesystem::path& sibling);

}  // namespace softforce::vision
