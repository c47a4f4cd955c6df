#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace softforce::testing {

struct ProgramResult {
  int exit_code = -1;
  std::string output;  // standard output
  std::string errors;  // standard error
};

// Runs `softforce` with the given arguments.
ProgramResult RunProgram(const std::string& arguments);

// Runs any command of the shell.
ProgramResult RunCommand(const std::string& command);

// A folder of its own for one test, empty at the start.
std::filesystem::path FreshFolder(const std::string& name);

// A copy of the shipped recording that a test may spoil.
std::filesystem::path CopyOfDemo(const std::string& name);

std::string ReadText(const std::filesystem::path& file);
void WriteText(const std::filesystem::path& file, const std::string& text);

// Replaces the first `from` in a file by `to`; fails the test if it is not there.
void Edit(const std::filesystem::path& file, const std::string& from, const std::string& to);

// The rows of a CSV file as maps from column to cell.
std::vector<std::map<std::string, std::string>> ReadTable(const std::filesystem::path& file);

}  // namespace softforce::testing
