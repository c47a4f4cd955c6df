#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace softforce::apps {

// A subcommand: its options are declared on construction, `run` does the work and returns the exit
// code.
struct Command {
  CLI::App* app;
  std::function<int()> run;
};

Command AddCalibrate(CLI::App* program);
Command AddDesign(CLI::App* program);
Command AddIdentify(CLI::App* program);
Command AddMesh(CLI::App* program);
Command AddRecord(CLI::App* program);
Command AddRegister(CLI::App* program);
Command AddRender(CLI::App* program);
Command AddRig(CLI::App* program);
Command AddRun(CLI::App* program);
Command AddSimulate(CLI::App* program);
Command AddTarget(CLI::App* program);
Command AddValidate(CLI::App* program);

}  // namespace softforce::apps
