#include <fmt/format.h>
#include <glog/logging.h>

#include <exception>
#include <vector>

#include "commands/commands.h"
#include "softforce/base/input_error.h"
#include "softforce/base/version.h"

namespace {

constexpr int kNotUsable = 1;
constexpr int kBadInput = 2;

int RunProgram(int argc, char** argv) {
  CLI::App program{"softforce: external forces on soft bodies, seen through cameras"};
  program.set_version_flag("--version", std::string("softforce ") + softforce::base::kVersion);
  program.require_subcommand(1);
  const std::vector<softforce::apps::Command> commands{
      softforce::apps::AddRun(&program),      softforce::apps::AddCalibrate(&program),
      softforce::apps::AddDesign(&program),   softforce::apps::AddIdentify(&program),
      softforce::apps::AddMesh(&program),     softforce::apps::AddRecord(&program),
      softforce::apps::AddRegister(&program), softforce::apps::AddRender(&program),
      softforce::apps::AddRig(&program),      softforce::apps::AddSimulate(&program),
      softforce::apps::AddTarget(&program),   softforce::apps::AddValidate(&program)};
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : kBadInput;
  }
  for (const softforce::apps::Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  return kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
  // Ceres logs what it could not solve; what that means for the user is in our own statuses.
  FLAGS_minloglevel = google::GLOG_FATAL;
  try {
    return RunProgram(argc, argv);
  } catch (const softforce::base::InputError& error) {
    fmt::print(stderr, "softforce: {}\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {  // out of memory, a broken library: not the user's input
    fmt::print(stderr, "softforce: unexpected: {}\n", error.what());
    return kNotUsable;
  }
}
