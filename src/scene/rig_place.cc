#include <Eigen/Eigenvalues>
#include <cmath>
#include <sstream>

#include "scene/rig_formats.h"

namespace softforce::scene {
namespace {

using geometry::Matrix6d;

constexpr char kAdvice[] =
    "It is 6x6, of a small motion of the rig (x y z in m, then rad): squares of standard "
    "deviations on its diagonal. softforce register writes it; without it the place is exact.";

// Digits of a table that was copied by hand; relative to the standard deviations of row and column.
constexpr double kMaxAsymmetry = 1e-6;
constexpr double kMaxNegative = 1e-6;  // eigenvalue of the correlations: rounding

// The matrix with each row and column divided by its standard deviation, or left zero.
Matrix6d Correlations(const Matrix6d& covariance) {
  const geometry::Vector6d sd = covariance.diagonal().cwiseSqrt();
  Matrix6d correlations = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double scale = sd(i) * sd(j);
      // Beside an exact coordinate nothing can be correlated.
      correlations(i, j) = scale > 0 ? covariance(i, j) / scale : covariance(i, j) == 0 ? 0 : 2;
    }
  }
  return correlations;
}

void CheckVariances(const std::vector<YamlValue>& rows, const Matrix6d& covariance) {
  for (int i = 0; i < 6; ++i) {
    if (covariance(i, i) >= 0) continue;
    rows[i].Fail(
        fmt::format("got the variance {} at its place {}, expected 0 or more", covariance(i, i), i),
        kAdvice);
  }
}

void CheckSymmetry(const YamlValue& value, const Matrix6d& covariance) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
      if (std::abs(covariance(i, j) - covariance(j, i)) <= kMaxAsymmetry * scale) continue;
      value.Fail(fmt::format("is not symmetric: got {} at [{}][{}] and {} at [{}][{}]",
                             covariance(i, j), i, j, covariance(j, i), j, i),
                 kAdvice);
    }
  }
}

}  // namespace

Matrix6d ReadPlaceCovariance(const YamlValue& value) {
  Matrix6d covariance;
  const std::vector<YamlValue> rows = value.Items({6});
  for (int i = 0; i < 6; ++i) covariance.row(i) = geometry::Vector6d(rows[i].Numbers({6}).data());
  CheckVariances(rows, covariance);
  CheckSymmetry(value, covariance);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(Correlations(covariance),
                                                       Eigen::EigenvaluesOnly);
  if (solver.eigenvalues()(0) < -kMaxNegative) {
    value.Fail(fmt::format("is no covariance: a combination of its coordinates has the variance "
                           "{:.2g} times that of one, expected 0 or more",
                           solver.eigenvalues()(0)),
               kAdvice);
  }
  return covariance;
}

std::string PlaceText(const Eigen::Isometry3d& T_rig_robot, const Matrix6d& covariance,
                      const std::string& comment) {
  std::string yaml = "T_rig_robot:  # metres\n";
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) yaml += "  # " + line + "\n";
  yaml += Rows(T_rig_robot, "  ");
  if (covariance.isZero(0)) return yaml;
  yaml += "T_rig_robot_covariance:  # of a small motion in the rig frame: x y z m, x y z rad\n";
  for (int i = 0; i < 6; ++i) {
    const geometry::Vector6d row = covariance.row(i);
    yaml += "  - " + List(row) + "\n";
  }
  return yaml;
}

}  // namespace softforce::scene
