#include "fem/elements.h"

#include <Eigen/LU>
#include <array>
#include <limits>
#include <map>

namespace softforce::fem {
namespace {

// Barycentric coordinates of the four-point rule, exact for quadratic polynomials (weights 1/4
// each).
constexpr double kNear = 0.58541019662496852;
constexpr double kFar = 0.13819660112501052;

// Derivatives of the shape functions at barycentric coordinates b. Derivatives are by
// b1, b2, b3 (b0 = 1 − b1 − b2 − b3), a column per node.
Eigen::Matrix3Xd ShapeDerivatives(int nodes, const Eigen::Vector4d& b) {
  Eigen::Matrix<double, 3, 4> db;  // of b0 … b3 by b1 b2 b3
  db << -1, 1, 0, 0, -1, 0, 1, 0, -1, 0, 0, 1;
  Eigen::Matrix3Xd d(3, nodes);
  if (nodes == 4) {
    d = db;
    return d;
  }
  for (int i = 0; i < 4; ++i) d.col(i) = (4 * b(i) - 1) * db.col(i);
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = mesh::kEdges[e];
    d.col(4 + e) = 4 * (b(i) * db.col(j) + b(j) * db.col(i));
  }
  return d;
}

Eigen::VectorXd ShapeValues(int nodes, const Eigen::Vector4d& b) {
  if (nodes == 4) return b;
  Eigen::VectorXd value(nodes);
  for (int i = 0; i < 4; ++i) value(i) = b(i) * (2 * b(i) - 1);
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = mesh::kEdges[e];
    value(4 + e) = 4 * b(i) * b(j);
  }
  return value;
}

std::vector<Eigen::Vector4d> IntegrationPoints(int nodes) {
  if (nodes == 4) return {Eigen::Vector4d::Constant(0.25)};
  std::vector<Eigen::Vector4d> points(4, Eigen::Vector4d::Constant(kFar));
  for (int i = 0; i < 4; ++i) points[i](i) = kNear;
  return points;
}

}  // namespace

Elements::Elements(const mesh::TetMesh& mesh, const std::vector<Material>& materials)
    : nodes_(mesh.elements) {
  material_of_.reserve(num_elements());
  for (int e = 0; e < num_elements(); ++e) {
    material_of_.push_back(materials[mesh.region[e]]);
  }
  MakeBatches();
  for (const Batch& batch : batches_) FillBatch(batch, mesh.nodes);
}

void Elements::MakeBatches() {
  std::map<MaterialModel, std::vector<int>> elements_of;
  for (int e = 0; e < num_elements(); ++e) elements_of[material_of_[e].model].push_back(e);
  place_of_.resize(num_elements());
  const size_t gradients_per_batch = size_t{3} * kLanes * nodes_per_element() * num_points();
  const size_t weights_per_batch = size_t{kLanes} * num_points();
  for (const auto& [model, elements] : elements_of) {
    for (size_t first = 0; first < elements.size(); first += kLanes) {
      Batch batch{KernelFor(model, nodes_per_element()),
                  {},
                  {},
                  {},
                  {},
                  batches_.size() * gradients_per_batch,
                  batches_.size() * weights_per_batch};
      for (int lane = 0; lane < kLanes; ++lane) {
        const bool is_there = first + lane < elements.size();
        // Missing elements compute what the first one does, with weight 0.
        const int e = elements[is_there ? first + lane : first];
        batch.elements[lane] = is_there ? e : -1;
        batch.mu[lane] = material_of_[e].mu();
        batch.lambda[lane] = material_of_[e].lambda();
        batch.kappa[lane] = material_of_[e].kappa();
        if (is_there) place_of_[e] = {batches_.size(), lane};
      }
      batches_.push_back(batch);
    }
  }
  gradients_.resize(batches_.size() * gradients_per_batch);
  weights_.resize(batches_.size() * weights_per_batch);
}

