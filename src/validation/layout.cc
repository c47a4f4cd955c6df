#include "softforce/validation/layout.h"

#include <cmath>
#include <utility>

namespace softforce::validation {
namespace {

using Places = std::vector<Eigen::Vector3d>;

Places Join(Places first, const Places& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

// A place under the sheet, given in mm.
Eigen::Vector3d Under(double x_mm, double y_mm) { return {1e-3 * x_mm, 1e-3 * y_mm, 0}; }

Eigen::Vector3d OnSheet(double x_mm, double y_mm) { return {1e-3 * x_mm, 1e-3 * y_mm, 0.01}; }

// Markers on the sheet where the columns and rows (mm) cross, but for those that `leave_out` names.
template <typename LeaveOut>
Places Grid(const std::vector<double>& columns_mm, const std::vector<double>& rows_mm,
            LeaveOut leave_out) {
  Places places;
  for (const double x : columns_mm) {
    for (const double y : rows_mm) {
      if (!leave_out(x, y)) places.push_back(OnSheet(x, y));
    }
  }
  return places;
}

bool None(double, double) { return false; }
bool Central(double x, double y) { return std::abs(x - 100) < 20 && std::abs(y - 100) < 20; }

// The legs of the robot stand in directions 0 … 3, a quarter turn apart, from x on.
Eigen::Vector3d Turned(int leg, double outward, double aside, double z) {
  const double c[] = {1, 0, -1, 0}, s[] = {0, 1, 0, -1};
  return {c[leg] * outward - s[leg] * aside, s[leg] * outward + c[leg] * aside, z};
}

// From the axis to the middle of a leg, m: see meshes/robot.geo.
double LegRadius(double z) { return 0.058 - 0.044 / 0.094 * z; }

// The middle of a leg's outer face at a height in mm.
Eigen::Vector3d Outside(int leg, double z_mm) {
  const double z = 1e-3 * z_mm;
  return Turned(leg, LegRadius(z) + 0.0065, 0, z);
}

Places Outsides(double z_mm) {
  return {Outside(0, z_mm), Outside(1, z_mm), Outside(2, z_mm), Outside(3, z_mm)};
}

// The middles of the legs' two side faces at a height in mm.
Places Sides(double z_mm) {
  const double z = 1e-3 * z_mm;
  Places places;
  for (int leg = 0; leg < 4; ++leg) {
    for (const double aside : {-0.008, 0.008}) {
      places.push_back(Turned(leg, LegRadius(z), aside, z));
    }
  }
  return places;
}

Eigen::Vector3d OnPlatform(double x_mm, double y_mm) { return {1e-3 * x_mm, 1e-3 * y_mm, 0.1}; }

Places PlatformMarkers() {
  return {OnPlatform(-13, -10), OnPlatform(-13, 10), OnPlatform(13, -10), OnPlatform(13, 10)};
}

Places LoadedPlaces(BodyKind body) {
  Places places;
  for (const AppliedForce& applied : AppliedForces(body)) places.push_back(applied.place);
  return places;
}

}  // namespace

const char* Name(BodyKind body) { return body == BodyKind::kSheet ? "sheet" : "robot"; }

std::vector<AppliedForce> AppliedForces(BodyKind body) {
  const Eigen::Vector3d up(0, 0, 0.4), down(0, 0, -0.4);
  if (body == BodyKind::kSheet) return {{Under(70, 120), up}, {Under(130, 80), down}};
  return {{Outside(3, 60), up}, {OnPlatform(0, 8), down}};
}

AppliedForce KnownWeight(BodyKind body) {
  const Eigen::Vector3d weight(0, 0, -0.4);
  return {body == BodyKind::kSheet ? Under(100, 100) : OnPlatform(0, 0), weight};
}

std::vector<Layout> SheetLayouts() {
  constexpr BodyKind kBody = BodyKind::kSheet;
  const std::vector<double> all{25, 55, 85, 115, 145, 175};
  const Places two = LoadedPlaces(kBody);
  const Places four = Join(two, {Under(60, 60), Under(140, 140)});
  const Places six = Join(four, {Under(100, 150), Under(100, 50)});
  const Places ten = Join(six, {Under(45, 100), Under(155, 100), Under(85, 110), Under(130, 95)});
  const Places grid = Grid(all, all, None);
  const std::vector<double> many{25, 50, 75, 100, 125, 150, 175};
  const Places corner{OnSheet(25, 25), OnSheet(25, 46), OnSheet(46, 25), OnSheet(46, 46),
                      OnSheet(67, 25)};
  return {{"s1", kBody, "S0", two, Grid(many, many, None)},
          {"s2", kBody, "S0", four, grid},
          {"s3", kBody, "S0", six, grid},
          {"s4", kBody, "S0", ten, grid},
          {"s5", kBody, "S1", four, Grid(all, all, Central)},
          {"s6", kBody, "S1", four, Grid({25, 85, 115, 175}, all, None)},
          {"s7", kBody, "S1", four, Grid({25, 55, 115, 145, 175}, all, None)},
          {"s8", kBody, "S1", four, corner}};
}

std::vector<Layout> RobotLayouts() {
  constexpr BodyKind kBody = BodyKind::kRobot;
  const Places two = LoadedPlaces(kBody);
  const Places three = Join(two, {Outside(1, 60)});
  const Places four = Join(two, {Outside(0, 60), Outside(2, 60)});
  const Places eight = Join(
      three, {Outside(0, 60), Outside(2, 60), Outside(3, 40), OnPlatform(-8, 0), OnPlatform(8, 0)});
  Places fifteen = Join(eight, {Outside(0, 40), Outside(1, 40), Outside(2, 40)});
  fifteen = Join(fifteen, Join(Outsides(20), {OnPlatform(0, -8)}));

  Places all = PlatformMarkers();
  for (const double z_mm : {10, 30, 50, 75}) all = Join(all, Outsides(z_mm));
  for (const double z_mm : {15, 30, 45, 70}) all = Join(all, Sides(z_mm));
  Places more = all;
  for (const double z_mm : {20, 40, 60, 85}) more = Join(more, Outsides(z_mm));
  for (const double z_mm : {20, 35, 40, 50, 55, 60, 65}) more = Join(more, Sides(z_mm));
  const Places feet = Outsides(10);
  Places one_side;  // of each leg
  for (int leg = 0; leg < 4; ++leg) one_side.push_back(Sides(15)[2 * leg]);
  const Places platform = PlatformMarkers();
  return {{"r1", kBody, "R0", two, more},
          {"r2", kBody, "R0", three, all},
          {"r3", kBody, "R0", eight, all},
          {"r4", kBody, "R0", fifteen, all},
          {"r5", kBody, "R1", four, Join(feet, one_side)},
          {"r6", kBody, "R1", four, Join(feet, Outsides(30))},
          {"r7", kBody, "R1", four, Join(feet, Outsides(50))},
          {"r8", kBody, "R1", four, Join(Outsides(9), {platform[0]})}};
}

}  // namespace softforce::validation
