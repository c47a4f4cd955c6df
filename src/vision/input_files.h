#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace softforce::vision {

enum class InputKind { kPicture, kVideo, kNeither };

InputKind KindOf(const std::filesystem::path& file);  // by its ending

// The pictures and videos that an input to calibrate stands for: a file, a pattern with * and ? in
// the file's name, or a folder; in the order of their names. Throws InputError, naming the input,
// if there are none.
std::vector<std::filesystem::path> InputFiles(const std::string& input);

}  // namespace softforce::vision
