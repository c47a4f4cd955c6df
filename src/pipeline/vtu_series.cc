#include "pipeline/vtu_series.h"

#include <fmt/format.h>

#include "pipeline/result_tables.h"
#include "softforce/base/input_error.h"
#include "softforce/fem/stress.h"
#include "softforce/mesh/write_vtu.h"

namespace softforce::pipeline {
namespace {

void WriteForces(const std::filesystem::path& file, const std::vector<ForceResult>& forces) {
  const auto count = static_cast<Eigen::Index>(forces.size());
  Eigen::Matrix3Xd places(3, count), vectors(3, count);
  Eigen::MatrixXd identity(1, count), sd(1, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const ForceResult& force = forces[static_cast<size_t>(i)];
    places.col(i) = force.position;
    vectors.col(i) = force.force;
    identity(i) = force.identity;
    sd(i) = force.NormSd();
  }
  mesh::WritePointsVtu(file, places, {{"force_N", vectors}, {"sd_N", sd}, {"force", identity}});
}

// Where they were seen, else where the model has them.
void WriteMarkers(const std::filesystem::path& file, const std::vector<MarkerResult>& markers) {
  const auto count = static_cast<Eigen::Index>(markers.size());
  Eigen::Matrix3Xd places(3, count), residual(3, count);
  Eigen::MatrixXd id(1, count), status(1, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const MarkerResult& marker = markers[static_cast<size_t>(i)];
    const bool measured = marker.measured.allFinite();
    places.col(i) = measured ? marker.measured : marker.model;
    residual.col(i) = places.col(i) - marker.model;
    id(i) = marker.id;
    status(i) = static_cast<int>(marker.status);
  }
  mesh::WritePointsVtu(file, places,
                       {{"residual_m", residual}, {"marker", id}, {"status", status}});
}

}  // namespace

VtuSeries::VtuSeries(const std::filesystem::path& folder) : folder_(folder) {
  std::error_code error;
  std::filesystem::create_directories(folder_ / "vtu", error);
  if (error) {
    throw base::InputError((folder_ / "vtu").string(), "cannot be made: " + error.message());
  }
}

// Times in the file's own unit, seconds.
void VtuSeries::Bind(const FrameInWork& frame, int part, const std::string& file) {
  entries_.push_back(fmt::format("    <DataSet timestep=\"{:.6f}\" part=\"{}\" file=\"{}\"/>\n",
                                 frame.result.time_s, part, file));
}

void VtuSeries::Add(const FrameInWork& frame, const fem::Body& body) {
  const auto name = [&](const char* what) {
    return fmt::format("vtu/{}_{:05d}.vtu", what, frame.result.frame);
  };
  const Eigen::VectorXd stress = fem::NodalVonMises(body, frame.u);
  mesh::WriteVtu(folder_ / name("frame"), body.mesh,
                 {{"displacement_m", frame.u}, {"von_mises_Pa", stress.transpose()}});
  WriteForces(folder_ / name("forces"), frame.result.forces);
  WriteMarkers(folder_ / name("markers"), frame.result.markers);
  Bind(frame, 0, name("frame"));
  Bind(frame, 1, name("forces"));
  Bind(frame, 2, name("markers"));
}

void VtuSeries::Commit() {
  PendingTable pvd(folder_ / "results.pvd", "<?xml version=\"1.0\"?>");
  pvd.stream() << "<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const std::string& entry : entries_) pvd.stream() << entry;
  pvd.stream() << "  </Collection>\n</VTKFile>\n";
  pvd.Commit();
}

}  // namespace softforce::pipeline
