#include "pipeline/find_boards.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "pipeline/board_hint.h"
#include "softforce/base/input_error.h"
#include "softforce/base/progress.h"

namespace softforce::pipeline {

using base::InputError;
using vision::BoardDetection;
using vision::PictureSet;

namespace {

// What was seen at every moment, without the pictures.
struct Looks {
  std::vector<std::vector<std::string>> sources;        // of each moment, of each camera
  std::vector<std::vector<BoardDetection>> detections;  // likewise
  std::vector<PictureSet> examples;                     // a few whole sets, for hints
};

bool Stopped(const CalibrateOptions& options) {
  return options.calibration.stop != nullptr && *options.calibration.stop;
}

void SetSizes(const PictureSet& set, std::vector<calibration::CameraToCalibrate>& cameras) {
  for (size_t c = 0; c < cameras.size(); ++c) {
    cameras[c].width = set.pictures[c].cols;
    cameras[c].height = set.pictures[c].rows;
  }
}

// "left.mp4 frame 120" of "videos/left.mp4 frame 120".
std::vector<std::string> FileNames(std::vector<std::string> sources) {
  for (std::string& source : sources) source = std::filesystem::path(source).filename().string();
  return sources;
}

// Of a long video, so many moments spread over it; their neighbours show the same anyway.
int Stride(const CalibrateOptions& options, const vision::BoardPictures& pictures) {
  if (!pictures.is_video()) return 1;
  if (pictures.announced_sets() == 0) return options.stride_of_unknown_length;
  return std::max(1, pictures.announced_sets() / options.most_moments);
}

Looks LookAtAll(const CalibrateOptions& options, report::CalibrationRecord& record) {
  vision::BoardPictures pictures(options.inputs);
  const int stride = Stride(options, pictures);
  const int total = (pictures.announced_sets() + stride - 1) / stride;
  std::optional<base::Progress> progress;
  if (options.show_progress) progress.emplace("finding the board", total);
  Looks looks;
  while (const std::optional<PictureSet> set = pictures.Next()) {
    if (looks.sources.empty()) SetSizes(*set, record.input.cameras);
    looks.detections.push_back(DetectBoards(options, set->pictures));
    looks.sources.push_back(FileNames(set->sources));
    const int done = static_cast<int>(looks.sources.size());
    if (done == 1 || done == total / 2) looks.examples.push_back(*set);
    if (progress) progress->Update(done);
    if (Stopped(options)) break;
    pictures.Skip(stride - 1);
  }
  if (progress) progress->Finish();
  return looks;
}

void RefuseBlindCameras(const CalibrateOptions& options, const Looks& looks) {
  for (size_t c = 0; c < options.inputs.size(); ++c) {
    const bool found = std::any_of(looks.detections.begin(), looks.detections.end(),
                                   [&](const auto& moment) { return moment[c].ok(); });
    if (found || looks.detections.empty()) continue;
    std::vector<cv::Mat> pictures;
    for (const PictureSet& set : looks.examples) pictures.push_back(set.pictures[c]);
    throw InputError(
        fmt::format("camera \"{}\"", options.inputs[c].camera),
        fmt::format("{} was found in none of {} pictures ({}: {})", options.board.Text(),
                    looks.detections.size(), looks.sources[0][c], looks.detections[0][c].reason),
        HintAtOtherBoard(options.board, pictures));
  }
}

void AddViews(const Looks& looks, const vision::ChooseOptions& choose,
              report::CalibrationRecord& record) {
  const auto verdicts = vision::ChooseViews(looks.detections, choose);
  for (size_t i = 0; i < verdicts.size(); ++i) {
    calibration::CalibrationView view;
    view.seen.resize(verdicts[i].size());
    for (size_t c = 0; c < verdicts[i].size(); ++c) {
      if (!verdicts[i][c].kept()) {
        record.left_out.push_back(
            {static_cast<int>(c), looks.sources[i][c], verdicts[i][c].reason});
        continue;
      }
      if (view.name.empty()) view.name = looks.sources[i][c];
      view.seen[c] = looks.detections[i][c].view;
    }
    if (!view.name.empty()) record.input.views.push_back(std::move(view));
  }
}

}  // namespace

std::vector<BoardDetection> DetectBoards(const CalibrateOptions& options,
                                         const std::vector<cv::Mat>& pictures) {
  std::vector<BoardDetection> detections(pictures.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(pictures.size())), [&](const cv::Range& range) {
    for (int c = range.start; c < range.end; ++c) {
      detections[c] = vision::DetectBoard(pictures[c], options.board, options.detection);
    }
  });
  return detections;
}

void FindBoards(const CalibrateOptions& options, report::CalibrationRecord& record) {
  for (const vision::CameraInput& camera : options.inputs) {
    record.input.cameras.push_back({camera.camera, 0, 0, options.lens});
  }
  record.input.board = options.board.Points();
  const Looks looks = LookAtAll(options, record);
  if (Stopped(options)) return;
  for (const PictureSet& set : looks.examples) {
    for (size_t c = 0; c < set.pictures.size(); ++c) {
      RefuseIdsBeyondBoard(options.board, set.pictures[c], set.sources[c]);
    }
  }
  RefuseBlindCameras(options, looks);
  AddViews(looks, options.choose, record);
}

}  // namespace softforce::pipeline
