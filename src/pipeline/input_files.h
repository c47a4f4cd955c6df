#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace softforce::pipeline {

// A file that a run read.
struct InputFile {
  std::string name, sha256;
};

// Of a camera's folder in a recording, its table of times stands for all.
std::vector<InputFile> DescribeInputs(const std::vector<std::filesystem::path>& inputs);

}  // namespace softforce::pipeline
