#include <fmt/format.h>

#include <memory>

#include "commands/camera_sources.h"
#include "commands/commands.h"
#include "commands/stop.h"
#include "softforce/pipeline/render.h"

namespace softforce::apps {
namespace {

struct RenderArguments {
  std::string results, scene, out;
  std::vector<std::string> cameras;
  std::string draw = "all";
  pipeline::RenderOptions options;
};

int Render(RenderArguments* arguments) {
  pipeline::RenderOptions& options = arguments->options;
  options.scene = arguments->scene;
  options.out = arguments->out;
  options.layers = pipeline::ParseOverlayLayers(arguments->draw, "--draw");
  options.sources = ParseCameraSources(arguments->cameras);
  options.stop = StopOnSignal();
  fmt::print("{}", pipeline::Render(arguments->results, options).FullReport());
  return 0;
}

}  // namespace

Command AddRender(CLI::App* program) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* app =
      program->add_subcommand("render", "Draw the overlay of a finished run again from its files");
  app->add_option("results", arguments->results, "Folder with the results of a run")->required();
  app->add_option("-o,--out", arguments->out, "The video (.mp4); default RESULTS/overlay.mp4");
  app->add_option("--scene", arguments->scene,
                  "Scene file, if it is not where it was when the run was made");
  app->add_option("--camera", arguments->cameras,
                  "NAME=FILE: video of a camera, if it is not where it was; may be repeated")
      ->allow_extra_args(false);
  app->add_option("--draw", arguments->draw,
                  "What the overlay shows: all, none, or names separated by commas, from " +
                      pipeline::OverlayLayerNames() + "; with a minus sign: all but these")
      ->capture_default_str();
  app->add_option("--overlay-width", arguments->options.overlay_width, "Width of the video, px")
      ->capture_default_str();
  app->add_option("--threads", arguments->options.threads,
                  "Threads that share the work; 0: as many as there are cores")
      ->capture_default_str();
  return {app, [arguments] { return Render(arguments.get()); }};
}

}  // namespace softforce::apps
