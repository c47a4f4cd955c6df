#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace softforce::vision {

// A Matroska file of grey pictures, compressed without loss (MagicYUV). Every picture stands by
// itself and is with the system when Add() returns: a program that is killed leaves a file that can
// be read to that picture. docs/live.md has the measurements behind the choice of the codec.
class SegmentWriter {
 public:
  // Throws InputError if the file cannot be made.
  SegmentWriter(const std::filesystem::path& file, cv::Size size);
  ~SegmentWriter();

  // A CV_8UC1 of the size. `time_s` is what players show, in ms. Throws InputError if it cannot be
  // written. Returns the bytes.
  int64_t Add(const cv::Mat& picture, double time_s);

  // Completes the file, but does not wait for the disk.
  void Finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Brings what was written to a file or folder to the disk.
void SyncToDisk(const std::filesystem::path& path);

}  // namespace softforce::vision
