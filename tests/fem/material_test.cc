#include "softforce/fem/material.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

#include "softforce/base/input_error.h"

namespace softforce::fem {
namespace {

constexpr double kModulus = 220e3;  // Pa

class EveryMaterial : public ::testing::TestWithParam<MaterialModel> {
 protected:
  Material material() const { return {GetParam(), kModulus, 0.45}; }
};

Eigen::Matrix3d RandomStretch(int seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(-0.25, 0.25);
  return Eigen::Matrix3d::Identity() + Eigen::Matrix3d::NullaryExpr([&] { return entry(random); });
}

TEST_P(EveryMaterial, StressIsTheDerivativeOfTheEnergy) {
  const double h = 1e-6;
  for (int seed = 0; seed < 5; ++seed) {
    const Eigen::Matrix3d F = RandomStretch(seed);
    const Eigen::Matrix3d P = Evaluate(material(), F, false).P;
    for (int i = 0; i < 9; ++i) {
      Eigen::Matrix3d dF = Eigen::Matrix3d::Zero();
      dF(i) = h;
      const double slope = (Evaluate(material(), F + dF, false).energy -
                            Evaluate(material(), F - dF, false).energy) /
                           (2 * h);
      EXPECT_NEAR(P(i), slope, 1e-6 * kModulus);
    }
  }
}

TEST_P(EveryMaterial, ElasticityIsTheDerivativeOfTheStressAndSymmetric) {
  const double h = 1e-6;
  for (int seed = 0; seed < 5; ++seed) {
    const Eigen::Matrix3d F = RandomStretch(seed);
    const Matrix9d A = Evaluate(material(), F, true).dPdF;
    for (int i = 0; i < 9; ++i) {
      Eigen::Matrix3d dF = Eigen::Matrix3d::Zero();
      dF(i) = h;
      const Eigen::Matrix3d slope =
          (Evaluate(material(), F + dF, false).P - Evaluate(material(), F - dF, false).P) / (2 * h);
      EXPECT_LT((A.col(i) - slope.reshaped()).cwiseAbs().maxCoeff(), 2e-5 * kModulus);
    }
    EXPECT_LT((A - A.transpose()).cwiseAbs().maxCoeff(), 1e-9 * kModulus);
  }
}

TEST_P(EveryMaterial, ARotationMakesNoStress) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  EXPECT_LT(Evaluate(material(), R, false).P.norm(), 1e-9 * kModulus);
}

TEST_P(EveryMaterial, IsHookesLawAtSmallStrain) {
  const double strain = 1e-6;
  Eigen::Matrix3d e = Eigen::Matrix3d::Zero();
  e(0, 0) = strain;
  e(0, 1) = e(1, 0) = strain / 2;
  const Eigen::Matrix3d hooke =
      2 * material().mu() * e + material().lambda() * e.trace() * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d P = Evaluate(material(), Eigen::Matrix3d::Identity() + e, false).P;
  EXPECT_LT((P - hooke).norm(), 1e-4 * hooke.norm());
}

INSTANTIATE_TEST_SUITE_P(Models, EveryMaterial,
                         ::testing::Values(MaterialModel::kCorotational,
                                           MaterialModel::kStVenantKirchhoff,
                                           MaterialModel::kNeoHookean,
                                           MaterialModel::kNeoHookeanLogarithmic),
                         [](const auto& instance) { return std::string(Name(instance.param)); });

// Nominal stress (Pa) of a bar stretched by `stretch`, its sides free: the lateral stretch is found
// by bisection.
double UniaxialStress(const Material& material, double stretch) {
  double low = 0.5, high = 1.6;
  Eigen::Matrix3d F = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 100; ++i) {
    const double side = 0.5 * (low + high);
    F.diagonal() << stretch, side, side;
    (Evaluate(material, F, false).P(1, 1) > 0 ? high : low) = side;
  }
  return Evaluate(material, F, false).P(0, 0);
}

struct UniaxialCase {
  MaterialModel model;
  double kilopascal[4];  // at stretches 0.7, 0.9, 1.1, 1.3
};

TEST(Material, FollowsTheUniaxialReferenceTable) {
  const UniaxialCase cases[] = {
      {MaterialModel::kNeoHookeanLogarithmic, {-95.467, -24.357, 20.175, 52.660}},
      {MaterialModel::kNeoHookean, {-98.886, -24.600, 19.996, 51.370}},
      {MaterialModel::kStVenantKirchhoff, {-39.270, -18.810, 25.410, 98.670}},
      {MaterialModel::kCorotational, {-66, -22, 22, 66}}};
  const double stretches[] = {0.7, 0.9, 1.1, 1.3};
  for (const UniaxialCase& reference : cases) {
    for (int i = 0; i < 4; ++i) {
      const double stress = UniaxialStress({reference.model, kModulus, 0.45}, stretches[i]);
      EXPECT_NEAR(stress / 1e3, reference.kilopascal[i], 1e-3)  // kPa, the table's last digit
          << Name(reference.model) << " at " << stretches[i];
    }
  }
}

TEST(Material, HasNoValueWhereACellIsInsideOut) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(2, 2) = -0.5;
  EXPECT_FALSE(Evaluate({MaterialModel::kNeoHookean, kModulus, 0.45}, F, false).valid);
  EXPECT_FALSE(Evaluate({MaterialModel::kNeoHookeanLogarithmic, kModulus, 0.45}, F, false).valid);
}

TEST(Material, IsKnownByItsName) {
  EXPECT_EQ(MaterialModelByName("neo_hookean"), MaterialModel::kNeoHookean);
  EXPECT_EQ(MaterialModelByName("rubber"), std::nullopt);
}

TEST(Material, RefusesValuesOutOfRange) {
  for (const double modulus : std::vector<double>{0, -1, NAN, INFINITY}) {
    EXPECT_THROW((Material{MaterialModel::kNeoHookean, modulus, 0.4}.Check("scene")),
                 base::InputError);
  }
  for (const double ratio : std::vector<double>{-0.1, 0.5, NAN}) {
    EXPECT_THROW((Material{MaterialModel::kNeoHookean, 1e5, ratio}.Check("scene")),
                 base::InputError);
  }
}

}  // namespace
}  // namespace softforce::fem
