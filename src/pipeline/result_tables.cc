#include "pipeline/result_tables.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "softforce/base/input_error.h"
#include "softforce/geometry/chi_square.h"

namespace softforce::pipeline {
namespace {

// A number with a fixed count of decimals; an empty cell where there is none.
std::string Cell(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "";
}

std::string Millimetres(const Eigen::Vector3d& p) {
  return Cell(1e3 * p.x(), 4) + "," + Cell(1e3 * p.y(), 4) + "," + Cell(1e3 * p.z(), 4);
}

std::string Newtons(const Eigen::Vector3d& f) {
  return Cell(f.x(), 6) + "," + Cell(f.y(), 6) + "," + Cell(f.z(), 6);
}

}  // namespace

PendingTable::PendingTable(const std::filesystem::path& path, const std::string& header)
    : file_(path), stream_(file_.temporary()) {
  if (!stream_) {
    throw base::InputError(
        path.string(), "cannot be written",
        "Choose another folder with --out, or check its permissions and the disk's space.");
  }
  if (!header.empty()) stream_ << header << '\n';
}

void PendingTable::Commit() {
  stream_.close();
  if (!stream_) {
    throw base::InputError(file_.path().string(), "could not be written to the end",
                           "Check the disk's space.");
  }
  file_.Commit();
}

ResultTables::ResultTables(const std::filesystem::path& folder, TableKinds kinds)
    : forces_(folder / "forces.csv",
              "frame,time_s,force,candidate,status,x_mm,y_mm,z_mm,rest_x_mm,rest_y_mm,rest_z_mm,fx_"
              "N,fy_N,"
              "fz_N,norm_N,sd_x_N,sd_y_N,sd_z_N,sd_location_mm"),
      markers_(folder / "markers.csv",
               "frame,time_s,marker,status,x_mm,y_mm,z_mm,sd_mm,model_x_mm,model_y_mm,model_z_mm,"
               "residual_mm"),
      information_(folder / "information.csv", "frame,time_s,marker,used,information_share"),
      kinds_(kinds) {
  if (kinds.unknown_places) {
    locations_.emplace(folder / "locations.csv",
                       "frame,time_s,force,probability,alternatives,long_mm,short_mm,long_x,long_y,"
                       "long_z");
  }
  if (!kinds.cables && !kinds.chambers) return;
  actuation_.emplace(
      folder / "actuation.csv",
      fmt::format("frame,time_s,actuator{}{}", kinds.cables ? ",tension_N,displacement_mm" : "",
                  kinds.chambers ? ",pressure_kPa" : ""));
}

void ResultTables::Add(const FrameResult& result) {
  const std::string moment = fmt::format("{},{:.6f}", result.frame, result.time_s);
  if (result.forces.empty()) {
    fmt::print(forces_.stream(), "{},,,{},,,,,,,,,,,,,,\n", moment,
               result.ok() ? "none" : estimation::Name(result.status));
  }
  for (const ForceResult& force : result.forces) {
    fmt::print(forces_.stream(), "{},{},{},{},{},{},{},{},{},{}\n", moment, force.identity,
               force.candidate, estimation::Name(result.status), Millimetres(force.position),
               Millimetres(force.rest), Newtons(force.force), Cell(force.force.norm(), 6),
               Newtons(force.covariance.diagonal().cwiseSqrt()), Cell(1e3 * force.PlaceSd(), 4));
  }
  for (const MarkerResult& marker : result.markers) {
    fmt::print(markers_.stream(), "{},{},{},{},{},{},{}\n", moment, marker.id, Name(marker.status),
               Millimetres(marker.measured), Cell(1e3 * marker.sd, 4), Millimetres(marker.model),
               Cell(1e3 * (marker.measured - marker.model).norm(), 4));
    fmt::print(information_.stream(), "{},{},{},{}\n", moment, marker.id, marker.used ? 1 : 0,
               Cell(marker.information, 5));
  }
  forces_.Flush();
  markers_.Flush();
  information_.Flush();
  if (locations_) AddLocations(result, moment);
  if (actuation_) AddActuation(result, moment);
}

void ResultTables::AddLocations(const FrameResult& result, const std::string& moment) {
  if (!result.ok()) return;
  const std::string probability = Cell(result.probability, 6);
  if (result.forces.empty()) {
    fmt::print(locations_->stream(), "{},,{},,,,,,\n", moment, probability);
  }
  for (const ForceResult& force : result.forces) {
    // Across the surface the covariance is 0: the two larger axes lie on it.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(force.place_covariance);
    const Eigen::Vector3d half =
        (geometry::ChiSquareQuantile(0.95, 2) * axes.eigenvalues().cwiseMax(0)).cwiseSqrt();
    const Eigen::Vector3d along = axes.eigenvectors().col(2);
    fmt::print(locations_->stream(), "{},{},{},{},{},{},{},{},{}\n", moment, force.identity,
               probability, fmt::join(force.alternatives, " "), Cell(1e3 * half(2), 4),
               Cell(1e3 * half(1), 4), Cell(along.x(), 5), Cell(along.y(), 5), Cell(along.z(), 5));
  }
  locations_->Flush();
}

void ResultTables::AddActuation(const FrameResult& result, const std::string& moment) {
  for (const CableResult& cable : result.cables) {
    fmt::print(actuation_->stream(), "{},{},{},{}{}\n", moment, cable.name, Cell(cable.tension, 6),
               Cell(1e3 * cable.displacement, 5), kinds_.chambers ? "," : "");
  }
  for (const ChamberResult& chamber : result.chambers) {
    fmt::print(actuation_->stream(), "{},{}{},{}\n", moment, chamber.name,
               kinds_.cables ? ",," : "", Cell(1e-3 * chamber.pressure, 5));
  }
  actuation_->Flush();
}

void ResultTables::Commit() {
  forces_.Commit();
  markers_.Commit();
  information_.Commit();
  if (locations_) locations_->Commit();
  if (actuation_) actuation_->Commit();
}

}  // namespace softforce::pipeline
