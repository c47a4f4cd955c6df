#include "softforce/mesh/interior_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

TEST(InteriorPoint, ReproducesThePlaceAndEveryFieldThatTheCellsCan) {
  for (const int order : {1, 2}) {
    TetMesh box = testing::MakeBox(3, 2, 2, {0.03, 0.02, 0.02});
    if (order == 2) box = RaiseOrder(box);
    const auto field = [order](const Eigen::Vector3d& X) -> Eigen::Vector3d {
      const Eigen::Vector3d linear(X.x() - 2 * X.z(), 3 * X.y(), 0.01 + X.x());
      return order == 1 ? linear : linear + 50 * Eigen::Vector3d(X.x() * X.y(), X.z() * X.z(), 0);
    };
    Eigen::Matrix3Xd values(3, box.num_nodes());
    for (int n = 0; n < box.num_nodes(); ++n) values.col(n) = field(box.nodes.col(n));

    const Eigen::Vector3d place(0.0131, 0.0057, 0.0142);
    const auto found = InteriorPoint(box, place);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(std::accumulate(found->weights.begin(), found->weights.end(), 0.0), 1, 1e-12);
    EXPECT_LT((found->Apply(box.nodes) - place).norm(), 1e-15);      // m; rounding
    EXPECT_LT((found->Apply(values) - field(place)).norm(), 1e-14);  // rounding
    EXPECT_TRUE(std::is_sorted(found->nodes.begin(), found->nodes.end()));
  }
}

TEST(InteriorPoint, IsNothingOutsideTheBody) {
  const TetMesh box = testing::MakeBox(1, 1, 1, {0.01, 0.01, 0.01});
  EXPECT_FALSE(InteriorPoint(box, {0.005, 0.005, 0.0101}).has_value());
}

}  // namespace
}  // namespace softforce::mesh
