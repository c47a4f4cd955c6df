#include "softforce/fem/material.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <array>
#include <cmath>

#include "softforce/base/input_error.h"
#include "softforce/geometry/rigid.h"

namespace softforce::fem {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;

struct NamedModel {
  MaterialModel model;
  const char* name;
};
constexpr std::array<NamedModel, 4> kModels{{
    {MaterialModel::kCorotational, "corotational"},
    {MaterialModel::kStVenantKirchhoff, "st_venant_kirchhoff"},
    {MaterialModel::kNeoHookean, "neo_hookean"},
    {MaterialModel::kNeoHookeanLogarithmic, "neo_hookean_logarithmic"},
}};

// The columns of A under each other: index 3·column + row.
Vector9d Stacked(const Eigen::Matrix3d& A) { return Eigen::Map<const Vector9d>(A.data()); }

// ∂J/∂F, the cofactor matrix of F.
Eigen::Matrix3d Cofactor(const Eigen::Matrix3d& F) {
  Eigen::Matrix3d C;
  C << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
  return C;
}

// ∂²J/∂F²: the cofactor's own derivative, block (a, b) = ± Skew of the remaining column.
Matrix9d CofactorDerivative(const Eigen::Matrix3d& F) {
  Matrix9d D = Matrix9d::Zero();
  for (int c = 0; c < 3; ++c) {
    const int a = (c + 1) % 3;
    const int b = (c + 2) % 3;
    const Eigen::Matrix3d S = geometry::Skew(F.col(c));
    D.block<3, 3>(3 * b, 3 * a) = S;   // d(c × a) / da
    D.block<3, 3>(3 * a, 3 * b) = -S;  // d(b × c) / db
  }
  return D;
}

// |F − R|² and (tr(RᵀF) − 3)² through the singular values of F; the rotation's derivative follows
// from RᵀdR = skew, with (tr(S) I − S) ω = axial(RᵀdF − dFᵀR).
MaterialResponse Corotational(double mu, double lambda, const Eigen::Matrix3d& F,
                              bool with_elasticity) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  Eigen::Vector3d sigma = svd.singularValues();
  if (U.determinant() * svd.matrixV().determinant() < 0) {  // inverted: flip the smallest stretch
    U.col(2) = -U.col(2);
    sigma(2) = -sigma(2);
  }
  const Eigen::Matrix3d R = U * svd.matrixV().transpose();
  const Eigen::Matrix3d S = svd.matrixV() * sigma.asDiagonal() * svd.matrixV().transpose();
  const double stretch = sigma.sum() - 3;  // tr(RᵀF) − 3

  MaterialResponse response;
  response.valid = true;
  response.energy = mu * (F - R).squaredNorm() + 0.5 * lambda * stretch * stretch;
  response.P = 2 * mu * (F - R) + lambda * stretch * R;
  if (!with_elasticity) return response;

  const Eigen::Matrix3d G = S.trace() * Eigen::Matrix3d::Identity() - S;
  const Eigen::Matrix3d G_inverse = G.inverse();
  Matrix9d dR = Matrix9d::Zero();  // dR/dF
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      // RᵀdF has the row `row` of R in its column `column`; the axial vector of its skew part:
      Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
      A.col(column) = R.row(row).transpose();
      const Eigen::Vector3d axial(A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1));
      const Eigen::Matrix3d change = R * geometry::Skew(G_inverse * axial);
      dR.col(3 * column + row) = Stacked(change);
    }
  }
  const Vector9d r = Stacked(R);
  response.dPdF =
      2 * mu * Matrix9d::Identity() + (lambda * stretch - 2 * mu) * dR + lambda * r * r.transpose();
  return response;
}

MaterialResponse StVenantKirchhoff(double mu, double lambda, const Eigen::Matrix3d& F,
                                   bool with_elasticity) {
  const Eigen::Matrix3d E = 0.5 * (F.transpose() * F - Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d stress =  // second Piola–Kirchhoff
      2 * mu * E + lambda * E.trace() * Eigen::Matrix3d::Identity();
  MaterialResponse response;
  response.valid = true;
  response.energy = mu * E.squaredNorm() + 0.5 * lambda * E.trace() * E.trace();
  response.P = F * stress;
  if (!with_elasticity) return response;

  const Eigen::Matrix3d B = F * F.transpose();
  const Vector9d f = Stacked(F);
  response.dPdF = lambda * f * f.transpose();
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      response.dPdF.block<3, 3>(3 * a, 3 * b) +=
          stress(a, b) * Eigen::Matrix3d::Identity() + mu * F.col(b) * F.col(a).transpose();
    }
    response.dPdF.block<3, 3>(3 * a, 3 * a) += mu * B;
  }
  return response;
}

