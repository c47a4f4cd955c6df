#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/elements.h"
#include "fem/tangent.h"

namespace softforce::testing {

// K · direction (3×N, zero at fixed nodes) with K as it is assembled for a body: definite or not.
inline Eigen::Matrix3Xd TangentTimes(const fem::Body& body, const Eigen::Matrix3Xd& u,
                                     const Eigen::VectorXd& tension,
                                     const std::vector<double>& pressures,
                                     const Eigen::Matrix3Xd& direction) {
  const fem::Elements elements(body);
  fem::TangentAssembler assembler(body, elements);
  assembler.Assemble(elements, u, tension, pressures);
  std::vector<int> node_of(assembler.num_free_nodes());
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    if (assembler.free_index(node) >= 0) node_of[assembler.free_index(node)] = node;
  }
  const fem::LowerBlocks& K = assembler.matrix();
  Eigen::Matrix3Xd product = Eigen::Matrix3Xd::Zero(3, u.cols());
  for (int column = 0; column < K.size(); ++column) {
    for (int k = K.column_start[column]; k < K.column_start[column + 1]; ++k) {
      const int row = K.row[k];
      product(row % 3, node_of[row / 3]) += K.value[k] * direction(column % 3, node_of[column / 3]);
      if (row == column) continue;
      product(column % 3, node_of[column / 3]) += K.value[k] * direction(row % 3, node_of[row / 3]);
    }
  }
  return product;
}

}  // namespace softforce::testing
