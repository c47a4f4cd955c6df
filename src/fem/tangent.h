#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/elements.h"
#include "softforce/fem/body.h"

namespace softforce::fem {

// The lower triangle of the tangent on the free nodes, as compressed columns of scalars made of 3×3
// blocks. The pattern is fixed for a body: the cells, and the nodes that a cable ties together.
struct LowerBlocks {
  std::vector<int> column_start;  // per scalar column
  std::vector<int> row;           // scalar rows, ascending in each column
  std::vector<double> value;      // N/m

  int size() const { return static_cast<int>(column_start.size()) - 1; }
};

// Assembles tangents through a map, made once, from each pair of nodes of a cell to its block.
class TangentAssembler {
 public:
  TangentAssembler(const Body& body, const Elements& elements);

  // Number among the free nodes, or −1 for a fixed one.
  int free_index(int node) const { return free_index_[node]; }
  int num_free_nodes() const { return num_free_; }

  // Scalar rows and columns of components that are held at free nodes; the tangent is the identity
  // there, times its own mean diagonal.
  const std::vector<int>& held() const { return held_; }

  // K at displacement u, with the stiffness of the loads that follow the body: tensions turn with
  // their cables, pressures with the walls.
  void Assemble(const Elements& elements, const Eigen::Matrix3Xd& u, const Eigen::VectorXd& tension,
                const std::vector<double>& pressures);
  const LowerBlocks& matrix() const { return matrix_; }

 private:
  void FindHeldEntries();
  void HoldComponents();
  void MakePattern(const std::vector<std::vector<int>>& cliques);
  int BlockPosition(int row_node, int column_node) const;  // in free numbering
  void AddBlock(int position, int column_node, const Eigen::Matrix3d& block);
  void AddSymmetric(int node_i, int node_j, const Eigen::Matrix3d& K_ij);  // mesh numbering
  template <int kNodes>
  void AddElements(const Elements& elements, const Eigen::Matrix3Xd& u);

  const Body& body_;
  std::vector<int> free_index_;
  int num_free_ = 0;
  std::vector<int> held_;
  std::vector<int> block_start_,
      block_row_;  // block pattern: columns of free nodes, rows ascending
  std::vector<size_t> held_entries_, held_diagonal_;  // in matrix_.value, of held components
  std::vector<int> element_positions_;  // per cell and pair i ≤ j of its nodes; −1: a fixed node
  LowerBlocks matrix_;
};

}  // namespace softforce::fem
