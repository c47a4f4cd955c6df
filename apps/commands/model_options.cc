#include "commands/model_options.h"

#include <fmt/format.h>

#include "softforce/base/input_error.h"

namespace softforce::apps {

void AddModelOptions(CLI::App* app, std::string* correct_mesh,
                     estimation::EstimatorOptions* estimator) {
  app->add_option("--common-model-error", estimator->common_model_error,
                  "Model error that shifts or turns all markers together, as a share of the "
                  "largest marker displacement (standard deviation)")
      ->capture_default_str();
  app->add_option("--local-model-error", estimator->local_model_error,
                  "Model error of each marker by itself, as a share of the largest marker "
                  "displacement (standard deviation)")
      ->capture_default_str();
  app->add_option(
         "--correct-mesh", *correct_mesh,
         "Correct the mesh's own error as far as the once refined mesh shows it (refined), "
         "or to the estimated limit (converged); model errors shrink with it")
      ->option_text("none|refined|converged [none]");
}

pipeline::MeshAim ParseMeshAim(const std::string& name) {
  using pipeline::MeshAim;
  for (const MeshAim aim : {MeshAim::kGiven, MeshAim::kRefined, MeshAim::kConverged}) {
    if (name == pipeline::Name(aim)) return aim;
  }
  throw base::InputError("--correct-mesh",
                         fmt::format("got \"{}\", expected none, refined or converged", name),
                         "Write for example: --correct-mesh refined");
}

}  // namespace softforce::apps
