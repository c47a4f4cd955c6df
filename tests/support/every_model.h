#pragma once

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "softforce/fem/material.h"

namespace softforce::testing {

// Parameters of tests that hold for every elastic law and for elements of both orders.
inline auto EveryModelInBothOrders() {
  using fem::MaterialModel;
  return ::testing::Combine(
      ::testing::Values(MaterialModel::kCorotational, MaterialModel::kStVenantKirchhoff,
                        MaterialModel::kNeoHookean, MaterialModel::kNeoHookeanLogarithmic),
      ::testing::Values(1, 2));
}

inline std::string NameOfModelAndOrder(
    const ::testing::TestParamInfo<std::tuple<fem::MaterialModel, int>>& instance) {
  const auto [model, order] = instance.param;
  return std::string(fem::Name(model)) + (order == 1 ? "_4_nodes" : "_10_nodes");
}

}  // namespace softforce::testing
