#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace softforce::vision {

// The layout of what a Recorder writes; shared by it and by what reads it.
inline constexpr const char* kManifest = "recording.yaml";
inline constexpr const char* kCompleteLine = "complete: true";
inline constexpr const char* kTimeOffsetKey = "time_offset_s";
inline constexpr const char* kTimesFile = "times.csv";
inline constexpr const char* kTimesHeader = "frame,time_s,camera_time_s,segment";

std::filesystem::path SegmentFile(const std::filesystem::path& camera_folder, int segment);

// A line of times.csv.
struct RecordedTime {
  int frame = -1;
  double time_s = 0, camera_time_s = 0;
  int segment = -1;
};
std::string FormatTime(const RecordedTime& time);  // with as many digits as it takes; no newline

// The lines of a camera's times.csv; a last one that was cut off is left out. Throws InputError if
// there is no such file, or a line is none of ours.
std::vector<RecordedTime> ReadTimes(const std::filesystem::path& camera_folder);

// s, by which the times of a camera were corrected when they were recorded: what its recording's
// manifest says, or 0.
double RecordedTimeOffset(const std::filesystem::path& camera_folder);

// Whether the recording in a folder was ended properly.
bool IsComplete(const std::filesystem::path& recording_folder);

}  // namespace softforce::vision