MaterialResponse NeoHookean(double mu, double kappa, const Eigen::Matrix3d& F,
                            bool with_elasticity) {
  MaterialResponse response;
  const double J = F.determinant();
  if (!(J > 0)) return response;
  const double I1 = F.squaredNorm();
  const double s = std::cbrt(1 / (J * J));  // J^(−2/3)
  const Eigen::Matrix3d C = Cofactor(F);
  // P = mu s F + h C with h = kappa/2 (J − 1/J) − mu s I1 / (3 J)
  const double h = 0.5 * kappa * (J - 1 / J) - mu * s * I1 / (3 * J);
  response.valid = true;
  response.energy = 0.5 * mu * (s * I1 - 3) + 0.25 * kappa * (J * J - 1 - 2 * std::log(J));
  response.P = mu * s * F + h * C;
  if (!with_elasticity) return response;

  const Vector9d f = Stacked(F);
  const Vector9d c = Stacked(C);
  const double cross = -2 * mu * s / (3 * J);
  const double dh_dJ = 0.5 * kappa * (1 + 1 / (J * J)) + 5 * mu * s * I1 / (9 * J * J);
  response.dPdF = mu * s * Matrix9d::Identity() + cross * (f * c.transpose() + c * f.transpose()) +
                  dh_dJ * c * c.transpose() + h * CofactorDerivative(F);
  return response;
}

MaterialResponse NeoHookeanLogarithmic(double mu, double lambda, const Eigen::Matrix3d& F,
                                       bool with_elasticity) {
  MaterialResponse response;
  const double J = F.determinant();
  if (!(J > 0)) return response;
  const double log_J = std::log(J);
  const Eigen::Matrix3d C = Cofactor(F);
  const double h = (lambda * log_J - mu) / J;
  response.valid = true;
  response.energy = 0.5 * mu * (F.squaredNorm() - 3) - mu * log_J + 0.5 * lambda * log_J * log_J;
  response.P = mu * F + h * C;
  if (!with_elasticity) return response;

  const Vector9d c = Stacked(C);
  response.dPdF = mu * Matrix9d::Identity() + ((lambda - h * J) / (J * J)) * c * c.transpose() +
                  h * CofactorDerivative(F);
  return response;
}

}  // namespace

const char* Name(MaterialModel model) {
  for (const NamedModel& named : kModels) {
    if (named.model == model) return named.name;
  }
  return "";
}

std::optional<MaterialModel> MaterialModelByName(const std::string& name) {
  for (const NamedModel& named : kModels) {
    if (name == named.name) return named.model;
  }
  return std::nullopt;
}

bool HasBarrier(MaterialModel model) {
  return model == MaterialModel::kNeoHookean || model == MaterialModel::kNeoHookeanLogarithmic;
}

void Material::Check(const std::string& where) const {
  if (!(youngs_modulus > 0) || !std::isfinite(youngs_modulus)) {
    throw base::InputError(where + ": youngs_modulus",
                           fmt::format("is {} Pa, must be greater than 0", youngs_modulus));
  }
  if (!(poissons_ratio >= 0 && poissons_ratio < 0.5)) {
    throw base::InputError(where + ": poissons_ratio",
                           fmt::format("is {}, must be at least 0 and below 0.5", poissons_ratio),
                           "Silicone is nearly incompressible: 0.45 to 0.49 is usual.");
  }
}

MaterialResponse Evaluate(const Material& material, const Eigen::Matrix3d& F,
                          bool with_elasticity) {
  const double mu = material.mu();
  switch (material.model) {
    case MaterialModel::kCorotational:
      return Corotational(mu, material.lambda(), F, with_elasticity);
    case MaterialModel::kStVenantKirchhoff:
      return StVenantKirchhoff(mu, material.lambda(), F, with_elasticity);
    case MaterialModel::kNeoHookean:
      return NeoHookean(mu, material.kappa(), F, with_elasticity);
    case MaterialModel::kNeoHookeanLogarithmic:
      return NeoHookeanLogarithmic(mu, material.lambda(), F, with_elasticity);
  }
  return {};
}

}  // namespace softforce::fem
