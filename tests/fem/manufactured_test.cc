// Convergence against a manufactured solution: the displacement is chosen, the body force that
// makes it the equilibrium follows from the strong form, Div P + b = 0. Nothing of the library is
// used for that, so a wrong stress, a wrong integration rule or a wrong cell would break the order.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "support/reference_problem.h"

namespace softforce::fem {
namespace {

constexpr double kModulus = 1e5, kRatio = 0.3;  // Pa, –
const Eigen::Vector3d kAmplitude(0.05, -0.04, 0.06);

// Vanishes on the unit box's surface; no polynomial.
Eigen::Vector3d Chosen(const Eigen::Vector3d& X) {
  const double bubble = std::sin(M_PI * X.x()) * std::sin(M_PI * X.y()) * std::sin(M_PI * X.z());
  return bubble * std::exp(0.5 * X.x() - 0.3 * X.z()) * kAmplitude;
}

Eigen::Matrix3d ChosenGradient(const Eigen::Vector3d& X) {
  const Eigen::Array3d s = (M_PI * X.array()).sin(), c = M_PI * (M_PI * X.array()).cos();
  const double growth = std::exp(0.5 * X.x() - 0.3 * X.z());
  const double bubble = s.prod();
  const Eigen::RowVector3d slope(c(0) * s(1) * s(2) + 0.5 * bubble, s(0) * c(1) * s(2),
                                 s(0) * s(1) * c(2) - 0.3 * bubble);
  return growth * kAmplitude * slope;
}

// First Piola–Kirchhoff stress of the compressible neo-Hookean law with the logarithm of J.
Eigen::Matrix3d Stress(const Eigen::Vector3d& X) {
  const double mu = kModulus / (2 * (1 + kRatio));
  const double lambda = kModulus * kRatio / ((1 + kRatio) * (1 - 2 * kRatio));
  const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + ChosenGradient(X);
  const Eigen::Matrix3d F_inverse_transposed = F.inverse().transpose();
  return mu * F + (lambda * std::log(F.determinant()) - mu) * F_inverse_transposed;
}

// −Div P by central differences, N/m³; h² makes their error 1e-7 of it, far below that of the
// cells.
Eigen::Vector3d BodyForce(const Eigen::Vector3d& X) {
  const double h = 1e-4;
  Eigen::Vector3d divergence = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
    divergence += (Stress(X + step) - Stress(X - step)).col(axis) / (2 * h);
  }
  return -divergence;
}

// The box with n bricks along each side, its inside sheared and squeezed by `distortion`.
Body Box(int n, int order, double distortion) {
  Body body;
  body.mesh = testing::MapBox({n, n, n}, order, [=](const Eigen::Vector3d& X) -> Eigen::Vector3d {
    const double inside = (M_PI * X.array()).sin().prod();
    return X + distortion * inside * Eigen::Vector3d(1, -0.7, 0.5);
  });
  body.materials = {{MaterialModel::kNeoHookeanLogarithmic, kModulus, kRatio}};
  testing::HoldNodes(&body, [](const Eigen::Vector3d& X) {
    return X.minCoeff() < testing::kOnPlane || X.maxCoeff() > 1 - testing::kOnPlane;
  });
  return body;
}

// The L2 norm of the error of the displacement, m^(5/2).
double SolveAndMeasure(const Body& body) {
  // Of degree 3 and 5: the integrals are exact to an order above that of the cells.
  const auto rule = testing::CellRule(body.mesh.order() == 1 ? testing::kGauss3 : testing::kGauss4);
  const mesh::TetMesh& mesh = body.mesh;
  LoadCase load = testing::NoLoad(body);
  for (int cell = 0; cell < mesh.num_elements(); ++cell) {
    for (const testing::CellPlace& place : rule) {
      const testing::CellPoint point = testing::PointInCell(mesh, cell, place.barycentric);
      const Eigen::Vector3d force = place.weight * point.jacobian * BodyForce(point.X);
      for (int i = 0; i < point.shape.size(); ++i) {
        load.forces.col(mesh.elements(i, cell)) += point.shape(i) * force;
      }
    }
  }
  const Equilibrium state = testing::SolveFromRest(body, load);
  double squared = 0;
  for (int cell = 0; cell < mesh.num_elements(); ++cell) {
    const Eigen::Matrix3Xd u = testing::OfCell(mesh, cell, state.u);
    for (const testing::CellPlace& place : rule) {
      const testing::CellPoint point = testing::PointInCell(mesh, cell, place.barycentric);
      squared += place.weight * point.jacobian * (u * point.shape - Chosen(point.X)).squaredNorm();
    }
  }
  return std::sqrt(squared);
}

struct Family {
  int order;
  std::array<int, 3> bricks;  // along a side
  double distortion;
};

class ManufacturedSolution : public ::testing::TestWithParam<Family> {};

TEST_P(ManufacturedSolution, IsApproachedAtTheOrderOfTheCells) {
  const Family family = GetParam();
  double coarser = 0, order = 0;
  for (int i = 0; i < 3; ++i) {
    const double error = SolveAndMeasure(Box(family.bricks[i], family.order, family.distortion));
    if (i > 0) {
      order = std::log(coarser / error) / std::log(double(family.bricks[i]) / family.bricks[i - 1]);
    }
    testing::Record(std::to_string(family.bricks[i]) + " bricks a side, L2 error", error);
    coarser = error;
  }
  testing::Record("order of convergence", order);

  // Theory: 2 for linear, 3 for quadratic shape functions, as the cells become small; at these
  // sizes the order is within 0.1 of it.
  EXPECT_GT(order, family.order == 1 ? 1.9 : 2.9);
}

INSTANTIATE_TEST_SUITE_P(Families, ManufacturedSolution,
                         ::testing::Values(Family{1, {5, 10, 20}, 0}, Family{2, {2, 4, 8}, 0},
                                           Family{1, {5, 10, 20}, 0.1}, Family{2, {2, 4, 8}, 0.1}),
                         [](const auto& instance) {
                           const Family& family = instance.param;
                           return std::string(family.order == 1 ? "FourNodes" : "TenNodes") +
                                  (family.distortion == 0 ? "" : "Distorted");
                         });

}  // namespace
}  // namespace softforce::fem
