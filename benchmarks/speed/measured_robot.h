// The robot of meshes/ to measure on: four legs, two cables shortened by 8 mm.
#pragma once

#include <algorithm>
#include <limits>

#include "speed/measured_sheet.h"

namespace softforce::benchmarks {

struct Robot {
  fem::Body body;
  fem::Actuation actuation;
  double yardstick = std::numeric_limits<double>::infinity();  // s of processor time

  explicit Robot(int order) {
    body.mesh = mesh::ReadMesh(SOFTFORCE_SOURCE_DIR "/meshes/robot.msh", 1e-3);
    if (order == 2) body.mesh = mesh::RaiseOrder(body.mesh);
    body.materials.assign(body.mesh.region_names.size(),
                          {fem::MaterialModel::kNeoHookean, 220e3, 0.45});
    for (int n = 0; n < body.mesh.num_nodes(); ++n) {
      if (body.mesh.nodes(2, n) < 1e-6) body.fixed_nodes.push_back(n);
    }
    const double out = 44.067e-3, up = 54.272e-3;  // m
    body.cables.push_back({"x", {testing::PointOf(body, {out, 0, up})}, {5e-3, 0, 6e-3}});
    body.cables.push_back({"y", {testing::PointOf(body, {0, out, up})}, {0, 5e-3, 6e-3}});
    const fem::CableCommand shortened{fem::CableInput::kDisplacement, 8e-3};
    actuation.cables = {shortened, shortened};

    Tangent tangent(body);
    for (int repetition = 0; repetition < 8; ++repetition) {
      const double begin = Seconds(CLOCK_PROCESS_CPUTIME_ID);
      tangent.cholesky.Factorise(tangent.assembler.matrix());
      yardstick = std::min(yardstick, Seconds(CLOCK_PROCESS_CPUTIME_ID) - begin);
    }
  }
};

}  // namespace softforce::benchmarks
