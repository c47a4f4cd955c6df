#include <fmt/format.h>

#include <memory>

#include "commands/commands.h"
#include "commands/stop.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"
#include "softforce/pipeline/design.h"

namespace softforce::apps {
namespace {

struct DesignArguments {
  std::string scene;
  std::string spacing, load, noise;
  std::string criterion = "location";
  pipeline::DesignOptions options;
};

double Quantity(const std::string& text, base::Dimension dimension, const std::string& option) {
  return base::ParseQuantity(text, dimension, 1, option).front();
}

design::Criterion ParseCriterion(const std::string& name) {
  if (name == "location") return design::Criterion::kLocation;
  if (name == "d-optimal") return design::Criterion::kDOptimal;
  throw base::InputError("--criterion",
                         fmt::format("got \"{}\", expected location or d-optimal", name));
}

int Design(DesignArguments* arguments) {
  pipeline::DesignOptions& options = arguments->options;
  if (!arguments->spacing.empty()) {
    options.spacing = Quantity(arguments->spacing, base::Dimension::kLength, "--spacing");
  }
  if (!arguments->load.empty()) {
    options.load = Quantity(arguments->load, base::Dimension::kForce, "--load");
  }
  if (!arguments->noise.empty()) {
    options.noise = Quantity(arguments->noise, base::Dimension::kLength, "--noise");
  }
  options.criterion = ParseCriterion(arguments->criterion);
  options.stop = StopOnSignal();
  const pipeline::DesignReport report = pipeline::Design(arguments->scene, options);
  fmt::print("{}", report.FullReport());
  return report.usable() ? 0 : 1;
}

}  // namespace

Command AddDesign(CLI::App* program) {
  auto arguments = std::make_shared<DesignArguments>();
  pipeline::DesignOptions& options = arguments->options;
  CLI::App* app = program->add_subcommand(
      "design", "Choose where markers tell most about forces and their places");
  app->add_option("scene", arguments->scene, "Scene file (scene.yaml)")->required();
  app->add_option("--out", options.out, "Folder for the results")->capture_default_str();
  app->add_option("--count", options.count, "Markers to place; 0: as many as the scene has")
      ->capture_default_str();
  app->add_option(
      "--on", options.on,
      "Where markers may sit: a surface group of the mesh, or a selector as of softforce "
      "mesh --group, such as z-max; default: all that two cameras see");
  app->add_option("--loads", options.loads,
                  "Where forces may act, likewise; default: the faces that the scene's candidates "
                  "are on");
  app->add_option("--load", arguments->load,
                  fmt::format("Size of the forces to be found, default \"{:g} N\"", options.load));
  app->add_option("--spacing", arguments->spacing,
                  "Distance between places that markers may have, as \"10 mm\"; default: for some "
                  "300 places, at least 1.5 marker sizes");
  app->add_option("--noise", arguments->noise,
                  "Noise of each coordinate of a marker, as \"0.1 mm\" (standard deviation), "
                  "without regard to cameras; default: as the cameras see them");
  app->add_option("--pixel-noise", options.sight.pixel_sd,
                  "Noise of a marker's centre in a picture, px (standard deviation)")
      ->capture_default_str();
  app->add_option("--common-model-error", options.common_model_error,
                  "As for run: model error that shifts or turns all markers together, as a share "
                  "of the largest marker displacement (standard deviation)")
      ->capture_default_str();
  app->add_option("--local-model-error", options.local_model_error,
                  "As for run: model error of each marker by itself, as a share of the largest "
                  "marker displacement (standard deviation)")
      ->capture_default_str();
  app->add_option("--criterion", arguments->criterion,
                  "location: the places of forces as well as possible, on geometric average; "
                  "d-optimal: forces and places together, by the determinant of their covariance")
      ->capture_default_str();
  app->add_option("--random", options.random_layouts, "Random layouts to compare with")
      ->capture_default_str();
  app->add_option("--seed", options.seed, "Of the random layouts")->capture_default_str();
  app->add_option("--registration-frames", options.registration_frames,
                  "Frames searched for base fiducials to find where the cameras stand")
      ->capture_default_str();
  return {app, [arguments] { return Design(arguments.get()); }};
}

}  // namespace softforce::apps
