#include "softforce/pipeline/known_weights.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"

namespace softforce::pipeline {

const char* const kWeightsHelp =
    "FRAMES: CANDIDATE = FORCE, …  with FRAMES a number or A:B (A up to but not including B), "
    "CANDIDATE an id of the scene and FORCE along its direction, or three numbers for a free one; "
    "or FRAMES: none. The name of a file stands for its lines";

namespace {

constexpr const char* kExample = "Example: --weights \"20:30: 0 = 0.559 N, 1 = 0.559 N\"";

std::string Trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string> Split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(Trimmed(part));
  if (!text.empty() && text.back() == at) parts.emplace_back();
  return parts;
}

std::optional<int> WholeNumber(const std::string& text) {
  int number = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 0) return std::nullopt;
  return number;
}

// One spec on its way from text to numbers.
class Parser {
 public:
  Parser(const std::string& spec, const scene::Scene& scene)
      : where_(fmt::format("--weights \"{}\"", spec)), scene_(scene) {}

  KnownWeights Parse(const std::string& spec) const;

 private:
  void ParseFrames(const std::vector<std::string>& frames, KnownWeights* weights) const;
  void ParseForce(const std::string& text, KnownWeights* weights) const;
  int CandidateNumber(const std::string& id) const;

  std::string where_;
  const scene::Scene& scene_;
};

void Parser::ParseFrames(const std::vector<std::string>& frames, KnownWeights* weights) const {
  const std::optional<int> first = WholeNumber(frames.front());
  const std::optional<int> end = frames.size() > 1 ? WholeNumber(frames[1]) : first;
  if (!first || !end) {
    throw base::InputError(
        where_,
        fmt::format("got the frames \"{}\", expected a number or A:B", fmt::join(frames, ":")),
        kExample);
  }
  weights->first_frame = *first;
  weights->end_frame = frames.size() > 1 ? *end : *first + 1;
  if (weights->end_frame <= weights->first_frame) {
    throw base::InputError(where_, fmt::format("{}:{} holds no frame", *first, *end),
                           "Frames A up to but not including B need A < B.");
  }
}

int Parser::CandidateNumber(const std::string& id) const {
  std::vector<std::string> ids;
  for (const scene::Candidate& candidate : scene_.forces.candidates) {
    ids.push_back(std::to_string(candidate.id));
  }
  const auto found = std::find(ids.begin(), ids.end(), id);
  if (found != ids.end()) return static_cast<int>(found - ids.begin());
  throw base::InputError(
      where_,
      fmt::format("the scene has no candidate \"{}\", its ids are {}", id, fmt::join(ids, ", ")),
      "A weight must hang at one of the scene's candidates: list it there.");
}

void Parser::ParseForce(const std::string& text, KnownWeights* weights) const {
  const std::vector<std::string> sides = Split(text, '=');
  if (sides.size() != 2) {
    throw base::InputError(
        where_, fmt::format("got \"{}\", expected CANDIDATE = FORCE or none", text), kExample);
  }
  const int number = CandidateNumber(sides[0]);
  const bool free = scene_.forces.candidates[number].direction == scene::ForceDirection::kFree;
  const std::vector<double> force =
      base::ParseQuantity(sides[1], base::Dimension::kForce, free ? 3 : 1,
                          fmt::format("{}: candidate {}, whose direction is {}", where_, sides[0],
                                      free ? "free" : "given"));
  const Eigen::Map<const Eigen::VectorXd> components(force.data(),
                                                     static_cast<Eigen::Index>(force.size()));
  if (!weights->forces.emplace(number, components).second) {
    throw base::InputError(where_, fmt::format("candidate {} is given twice", sides[0]));
  }
}

KnownWeights Parser::Parse(const std::string& spec) const {
  std::vector<std::string> parts = Split(spec, ':');
  if (parts.size() < 2 || parts.size() > 3) {
    throw base::InputError(where_, "expected FRAMES: CANDIDATE = FORCE, …", kExample);
  }
  const std::string forces = parts.back();
  parts.pop_back();
  KnownWeights weights;
  ParseFrames(parts, &weights);
  if (forces == "none") return weights;
  if (forces.empty()) {
    throw base::InputError(where_, "says nothing about the forces",
                           "Write \"none\" for frames in which nothing hangs on the body.");
  }
  for (const std::string& force : Split(forces, ',')) ParseForce(force, &weights);
  return weights;
}

bool IsFile(const std::string& spec) {
  std::error_code ignored;  // a text that cannot be a name is no file
  return std::filesystem::is_regular_file(spec, ignored);
}

// The lines of a file, or the spec itself.
std::vector<std::string> Lines(const std::string& spec) {
  if (!IsFile(spec)) return {spec};
  std::ifstream stream(spec);
  if (!stream) throw base::InputError("--weights " + spec, "the file cannot be read");
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    line = Trimmed(line);
    if (!line.empty() && line.front() != '#') lines.push_back(line);
  }
  if (lines.empty())
    throw base::InputError("--weights " + spec, "the file holds no spec", kExample);
  return lines;
}

}  // namespace

std::vector<KnownWeights> ParseWeights(const std::vector<std::string>& specs,
                                       const scene::Scene& scene) {
  std::vector<KnownWeights> all;
  for (const std::string& spec : specs) {
    for (const std::string& line : Lines(spec)) {
      all.push_back(Parser(line, scene).Parse(line));
      for (size_t i = 0; i + 1 < all.size(); ++i) {
        const int shared = std::max(all[i].first_frame, all.back().first_frame);
        if (!all[i].Contains(shared) || !all.back().Contains(shared)) continue;
        throw base::InputError(fmt::format("--weights \"{}\"", line),
                               fmt::format("frame {} is in another one too", shared));
      }
    }
  }
  if (all.empty()) {
    throw base::InputError("--weights", "got none, expected the frames whose forces are known",
                           kExample);
  }
  return all;
}

std::vector<std::filesystem::path> WeightsFiles(const std::vector<std::string>& specs) {
  std::vector<std::filesystem::path> files;
  std::copy_if(specs.begin(), specs.end(), std::back_inserter(files), IsFile);
  return files;
}

}  // namespace softforce::pipeline
