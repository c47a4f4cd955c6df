#include "softforce/design/expected_errors.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>

#include "design/plate.h"
#include "softforce/base/input_error.h"
#include "softforce/design/choose_places.h"

namespace softforce::design {
namespace {

std::vector<int> Some() { return {0, 7, 13, 22, 30}; }

TEST(ExpectedErrors, AreThoseOfTheCovarianceFormedAtLength) {
  testing::Plate plate;
  plate.model.registration.diagonal() << 1e-8, 2e-8, 1e-8, 1e-6, 1e-6, 2e-6;  // m², rad²
  const ExpectedErrors errors = plate.Errors();

  const auto expected = errors.Expect(Some());

  const Influence influence =
      ComputeInfluence(plate.solver.get(), plate.solver->AtRest(), plate.points, plate.loads);
  const auto count = static_cast<double>(plate.sights.size());
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& sight : plate.sights) centre += sight.position / count;
  double extent2 = 0;
  for (const auto& sight : plate.sights) {
    extent2 += (sight.position - centre).squaredNorm() / count;
  }
  for (int j = 0; j < errors.num_loads(); ++j) {
    double displacement = 0;
    for (int i = 0; i < errors.num_places(); ++i) {
      displacement =
          std::max(displacement, 0.4 * influence.At(i, j).col(2).norm());  // 0.4 N along z
    }
    const double shift = plate.model.common_model_error * displacement;
    const double local = plate.model.local_model_error * displacement;
    // The covariance of all measurements, the offset's part in it.
    const auto n = static_cast<Eigen::Index>(3 * Some().size());
    Eigen::MatrixXd J(n, 5), B(n, 6);
    for (size_t k = 0; k < Some().size(); ++k) {
      const int i = Some()[k];
      J.middleRows<3>(3 * static_cast<Eigen::Index>(k)) = influence.At(i, j);
      B.middleRows<3>(3 * static_cast<Eigen::Index>(k)) << Eigen::Matrix3d::Identity(),
          -geometry::Skew(plate.sights[i].position - centre);
    }
    geometry::Matrix6d to_centre = geometry::Matrix6d::Identity();
    to_centre.topRightCorner<3, 3>() = -geometry::Skew(centre);
    geometry::Matrix6d P = to_centre * plate.model.registration * to_centre.transpose();
    P.diagonal().head<3>().array() += shift * shift;
    P.diagonal().tail<3>().array() += shift * shift / extent2;
    Eigen::MatrixXd R = B * P * B.transpose();
    R.diagonal().array() += testing::Plate::kNoise * testing::Plate::kNoise + local * local;
    Eigen::MatrixXd F = J.transpose() * R.ldlt().solve(J);
    F.diagonal().head<3>().array() += 1 / (plate.model.force_sd * plate.model.force_sd);
    F.diagonal().tail<2>().array() += 1 / (plate.model.location_sd * plate.model.location_sd);
    const Eigen::MatrixXd C = F.inverse();
    // Shares: rounding.
    EXPECT_NEAR(expected[j].location / std::sqrt(C(3, 3) + C(4, 4)), 1, 1e-6) << j;
    EXPECT_NEAR(expected[j].force / std::sqrt(C.topLeftCorner<3, 3>().trace()), 1, 1e-6) << j;
    EXPECT_LE(expected[j].location_major, expected[j].location) << j;
  }
}

TEST(ExpectedErrors, EveryMarkerAddsInformationOnEveryLoad) {
  testing::Plate plate;
  const ExpectedErrors errors = plate.Errors();
  std::vector<int> places;
  std::vector<ExpectedError> before = errors.Expect(places);
  for (const int place : {3, 17, 31, 9}) {
    places.push_back(place);
    const std::vector<ExpectedError> after = errors.Expect(places);
    for (int j = 0; j < errors.num_loads(); ++j) {
      EXPECT_LE(after[j].location, before[j].location * (1 + 1e-12)) << j;  // rounding
      EXPECT_LE(after[j].force, before[j].force * (1 + 1e-12)) << j;
    }
    before = after;
  }
}

TEST(ExpectedErrors, TheOrderOfMarkersDoesNotMatter) {
  testing::Plate plate;
  const ExpectedErrors errors = plate.Errors();

  const double one = errors.Value(Criterion::kLocation, errors.Of({2, 11, 25}));
  const double other = errors.Value(Criterion::kLocation, errors.Of({25, 2}), 11);

  EXPECT_NEAR(one, other, 1e-9);  // rounding of a logarithm of order 1
}

TEST(ExpectedErrors, WithoutMarkersThereIsThePrior) {
  testing::Plate plate;
  for (const ExpectedError& error : plate.Errors().Expect({})) {
    EXPECT_NEAR(error.location, std::sqrt(2.0) * 0.03, 1e-12);  // m; rounding
    EXPECT_NEAR(error.force, std::sqrt(3.0) * 0.4, 1e-12);      // N
  }
}

TEST(ExpectedErrors, APlaceThatNoCameraSeesTellsNothing) {
  testing::Plate plate;
  plate.sights[4].information.setZero();
  const ExpectedErrors errors = plate.Errors();

  const auto with = errors.Expect({0, 4, 20});
  const auto without = errors.Expect({0, 20});

  for (int j = 0; j < errors.num_loads(); ++j) {
    EXPECT_DOUBLE_EQ(with[j].location, without[j].location) << j;
  }
}

TEST(ExpectedErrors, RefuseAModelOutOfRange) {
  testing::Plate plate;
  const auto refuses = [&](const ErrorModel& model) {
    EXPECT_THROW(model.Check(), base::InputError);
  };
  ErrorModel model = plate.model;
  model.force_sd = 0;
  refuses(model);
  model = plate.model;
  model.location_sd = -1;
  refuses(model);
  model = plate.model;
  model.common_model_error = 1;
  refuses(model);
  model = plate.model;
  model.local_model_error = -0.1;
  refuses(model);
}

}  // namespace
}  // namespace softforce::design
