#pragma once

#include <Eigen/Core>
#include <vector>

namespace softforce::allocation {

struct Assignment {
  std::vector<int> column_of_row;
  double cost = 0;
};

// Gives each row of `cost` (rows ≤ columns, finite) a column of its own so that the sum is least:
// the Hungarian method with potentials and shortest augmenting paths, O(rows² · columns).
Assignment AssignRows(const Eigen::MatrixXd& cost);

}  // namespace softforce::allocation
