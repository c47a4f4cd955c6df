#include "fem/tangent.h"

#include <algorithm>
#include <cmath>

#include "fem/cable_path.h"
#include "fem/chamber_volume.h"

namespace softforce::fem {

TangentAssembler::TangentAssembler(const Body& body, const Elements& elements) : body_(body) {
  free_index_.assign(body.mesh.num_nodes(), 0);
  for (const int node : body.fixed_nodes) free_index_[node] = -1;
  for (int& index : free_index_) {
    if (index == 0) index = num_free_++;
  }

  // Sets of free nodes that are all tied to each other.
  std::vector<std::vector<int>> cliques;
  const auto add_clique = [&](std::vector<int> nodes) {
    for (int& node : nodes) node = free_index_[node];
    nodes.erase(std::remove(nodes.begin(), nodes.end(), -1), nodes.end());
    cliques.push_back(std::move(nodes));
  };
  const int n = elements.nodes_per_element();
  for (int e = 0; e < elements.num_elements(); ++e) {
    std::vector<int> nodes(n);
    for (int i = 0; i < n; ++i) nodes[i] = elements.node(e, i);
    add_clique(std::move(nodes));
  }
  for (const Cable& cable : body.cables) add_clique(CableNodes(cable));
  MakePattern(cliques);
  FindHeldEntries();

  for (int e = 0; e < elements.num_elements(); ++e) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i <= j; ++i) {
        const int a = free_index_[elements.node(e, i)];
        const int b = free_index_[elements.node(e, j)];
        element_positions_.push_back(
            a < 0 || b < 0 ? -1 : BlockPosition(std::max(a, b), std::min(a, b)));
      }
    }
  }
}

void TangentAssembler::MakePattern(const std::vector<std::vector<int>>& cliques) {
  std::vector<std::vector<int>> rows(num_free_);
  for (const std::vector<int>& clique : cliques) {
    for (const int column : clique) {
      for (const int row : clique) {
        if (row >= column) rows[column].push_back(row);
      }
    }
  }
  block_start_ = {0};
  matrix_.column_start = {0};
  for (std::vector<int>& column : rows) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    block_row_.insert(block_row_.end(), column.begin(), column.end());
    block_start_.push_back(static_cast<int>(block_row_.size()));
    for (int c = 0; c < 3; ++c) {  // the diagonal block's own upper part is left out
      for (const int row : column) {
        const int first = row == column.front() ? c : 0;
        for (int r = first; r < 3; ++r) matrix_.row.push_back(3 * row + r);
      }
      matrix_.column_start.push_back(static_cast<int>(matrix_.row.size()));
    }
  }
  matrix_.value.resize(matrix_.row.size());
}

void TangentAssembler::FindHeldEntries() {
  std::vector<char> is_held(matrix_.size(), 0);
  for (const FixedComponent& component : body_.fixed_components) {
    const int node = free_index_[component.node];
    if (node >= 0) is_held[3 * node + component.axis] = 1;
  }
  for (int column = 0; column < matrix_.size(); ++column) {
    if (is_held[column]) held_.push_back(column);
    for (int k = matrix_.column_start[column]; k < matrix_.column_start[column + 1]; ++k) {
      const int row = matrix_.row[k];
      if (!is_held[row] && !is_held[column]) continue;
      (row == column ? held_diagonal_ : held_entries_).push_back(k);
    }
  }
}

void TangentAssembler::HoldComponents() {
  if (held_.empty()) return;
  double mean = 0;
  for (int column = 0; column < matrix_.size(); ++column) {
    mean += std::abs(matrix_.value[matrix_.column_start[column]]) / matrix_.size();
  }
  for (const size_t k : held_entries_) matrix_.value[k] = 0;
  for (const size_t k : held_diagonal_) matrix_.value[k] = mean;
}

int TangentAssembler::BlockPosition(int row_node, int column_node) const {
  const auto first = block_row_.begin() + block_start_[column_node];
  const auto last = block_row_.begin() + block_start_[column_node + 1];
  return static_cast<int>(std::lower_bound(first, last, row_node) - first);
}

void TangentAssembler::AddBlock(int position, int column_node, const Eigen::Matrix3d& block) {
  for (int c = 0; c < 3; ++c) {
    double* column = matrix_.value.data() + matrix_.column_start[3 * column_node + c];
    if (position == 0) {
      for (int r = c; r < 3; ++r) column[r - c] += block(r, c);
    } else {
      double* at = column + (3 - c) + 3 * (position - 1);
      for (int r = 0; r < 3; ++r) at[r] += block(r, c);
    }
  }
}

void TangentAssembler::AddSymmetric(int node_i, int node_j, const Eigen::Matrix3d& K_ij) {
  const int a = free_index_[node_i];
  const int b = free_index_[node_j];
  if (a < 0 || b < 0 || a < b) return;  // the transpose comes with (j, i)
  AddBlock(BlockPosition(a, b), b, K_ij);
}

template <int kNodes>
void TangentAssembler::AddElements(const Elements& elements, const Eigen::Matrix3Xd& u) {
  Eigen::Matrix<double, 3 * kNodes, 3 * kNodes> K;
  const int* position = element_positions_.data();
  for (int e = 0; e < elements.num_elements(); ++e) {
    elements.Stiffness<kNodes>(e, u, &K);
    for (int j = 0; j < kNodes; ++j) {
      const int b = free_index_[elements.node(e, j)];
      for (int i = 0; i <= j; ++i, ++position) {
        if (*position < 0) continue;
        const int a = free_index_[elements.node(e, i)];
        if (a >= b) {
          AddBlock(*position, b, K.template block<3, 3>(3 * i, 3 * j));
        } else {
          AddBlock(*position, a, K.template block<3, 3>(3 * j, 3 * i));
        }
      }
    }
  }
}

void TangentAssembler::Assemble(const Elements& elements, const Eigen::Matrix3Xd& u,
                                const Eigen::VectorXd& tension,
                                const std::vector<double>& pressures) {
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
  if (elements.nodes_per_element() == 10) {
    AddElements<10>(elements, u);
  } else {
    AddElements<4>(elements, u);
  }
  const Eigen::Matrix3Xd x = body_.mesh.nodes + u;
  const auto add = [&](int i, int j, const Eigen::Matrix3d& K_ij) { AddSymmetric(i, j, K_ij); };
  for (size_t c = 0; c < body_.cables.size(); ++c) {
    const double t = tension(static_cast<int>(c));
    if (t != 0) ForEachCableStiffness(body_.cables[c], x, t, add);
  }
  for (size_t k = 0; k < body_.chambers.size(); ++k) {
    if (pressures[k] == 0) continue;
    ForEachChamberVolumeCurvature(body_.chambers[k], x, -pressures[k], add);
  }
  HoldComponents();
}

}  // namespace softforce::fem
