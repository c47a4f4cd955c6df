#include <fmt/format.h>

#include <memory>

#include "commands/commands.h"
#include "commands/stop.h"
#include "softforce/pipeline/simulate.h"

namespace softforce::apps {
namespace {

struct SimulateArguments {
  std::string scene;
  std::string out;
};

int Simulate(const SimulateArguments& arguments) {
  pipeline::SimulateOptions options;
  options.out = arguments.out;
  options.stop = StopOnSignal();
  const pipeline::SimulateReport report = pipeline::Simulate(arguments.scene, options);
  fmt::print("{}", report.FullReport());
  return report.stopped ? 1 : 0;
}

}  // namespace

Command AddSimulate(CLI::App* program) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* app = program->add_subcommand(
      "simulate", "Make a synthetic recording with truth: direct FEM, rendered video, noise");
  app->add_option("scene", arguments->scene,
                  "Scene file (scene.yaml); its section 'simulation' says what happens")
      ->required();
  app->add_option("--out", arguments->out, "Folder for the recording")->required();
  return {app, [arguments] { return Simulate(*arguments); }};
}

}  // namespace softforce::apps
