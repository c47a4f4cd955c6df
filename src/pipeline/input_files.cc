#include "pipeline/input_files.h"

#include "softforce/base/sha256.h"

namespace softforce::pipeline {

std::vector<InputFile> DescribeInputs(const std::vector<std::filesystem::path>& inputs) {
  std::vector<InputFile> files;
  for (const std::filesystem::path& input : inputs) {
    const bool is_folder = std::filesystem::is_directory(input);
    const std::filesystem::path file = is_folder ? input / "times.csv" : input;
    files.push_back(
        {input.filename().string() + (is_folder ? "/times.csv" : ""), base::Sha256OfFile(file)});
  }
  return files;
}

}  // namespace softforce::pipeline
