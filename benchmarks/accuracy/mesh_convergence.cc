// How far the mesh of a scene is from converged, level by level:
//
//   mesh_convergence scene.yaml [newtons on every candidate [growth of the local mesh]]
#include <fmt/format.h>

#include <cstdlib>

#include "softforce/base/input_error.h"
#include "softforce/pipeline/mesh_convergence.h"

int main(int argc, char** argv) {
  namespace pipeline = softforce::pipeline;
  if (argc < 2) {
    fmt::print(stderr, "mesh_convergence scene.yaml [newtons on every candidate]\n");
    return 2;
  }
  try {
    const softforce::scene::Scene scene = softforce::scene::LoadScene(argv[1]);
    pipeline::MeshConvergenceOptions options;
    if (argc > 2) options.working_load = std::atof(argv[2]);
    if (argc > 3) options.max_local_growth = std::atof(argv[3]);
    const pipeline::MeshConvergence result =
        pipeline::AssessMesh(scene, pipeline::BuildWorld(scene), options);
    fmt::print("{}\nLevels of local refinement ({:.2f} % extrapolated)\n", result.FullReport(),
               100 * result.uncertain);
    for (const pipeline::LocalMesh& local : result.local) {
      fmt::print(
          "  {:>8} cells  {:>8} degrees of freedom  {:+.2f} % left to once refined, {:+.2f} % to "
          "converged\n",
          local.mesh.num_elements(), 3 * local.mesh.num_nodes(), 100 * local.remaining.refined,
          100 * local.remaining.converged);
    }
  } catch (const softforce::base::InputError& error) {
    fmt::print(stderr, "mesh_convergence: {}\n", error.what());
    return 2;
  }
  return 0;
}
