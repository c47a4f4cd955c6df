#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/element_kernel.h"
#include "softforce/fem/body.h"

namespace softforce::fem {

// Gradients of the shape functions at the integration points of every cell, in the body at rest:
// one point for 4-node cells, the four-point rule of degree 2 for 10-node cells.
class Elements {
 public:
  Elements(const mesh::TetMesh& mesh, const std::vector<Material>& materials);
  explicit Elements(const Body& body) : Elements(body.mesh, body.materials) {}

  int num_elements() const { return static_cast<int>(nodes_.cols()); }
  int nodes_per_element() const { return static_cast<int>(nodes_.rows()); }
  int node(int element, int local) const { return nodes_(local, element); }

  // Sum of the elastic energies (J) and, added to `forces` (3×N, N), the internal forces. Returns
  // infinity, with `forces` unfinished, if the law has no value at some point: the cell is turned
  // inside out.
  double EnergyAndForces(const Eigen::Matrix3Xd& u, Eigen::Matrix3Xd* forces) const;

  // The first element that is inside out (J ≤ 0) at an integration point, −1 if none is. The
  // neo-Hookean laws never let that happen; the others may.
  int InvertedElement(const Eigen::Matrix3Xd& u) const;

  // Mean of an element's corners when the nodes stand at `x`, m.
  Eigen::Vector3d Centre(int element, const Eigen::Matrix3Xd& x) const;

  // The stiffness of one cell, symmetric, 3n×3n with index 3·local + component, N/m.
  template <int kNodes>
  void Stiffness(int element, const Eigen::Matrix3Xd& u,
                 Eigen::Matrix<double, 3 * kNodes, 3 * kNodes>* K) const;

  // Σ over cells, J.
  double ShearModulusTimesVolume() const;

  // Σ over cells of volume · shape function: the volume that hangs on each node, m³.
  Eigen::VectorXd NodalVolumes(int num_nodes) const;

 private:
  // kLanes elements of one law, the last ones perhaps missing (−1).
  struct Batch {
    ElementKernel kernel;
    std::array<int, kLanes> elements;
    std::array<double, kLanes> mu, lambda, kappa;  // Pa
    size_t first_gradient, first_weight;           // in gradients_ and weights_
  };
  struct Place {
    size_t batch;
    int lane;
  };

  void MakeBatches();
  void FillBatch(const Batch& batch, const Eigen::Matrix3Xd& X);
  double EnergyAndForcesOneByOne(const Batch& batch, const Eigen::Matrix3Xd& u,
                                 Eigen::Matrix3Xd* forces) const;

  int num_points() const { return nodes_.rows() == 10 ? 4 : 1; }
  // A column per node of one element, whose number may be known to the compiler.
  template <int kNodes>
  using NodalMatrix = Eigen::Matrix<double, 3, kNodes>;
  // ∂shape/∂X, 1/m.
  template <int kNodes>
  NodalMatrix<kNodes> Gradients(int element, int point) const;
  double Weight(int element, int point) const {  // m³
    const Place& at = place_of_[element];
    return weights_[batches_[at.batch].first_weight + point * kLanes + at.lane];
  }
  template <int kNodes>
  NodalMatrix<kNodes> NodalValues(int element, const Eigen::Matrix3Xd& field) const;

  Eigen::MatrixXi nodes_;
  std::vector<Material> material_of_;  // per element
  std::vector<Batch> batches_;
  std::vector<Place> place_of_;    // per element
  std::vector<double> gradients_;  // [batch][point][local][xyz][lane], 1/m
  std::vector<double> weights_;    // [batch][point][lane], m³
};

}  // namespace softforce::fem
