#include "softforce/design/expected_errors.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::design {
namespace {

using Information = ExpectedErrors::Information;
constexpr int kForce = 6, kPlace = 9;  // where these unknowns begin

Eigen::Matrix3d SquareRoot(const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(information);
  return axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * axes.eigenvectors().transpose();
}

// The places that are seen: their mean, and their root mean square distance from it.
struct Cloud {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double extent = 0;
};
Cloud CloudOf(const std::vector<MarkerSight>& places) {
  Cloud cloud;
  double count = 0;
  for (const MarkerSight& place : places) {
    if (place.information.isZero(0)) continue;
    cloud.centre += place.position;
    ++count;
  }
  if (count == 0) return cloud;
  cloud.centre /= count;
  for (const MarkerSight& place : places) {
    if (place.information.isZero(0)) continue;
    cloud.extent += (place.position - cloud.centre).squaredNorm() / count;
  }
  cloud.extent = std::sqrt(cloud.extent);
  return cloud;
}

Eigen::Matrix<double, 3, 6> OffsetRows(const Eigen::Vector3d& arm) {
  Eigen::Matrix<double, 3, 6> rows;
  rows << Eigen::Matrix3d::Identity(), -geometry::Skew(arm);
  return rows;
}

// S with S Sᵀ the covariance of the offset about the cloud's centre.
geometry::Matrix6d OffsetScale(const ErrorModel& model, const Cloud& cloud, double displacement) {
  geometry::Matrix6d to_centre = geometry::Matrix6d::Identity();
  to_centre.topRightCorner<3, 3>() = -geometry::Skew(cloud.centre);
  geometry::Matrix6d P = to_centre * model.registration * to_centre.transpose();
  const double sd = model.common_model_error * displacement;
  P.diagonal().head<3>().array() += sd * sd;
  if (cloud.extent > 0) {
    P.diagonal().tail<3>().array() += sd * sd / (cloud.extent * cloud.extent);
  }
  const Eigen::SelfAdjointEigenSolver<geometry::Matrix6d> axes(P);
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

// The last two rows of the Cholesky factor give the place's covariance C = (L Lᵀ)⁻¹.
struct PlaceCovariance {
  double xx, xy, yy;  // m²

  explicit PlaceCovariance(const Information& L) {
    const double a = 1 / L(kPlace, kPlace), c = 1 / L(kPlace + 1, kPlace + 1);
    const double b = -L(kPlace + 1, kPlace) * a * c;
    xx = a * a + b * b;
    xy = b * c;
    yy = c * c;
  }
  double trace() const { return xx + yy; }
  double largest() const { return (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy); }
};

double ValueOf(Criterion criterion, const Information& L) {
  if (criterion == Criterion::kLocation) return 0.5 * std::log(PlaceCovariance(L).trace());
  double sum = 0;
  for (int i = kForce; i < ExpectedErrors::kUnknowns; ++i) sum -= std::log(L(i, i));
  return sum;
}

}  // namespace

void ErrorModel::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("design: ") + option, rule);
  };
  require(force_sd > 0 && std::isfinite(force_sd), "force", "must be greater than 0 N");
  require(location_sd > 0 && std::isfinite(location_sd), "location_sd", "must be greater than 0 m");
  require(common_model_error >= 0 && common_model_error < 1, "common_model_error",
          "must be at least 0 and below 1");
  require(local_model_error >= 0 && local_model_error < 1, "local_model_error",
          "must be at least 0 and below 1");
}

ExpectedErrors::ExpectedErrors(const Influence& influence, const std::vector<PlacedLoad>& loads,
                               const std::vector<MarkerSight>& places, const ErrorModel& model)
    : num_places_(influence.num_points()), num_loads_(influence.num_loads()), model_(model) {
  model.Check();
  assert(static_cast<int>(places.size()) == num_places_);
  assert(static_cast<int>(loads.size()) == num_loads_);
  rows_.resize(static_cast<size_t>(num_places_) * num_loads_);
  const Cloud cloud = CloudOf(places);
  for (int j = 0; j < num_loads_; ++j) {
    const PlacedLoad& load = loads[j];
    num_directions_.push_back(load.num_directions());
    Eigen::Vector3d intensity = Eigen::Vector3d::Zero();
    intensity.head(load.num_directions()) = load.intensity();
    double displacement = 0;
    for (int i = 0; i < num_places_; ++i) {
      if (places[i].information.isZero(0)) continue;
      displacement = std::max(displacement, (influence.At(i, j).leftCols<3>() * intensity).norm());
    }
    const geometry::Matrix6d offset = OffsetScale(model, cloud, displacement);
    const double local = model.local_model_error * displacement;
    for (int i = 0; i < num_places_; ++i) {
      const Eigen::Matrix3d& own = places[i].information;
      // (own⁻¹ + local² I)⁻¹, also where `own` is singular.
      const Eigen::Matrix3d both =
          (Eigen::Matrix3d::Identity() + local * local * own).partialPivLu().solve(own);
      const Eigen::Matrix3d whitening = SquareRoot((both + both.transpose()) / 2);
      Rows& rows = rows_[static_cast<size_t>(i) * num_loads_ + j];
      rows.leftCols<6>() = whitening * OffsetRows(places[i].position - cloud.centre) * offset;
      rows.rightCols<5>() = whitening * influence.At(i, j);
    }
  }
}

std::vector<Information> ExpectedErrors::Start() const {
  Information prior = Information::Identity();
  prior.diagonal().segment<3>(kForce).setConstant(1 / (model_.force_sd * model_.force_sd));
  prior.diagonal().tail<2>().setConstant(1 / (model_.location_sd * model_.location_sd));
  return std::vector<Information>(num_loads_, prior);
}

void ExpectedErrors::Add(int place, std::vector<Information>* sums) const {
  for (int j = 0; j < num_loads_; ++j) {
    const Rows& rows = RowsOf(place, j);
    (*sums)[j].noalias() += rows.transpose() * rows;
  }
}

std::vector<Information> ExpectedErrors::Of(const std::vector<int>& places) const {
  std::vector<Information> sums = Start();
  for (const int place : places) Add(place, &sums);
  return sums;
}

std::vector<ExpectedError> ExpectedErrors::Expect(const std::vector<int>& places) const {
  std::vector<ExpectedError> errors;
  const std::vector<Information> sums = Of(places);
  for (int j = 0; j < num_loads_; ++j) {
    const Eigen::LLT<Information> factor(sums[j]);
    const PlaceCovariance place(factor.matrixLLT());
    const Information covariance = factor.solve(Information::Identity());
    ExpectedError error;
    error.location = std::sqrt(place.trace());
    error.location_major = std::sqrt(place.largest());
    error.force = std::sqrt(covariance.diagonal().segment(kForce, num_directions_[j]).sum());
    errors.push_back(error);
  }
  return errors;
}

double ExpectedErrors::Value(Criterion criterion, const std::vector<Information>& sums,
                             int added) const {
  double sum = 0;
  Information information;
  for (int j = 0; j < num_loads_; ++j) {
    information = sums[j];
    if (added >= 0) {
      const Rows& rows = RowsOf(added, j);
      information.noalias() += rows.transpose().lazyProduct(rows);
    }
    const Eigen::LLT<Eigen::Ref<Information>> factor(information);
    sum += ValueOf(criterion, information);
  }
  return sum / num_loads_;
}

double MedianLocation(const std::vector<ExpectedError>& errors) {
  if (errors.empty()) return NAN;
  std::vector<double> values;
  for (const ExpectedError& error : errors) values.push_back(error.location);
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

}  // namespace softforce::design
