#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softforce/scene/scene.h"
#include "softforce/vision/recording.h"

namespace softforce::pipeline {

// Each throws InputError for what a run cannot do, or must not.

// Live cameras, named by a URL, a device or a GStreamer pipeline.
void RefuseLiveSources(const scene::Scene& scene,
                       const std::vector<vision::Recording::Source>& sources);

// Forces whose places have to be found.
void RefuseUnknownLocations(const scene::Scene& scene);

// A folder for results in which they could overwrite one of the inputs.
void RefuseToOverwrite(const std::vector<std::filesystem::path>& inputs,
                       const std::filesystem::path& out);

// A file to be written that is one of the inputs.
void RefuseToReplace(const std::vector<std::filesystem::path>& inputs,
                     const std::filesystem::path& out, const std::string& option);

// Makes the folder for the results and removes what an earlier run left there under the same names,
// so that a run that ends early cannot be mistaken for a complete one.
void PrepareFolder(const std::filesystem::path& out);

// Makes the folder and removes the files of these names from it.
void PrepareFolder(const std::filesystem::path& out, const std::vector<std::string>& names);

}  // namespace softforce::pipeline
