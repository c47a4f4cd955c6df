#include "softforce/estimation/information.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <numeric>
#include <random>

namespace softforce::estimation {
namespace {

// A marker of three coordinates that the forces move by `rows`, and the offset by a translation.
MarkerRows Marker(const Eigen::MatrixXd& rows) {
  MarkerRows marker{rows, Eigen::MatrixXd::Zero(3, 6)};
  marker.offset.leftCols<3>().setIdentity();
  return marker;
}

Eigen::MatrixXd Rows(double a, double b, double c) { return Eigen::Vector3d(a, b, c); }

std::vector<MarkerRows> RandomMarkers(int count, int forces) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<MarkerRows> markers;
  for (int i = 0; i < count; ++i) {
    markers.push_back({Eigen::MatrixXd::NullaryExpr(3, forces, [&] { return normal(random); }),
                       Eigen::MatrixXd::NullaryExpr(3, 6, [&] { return normal(random); })});
  }
  return markers;
}

const Eigen::MatrixXd kExact = Eigen::MatrixXd::Zero(6, 6);

TEST(ForceInformation, SharesAreLeverageAndSumToOne) {
  const ForceInformation information({Marker(Rows(1, 0, 0)), Marker(Rows(0, 3, 0))}, kExact);

  const std::vector<double> shares = information.Shares();

  EXPECT_NEAR(shares[0], 0.1, 1e-12);  // rounding; 1² of 1² + 3²
  EXPECT_NEAR(shares[1], 0.9, 1e-12);
}

TEST(ForceInformation, SharesSumToOneWithAnUncertainOffsetToo) {
  const Eigen::MatrixXd P = 2 * Eigen::MatrixXd::Identity(6, 6);

  const std::vector<double> shares = ForceInformation(RandomMarkers(7, 4), P).Shares();

  EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1, 1e-9);  // rounding
}

// The force part of the inverse of the joint information, another way to the same.
TEST(ForceInformation, IsThatOfForcesAndOffsetTogether) {
  const std::vector<MarkerRows> markers = RandomMarkers(5, 2);
  const Eigen::MatrixXd P = 0.5 * Eigen::MatrixXd::Identity(6, 6);
  const auto covariance_of = [&](const std::vector<int>& some) {
    Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(8, 8);
    joint.bottomRightCorner(6, 6) = P.inverse();
    for (const int i : some) {
      Eigen::MatrixXd J(3, 8);
      J << markers[i].forces, markers[i].offset;
      joint += J.transpose() * J;
    }
    return Eigen::MatrixXd(joint.inverse().topLeftCorner(2, 2));
  };
  double least = INFINITY;
  std::vector<int> best;
  for (int i = 0; i < 5; ++i) {
    const double volume = covariance_of({i}).determinant();
    if (volume < least) best = {i};
    least = std::min(least, volume);
  }

  EXPECT_EQ(ForceInformation(markers, P).MostTelling(1), best);
}

TEST(ForceInformation, ChoosesMarkersThatTellDifferentThings) {
  // Two see the first force well, and one sees the second badly.
  const auto two_forces = [](double first, double second) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3, 2);
    rows(0, 0) = first;
    rows(1, 1) = second;
    return rows;
  };
  const ForceInformation information(
      {Marker(two_forces(10, 0)), Marker(two_forces(9, 0)), Marker(two_forces(0, 0.1))}, kExact);

  std::vector<int> telling = information.MostTelling(2);

  std::sort(telling.begin(), telling.end());
  EXPECT_EQ(telling, (std::vector<int>{0, 2}));
}

TEST(ForceInformation, CountsOutWhatAnOffsetMovesAsWell) {
  // All three move by the same along x: with an unknown offset only their differences tell.
  const Eigen::MatrixXd P = 1e6 * Eigen::MatrixXd::Identity(6, 6);
  const std::vector<MarkerRows> markers{Marker(Rows(10, 0, 0)), Marker(Rows(10, 0, 0)),
                                        Marker(Rows(7, 0, 0))};

  const std::vector<double> shares = ForceInformation(markers, P).Shares();
  const std::vector<int> telling = ForceInformation(markers, P).MostTelling(2);

  // Of the squares of 10, 10 and 7 about their mean 9: 1, 1 and 4.
  EXPECT_NE(std::find(telling.begin(), telling.end(), 2), telling.end());
  EXPECT_NEAR(shares[0], 1.0 / 6, 1e-4);  // the offset is not quite free
  EXPECT_NEAR(shares[2], 4.0 / 6, 1e-4);
}

TEST(ForceInformation, SaysThatMarkersThatNoForceMovesTellNothing) {
  for (const double share : ForceInformation({Marker(Rows(0, 0, 0))}, kExact).Shares()) {
    EXPECT_TRUE(std::isnan(share));
  }
}

TEST(ForceInformation, TakesAllIfThereAreNoMore) {
  EXPECT_EQ(ForceInformation(RandomMarkers(3, 2), kExact).MostTelling(5).size(), 3u);
  EXPECT_TRUE(ForceInformation({}, kExact).MostTelling(5).empty());
}

}  // namespace
}  // namespace softforce::estimation
