#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace softforce::vision {

// A picture file and which picture of its camera it is.
struct Numbered {
  std::filesystem::path file;
  int number;               // −1: the name has none
  std::string folder, key;  // the name with "#" for the number: the same for all of one camera
};

// In names alike but for their numbers, the number that varies most counts the pictures.
std::vector<Numbered> Number(const std::vector<std::filesystem::path>& files);

// The cameras' names, from each one's folder and key: what sets it apart from the others'.
std::vector<std::string> CameraNames(const std::vector<std::pair<std::string, std::string>>& keys);

}  // namespace softforce::vision
