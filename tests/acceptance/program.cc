#include "acceptance/program.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>

namespace softforce::testing {

std::filesystem::path FreshFolder(const std::string& name) {
  // One place per build, so that two builds can be tested at once.
  const size_t build = std::hash<std::string>()(SOFTFORCE_PROGRAM);
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) /
                                       fmt::format("softforce_acceptance_{:x}", build) / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

ProgramResult RunCommand(const std::string& command) {
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = fmt::format("streams_{}_{}", test->test_suite_name(), test->name());
  for (char& c : name) c = c == '/' ? '_' : c;
  const std::filesystem::path folder = FreshFolder(name);
  const int status = std::system(
      fmt::format("{} > '{}/out' 2> '{}/err'", command, folder.string(), folder.string()).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadText(folder / "out"),
          ReadText(folder / "err")};
}

ProgramResult RunProgram(const std::string& arguments) {
  return RunCommand(fmt::format("'{}' {}", SOFTFORCE_PROGRAM, arguments));
}

std::filesystem::path CopyOfDemo(const std::string& name) {
  const std::filesystem::path folder = FreshFolder(name);
  std::filesystem::copy(std::filesystem::path(SOFTFORCE_SOURCE_DIR) / "datasets/sheet_two_weights",
                        folder);
  return folder;
}

std::string ReadText(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void WriteText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

void Edit(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  std::string text = ReadText(file);
  const size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << file << " has no \"" << from << '"';
  WriteText(file, text.replace(at, from.size(), to));
}

std::vector<std::map<std::string, std::string>> ReadTable(const std::filesystem::path& file) {
  const auto cells = [](const std::string& line) {
    std::vector<std::string> row;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) row.push_back(cell);
    return row;
  };
  std::istringstream stream(ReadText(file));
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = cells(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> row = cells(line);
    std::map<std::string, std::string> by_name;
    for (size_t i = 0; i < header.size(); ++i) by_name[header[i]] = i < row.size() ? row[i] : "";
    rows.push_back(by_name);
  }
  return rows;
}

}  // namespace softforce::testing
