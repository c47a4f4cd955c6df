#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace softforce::testing {

// A geometrically exact rod, clamped at the origin along x and curved in the plane z = 0 at rest,
// under a dead force on its tip: a theory of its own to hold solids against.
struct CurvedRod {
  double length;
  double curvature;            // at rest, about z
  Eigen::Vector3d stretching;  // stiffness along x (EA) and in shear along y and z (GA), N
  Eigen::Vector3d turning;     // stiffness in torsion (GJ) and in bending about y and z (EI), N m²
};

// Where the tip stands. The position, the frame of the section and the moment are integrated from
// the clamp by Runge and Kutta's method; the moment at the clamp is found by Newton's method, with
// the force raised in steps, so that the tip is free of moment.
class RodSolver {
 public:
  RodSolver(const CurvedRod& rod, const Eigen::Vector3d& force) : rod_(rod), force_(force) {}

  Eigen::Vector3d Tip() const {
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    constexpr int kSteps = 60;
    State tip;
    for (int step = 1; step <= kSteps; ++step) {
      const double share = double(step) / kSteps;
      for (int iteration = 0; iteration < 8; ++iteration) {
        tip = Integrate(moment, share);
        Eigen::Matrix3d slope;
        const double h = 1e-6 * force_.norm() * rod_.length;
        for (int i = 0; i < 3; ++i) {
          const State moved = Integrate(moment + h * Eigen::Vector3d::Unit(i), share);
          slope.col(i) = (moved.tail<3>() - tip.tail<3>()) / h;
        }
        moment -= slope.inverse() * tip.tail<3>();
      }
    }
    return tip.head<3>();
  }

 private:
  using State = Eigen::Matrix<double, 15, 1>;  // position, frame by columns, moment

  State Slope(const State& at, double share) const {
    const Eigen::Map<const Eigen::Matrix3d> Q(at.data() + 3);
    const Eigen::Vector3d strain =
        (Q.transpose() * (share * force_)).cwiseQuotient(rod_.stretching) +
        Eigen::Vector3d::UnitX();
    const Eigen::Vector3d bend = (Q.transpose() * at.tail<3>()).cwiseQuotient(rod_.turning) +
                                 rod_.curvature * Eigen::Vector3d::UnitZ();
    State slope;
    slope.head<3>() = Q * strain;
    for (int i = 0; i < 3; ++i) {
      slope.segment<3>(3 + 3 * i) = Q * bend.cross(Eigen::Vector3d::Unit(i));
    }
    slope.tail<3>() = -slope.head<3>().cross(share * force_);
    return slope;
  }

  State Integrate(const Eigen::Vector3d& moment_at_clamp, double share) const {
    State at = State::Zero();
    Eigen::Map<Eigen::Matrix3d>(at.data() + 3).setIdentity();
    at.tail<3>() = moment_at_clamp;
    constexpr int kSteps = 100;
    const double h = rod_.length / kSteps;
    for (int step = 0; step < kSteps; ++step) {
      const State a = Slope(at, share), b = Slope(at + h / 2 * a, share);
      const State c = Slope(at + h / 2 * b, share), d = Slope(at + h * c, share);
      at += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return at;
  }

  CurvedRod rod_;
  Eigen::Vector3d force_;
};

}  // namespace softforce::testing
