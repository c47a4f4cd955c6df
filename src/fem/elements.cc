#include "fem/elements.h"

#include <Eigen/LU>
#include <limits>

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

template <int kNodes>
Eigen::Matrix3d DeformationGradient(const Eigen::Matrix<double, 3, kNodes>& u,
                                    const Eigen::Map<const Eigen::Matrix<double, 3, kNodes>>& g) {
  return Eigen::Matrix3d::Identity() + u * g.transpose();
}

}  // namespace

Elements::Elements(const Body& body) : nodes_(body.mesh.elements) {
  const int n = nodes_per_element();
  const std::vector<Eigen::Vector4d> points = IntegrationPoints(n);
  std::vector<Eigen::Matrix3Xd> derivatives;
  derivatives.reserve(points.size());
  for (const Eigen::Vector4d& b : points) derivatives.push_back(ShapeDerivatives(n, b));

  gradients_.reserve(size_t{3} * n * points.size() * num_elements());
  weights_.reserve(points.size() * num_elements());
  for (int e = 0; e < num_elements(); ++e) {
    Eigen::Matrix3Xd X(3, n);
    for (int i = 0; i < n; ++i) X.col(i) = body.mesh.nodes.col(nodes_(i, e));
    for (const Eigen::Matrix3Xd& d : derivatives) {
      const Eigen::Matrix3d jacobian = X * d.transpose();  // dX / d(b1, b2, b3)
      const Eigen::Matrix3Xd g = jacobian.inverse().transpose() * d;
      gradients_.insert(gradients_.end(), g.data(), g.data() + g.size());
      weights_.push_back(jacobian.determinant() / 6 / static_cast<double>(points.size()));
    }
    material_of_.push_back(body.materials[body.mesh.region[e]]);
  }
}

template <int kNodes>
double Elements::EnergyAndForcesOf(const Eigen::Matrix3Xd& u, Eigen::Matrix3Xd* forces) const {
  double energy = 0;
  Eigen::Matrix<double, 3, kNodes> u_e, f_e;
  for (int e = 0; e < num_elements(); ++e) {
    for (int i = 0; i < kNodes; ++i) u_e.col(i) = u.col(nodes_(i, e));
    f_e.setZero();
    for (int p = 0; p < num_points(); ++p) {
      const Eigen::Map<const Eigen::Matrix<double, 3, kNodes>> g(gradients(e, p));
      const MaterialResponse response =
          Evaluate(material_of_[e], DeformationGradient<kNodes>(u_e, g), false);
      if (!response.valid) return std::numeric_limits<double>::infinity();
      const double weight = weights_[e * num_points() + p];
      energy += weight * response.energy;
      f_e.noalias() += (weight * response.P) * g;
    }
    for (int i = 0; i < kNodes; ++i) forces->col(nodes_(i, e)) += f_e.col(i);
  }
  return energy;
}

double Elements::EnergyAndForces(const Eigen::Matrix3Xd& u, Eigen::Matrix3Xd* forces) const {
  return nodes_per_element() == 10 ? EnergyAndForcesOf<10>(u, forces)
                                   : EnergyAndForcesOf<4>(u, forces);
}

int Elements::InvertedElement(const Eigen::Matrix3Xd& u) const {
  const int n = nodes_per_element();
  Eigen::Matrix3Xd u_e(3, n);
  for (int e = 0; e < num_elements(); ++e) {
    if (HasBarrier(material_of_[e].model)) continue;
    for (int i = 0; i < n; ++i) u_e.col(i) = u.col(nodes_(i, e));
    for (int p = 0; p < num_points(); ++p) {
      const Eigen::Map<const Eigen::Matrix3Xd> g(gradients(e, p), 3, n);
      if (!((Eigen::Matrix3d::Identity() + u_e * g.transpose()).determinant() > 0)) return e;
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
  Eigen::Matrix<double, 3, kNodes> u_e;
  for (int i = 0; i < kNodes; ++i) u_e.col(i) = u.col(nodes_(i, element));
  K->setZero();
  for (int p = 0; p < num_points(); ++p) {
    const Eigen::Map<const Eigen::Matrix<double, 3, kNodes>> g(gradients(element, p));
    const MaterialResponse response =
        Evaluate(material_of_[element], DeformationGradient<kNodes>(u_e, g), true);
    const Matrix9d A = weights_[element * num_points() + p] * response.dPdF;
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
      sum += material_of_[e].mu() * weights_[e * num_points() + p];
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
        volumes(nodes_(i, e)) += weights_[e * num_points() + p] * share(i);
      }
    }
  }
  return volumes;
}

}  // namespace softforce::fem