void Elements::FillBatch(const Batch& batch, const Eigen::Matrix3Xd& X) {
  const int n = nodes_per_element();
  const std::vector<Eigen::Vector4d> points = IntegrationPoints(n);
  for (int lane = 0; lane < kLanes; ++lane) {
    const bool is_there = batch.elements[lane] >= 0;
    const Eigen::Matrix3Xd X_e =
        NodalValues<Eigen::Dynamic>(batch.elements[is_there ? lane : 0], X);
    for (int p = 0; p < num_points(); ++p) {
      const Eigen::Matrix3Xd d = ShapeDerivatives(n, points[p]);
      const Eigen::Matrix3d jacobian = X_e * d.transpose();  // dX / d(b1, b2, b3)
      const Eigen::Matrix3Xd g = jacobian.inverse().transpose() * d;
      for (int k = 0; k < 3 * n; ++k) {
        gradients_[batch.first_gradient + (size_t{3} * n * p + k) * kLanes + lane] = g.data()[k];
      }
      weights_[batch.first_weight + size_t{kLanes} * p + lane] =
          is_there ? jacobian.determinant() / 6 / num_points() : 0;
    }
  }
}

template <int kNodes>
Elements::NodalMatrix<kNodes> Elements::Gradients(int element, int point) const {
  const Place& at = place_of_[element];
  const double* first = gradients_.data() + batches_[at.batch].first_gradient +
                        size_t{3} * nodes_per_element() * point * kLanes + at.lane;
  return Eigen::Map<const NodalMatrix<kNodes>, 0, Eigen::Stride<3 * kLanes, kLanes>>(
      first, 3, nodes_per_element());
}

template <int kNodes>
Elements::NodalMatrix<kNodes> Elements::NodalValues(int element,
                                                    const Eigen::Matrix3Xd& field) const {
  NodalMatrix<kNodes> values(3, nodes_per_element());
  for (int i = 0; i < values.cols(); ++i) values.col(i) = field.col(nodes_(i, element));
  return values;
}

double Elements::EnergyAndForces(const Eigen::Matrix3Xd& u, Eigen::Matrix3Xd* forces) const {
  const int n = nodes_per_element();
  alignas(64) std::array<double, 30 * kLanes> u_batch, f_batch;
  double energy = 0;
  for (const Batch& batch : batches_) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const int e = batch.elements[lane] >= 0 ? batch.elements[lane] : batch.elements[0];
      for (int i = 0; i < n; ++i) {
        const double* from = u.data() + 3 * nodes_(i, e);
        for (int k = 0; k < 3; ++k) u_batch[(3 * i + k) * kLanes + lane] = from[k];
      }
    }
    const BatchEnergy result = batch.kernel(
        {gradients_.data() + batch.first_gradient, weights_.data() + batch.first_weight,
         batch.mu.data(), batch.lambda.data(), batch.kappa.data(), u_batch.data(), f_batch.data()});
    if (result.status == BatchEnergy::Status::kInvalid) {
      return std::numeric_limits<double>::infinity();
    }
    if (result.status == BatchEnergy::Status::kHard) {
      energy += EnergyAndForcesOneByOne(batch, u, forces);
      continue;
    }
    energy += result.energy;
    for (int lane = 0; lane < kLanes && batch.elements[lane] >= 0; ++lane) {
      for (int i = 0; i < n; ++i) {
        double* to = forces->data() + 3 * nodes_(i, batch.elements[lane]);
        for (int k = 0; k < 3; ++k) to[k] += f_batch[(3 * i + k) * kLanes + lane];
      }
    }
  }
  return energy;
}

