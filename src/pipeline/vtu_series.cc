#include "pipeline/vtu_series.h"

#include <fmt/format.h>

#include "pipeline/result_tables.h"
#include "softforce/base/input_error.h"
#include "softforce/mesh/write_vtu.h"

namespace softforce::pipeline {

VtuSeries::VtuSeries(const std::filesystem::path& folder) : folder_(folder) {
  std::error_code error;
  std::filesystem::create_directories(folder_ / "vtu", error);
  if (error) {
    throw base::InputError((folder_ / "vtu").string(), "cannot be made: " + error.message());
  }
}

void VtuSeries::Add(int frame, double time_s, const mesh::TetMesh& mesh,
                    const Eigen::Matrix3Xd& u) {
  const std::string name = fmt::format("vtu/frame_{:05d}.vtu", frame);
  mesh::WriteVtu(folder_ / name, mesh, {{"displacement_m", u}});
  entries_.push_back(fmt::format("    <DataSet timestep=\"{:.6f}\" file=\"{}\"/>\n", time_s, name));
}

void VtuSeries::Commit() {
  PendingTable pvd(folder_ / "results.pvd", "<?xml version=\"1.0\"?>");
  pvd.stream() << "<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const std::string& entry : entries_) pvd.stream() << entry;
  pvd.stream() << "  </Collection>\n</VTKFile>\n";
  pvd.Commit();
}

}  // namespace softforce::pipeline
