#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/scene/scene.h"
#include "softforce/vision/recording.h"

namespace softforce::pipeline {

// The cameras' files: those of the scene, or the ones given instead (camera → file).
std::vector<vision::Recording::Source> SourcesOf(const scene::Scene& scene,
                                                 const std::map<std::string, std::string>& instead);

// Every file that a job on the scene reads; of live cameras none.
std::vector<std::filesystem::path> InputsOf(const scene::Scene& scene,
                                            const std::vector<vision::Recording::Source>& sources);

// Those, and the files that the section "simulation" names: what no job may overwrite.
std::vector<std::filesystem::path> FilesOf(const scene::Scene& scene,
                                           const std::vector<vision::Recording::Source>& sources);

// Whether they are live cameras rather than files. Throws InputError for a mixture.
bool AreLive(const std::vector<vision::Recording::Source>& sources);

// Opens the recording of a scene whose forces act at known places. Throws InputError if it cannot
// be read, has live sources, or ends before `first_frame`. `time_offsets_s` (camera → s): instead
// of the rig's.
vision::Recording OpenRecording(const scene::Scene& scene, const camera::Rig& rig,
                                const std::vector<vision::Recording::Source>& sources,
                                int first_frame, const std::string& asked_by,
                                const std::map<std::string, double>& time_offsets_s = {});

}  // namespace softforce::pipeline