double Elements::EnergyAndForcesOneByOne(const Batch& batch, const Eigen::Matrix3Xd& u,
                                         Eigen::Matrix3Xd* forces) const {
  double energy = 0;
  for (const int e : batch.elements) {
    if (e < 0) continue;
    const Eigen::Matrix3Xd u_e = NodalValues<Eigen::Dynamic>(e, u);
    for (int p = 0; p < num_points(); ++p) {
      const Eigen::Matrix3Xd g = Gradients<Eigen::Dynamic>(e, p);
      const MaterialResponse response =
          Evaluate(material_of_[e], Eigen::Matrix3d::Identity() + u_e * g.transpose(), false);
      if (!response.valid) return std::numeric_limits<double>::infinity();
      energy += Weight(e, p) * response.energy;
      const Eigen::Matrix3Xd f_e = (Weight(e, p) * response.P) * g;
      for (int i = 0; i < f_e.cols(); ++i) forces->col(nodes_(i, e)) += f_e.col(i);
    }
  }
  return energy;
}

int Elements::InvertedElement(const Eigen::Matrix3Xd& u) const {
  for (int e = 0; e < num_elements(); ++e) {
    if (HasBarrier(material_of_[e].model)) continue;
    const Eigen::Matrix3Xd u_e = NodalValues<Eigen::Dynamic>(e, u);
    for (int p = 0; p < num_points(); ++p) {
      const Eigen::Matrix3d F =
          Eigen::Matrix3d::Identity() + u_e * Gradients<Eigen::Dynamic>(e, p).transpose();
      if (!(F.determinant() > 0)) return e;
    }
  }
  return -1;
}

Eigen::Vector3d Elements::Centre(int element, const Eigen::Matrix3Xd& x) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) sum += x.col(nodes_(i, element));
  return sum / 4;
}

template <int kNodes>
void Elements::Stiffness(int element, const Eigen::Matrix3Xd& u,
                         Eigen::Matrix<double, 3 * kNodes, 3 * kNodes>* K) const {
  const Eigen::Matrix<double, 3, kNodes> u_e = NodalValues<kNodes>(element, u);
  K->setZero();
  for (int p = 0; p < num_points(); ++p) {
    const Eigen::Matrix<double, 3, kNodes> g = Gradients<kNodes>(element, p);
    const MaterialResponse response =
        Evaluate(material_of_[element], Eigen::Matrix3d::Identity() + u_e * g.transpose(), true);
    const Matrix9d A = Weight(element, p) * response.dPdF;
    for (int b = 0; b < kNodes; ++b) {
      const Eigen::Matrix<double, 9, 3> A_b = A.middleCols<3>(0) * g(0, b) +
                                              A.middleCols<3>(3) * g(1, b) +
                                              A.middleCols<3>(6) * g(2, b);
      for (int a = 0; a <= b; ++a) {
        K->template block<3, 3>(3 * a, 3 * b) += g(0, a) * A_b.topRows<3>() +
                                                 g(1, a) * A_b.middleRows<3>(3) +
                                                 g(2, a) * A_b.bottomRows<3>();
      }
    }
  }
  K->template triangularView<Eigen::StrictlyLower>() = K->transpose();
}

template void Elements::Stiffness<4>(int, const Eigen::Matrix3Xd&,
                                     Eigen::Matrix<double, 12, 12>*) const;
template void Elements::Stiffness<10>(int, const Eigen::Matrix3Xd&,
                                      Eigen::Matrix<double, 30, 30>*) const;

double Elements::ShearModulusTimesVolume() const {
  double sum = 0;
  for (int e = 0; e < num_elements(); ++e) {
    for (int p = 0; p < num_points(); ++p) {
      sum += material_of_[e].mu() * Weight(e, p);
    }
  }
  return sum;
}

Eigen::VectorXd Elements::NodalVolumes(int num_nodes) const {
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(num_nodes);
  const std::vector<Eigen::Vector4d> points = IntegrationPoints(nodes_per_element());
  for (int e = 0; e < num_elements(); ++e) {
    for (int p = 0; p < num_points(); ++p) {
      const Eigen::VectorXd share = ShapeValues(nodes_per_element(), points[p]);
      for (int i = 0; i < nodes_per_element(); ++i) {
        volumes(nodes_(i, e)) += Weight(e, p) * share(i);
      }
    }
  }
  return volumes;
}

}  // namespace softforce::fem
