#include "fem/element_kernel.h"

#include <gtest/gtest.h>

#include <random>
#include <tuple>
#include <vector>

namespace softforce::fem {
namespace {

// A batch of elements of which every lane differs, with random gradients and displacements.
struct RandomBatch {
  int nodes;
  int points = nodes == 10 ? 4 : 1;
  std::vector<double> gradients, weights, mu, lambda, kappa, u, forces;
  std::vector<Material> material;

  RandomBatch(MaterialModel model, int nodes_in) : nodes(nodes_in) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto fill = [&](std::vector<double>* values, int size, double scale) {
      for (int i = 0; i < size * kLanes; ++i) values->push_back(scale * uniform(random));
    };
    fill(&gradients, points * nodes * 3, 100);  // 1/m, of elements of a centimetre
    fill(&u, 3 * nodes, 5e-4);                  // m
    forces.resize(u.size());
    for (int i = 0; i < points * kLanes; ++i) weights.push_back(1e-7 * (2 + uniform(random)));
    for (int lane = 0; lane < kLanes; ++lane) {
      material.push_back({model, 200e3 * (1 + 0.1 * lane), 0.3 + 0.02 * lane});
      mu.push_back(material[lane].mu());
      lambda.push_back(material[lane].lambda());
      kappa.push_back(material[lane].kappa());
    }
  }

  BatchEnergy Run(ElementKernel kernel) {
    return kernel({gradients.data(), weights.data(), mu.data(), lambda.data(), kappa.data(),
                   u.data(), forces.data()});
  }

  Eigen::Matrix3Xd Lane(const std::vector<double>& values, int first, int lane) const {
    Eigen::Matrix3Xd one(3, nodes);
    for (int k = 0; k < 3 * nodes; ++k) one.data()[k] = values[(3 * first + k) * kLanes + lane];
    return one;
  }
};

class EveryKernel : public ::testing::TestWithParam<std::tuple<MaterialModel, int>> {};

// All instruction sets that this machine has, against the law evaluated one point at a time.
TEST_P(EveryKernel, ComputesWhatTheLawSays) {
  const auto [model, nodes] = GetParam();
  std::vector<ElementKernel> kernels{baseline::KernelFor(model, nodes), KernelFor(model, nodes)};
  for (const ElementKernel kernel : kernels) {
    RandomBatch batch(model, nodes);
    const BatchEnergy found = batch.Run(kernel);
    ASSERT_EQ(found.status, BatchEnergy::Status::kOk);
    double energy = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      const Eigen::Matrix3Xd u = batch.Lane(batch.u, 0, lane);
      Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, nodes);
      for (int p = 0; p < batch.points; ++p) {
        const Eigen::Matrix3Xd g = batch.Lane(batch.gradients, p * nodes, lane);
        const double weight = batch.weights[p * kLanes + lane];
        const MaterialResponse law =
            Evaluate(batch.material[lane], Eigen::Matrix3d::Identity() + u * g.transpose(), false);
        ASSERT_TRUE(law.valid);
        energy += weight * law.energy;
        forces += weight * law.P * g;
      }
      EXPECT_LT((batch.Lane(batch.forces, 0, lane) - forces).norm(), 1e-12 * forces.norm());
    }
    EXPECT_NEAR(found.energy, energy, 1e-12 * energy);  // rounding
  }
}

TEST_P(EveryKernel, SaysThatAnElementIsInsideOutOrBeyondIt) {
  const auto [model, nodes] = GetParam();
  RandomBatch batch(model, nodes);
  for (double& value : batch.u) value *= 100;  // some lanes are turned inside out
  const BatchEnergy found = batch.Run(KernelFor(model, nodes));
  switch (model) {
    case MaterialModel::kStVenantKirchhoff:
      EXPECT_EQ(found.status, BatchEnergy::Status::kOk);  // has a value everywhere
      break;
    case MaterialModel::kCorotational:
      EXPECT_EQ(found.status, BatchEnergy::Status::kHard);
      break;
    default:
      EXPECT_EQ(found.status, BatchEnergy::Status::kInvalid);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, EveryKernel,
    ::testing::Combine(::testing::Values(MaterialModel::kCorotational,
                                         MaterialModel::kStVenantKirchhoff,
                                         MaterialModel::kNeoHookean,
                                         MaterialModel::kNeoHookeanLogarithmic),
                       ::testing::Values(4, 10)));

}  // namespace
}  // namespace softforce::fem
