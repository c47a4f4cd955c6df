#include "accuracy/calculix_model.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include "softforce/base/input_error.h"

namespace softforce::benchmarks {
namespace {

constexpr double kMmPerM = 1e3;
constexpr double kMpaPerPa = 1e-6;

// CalculiX reads 20 characters of a number: 12 digits leave room for sign and exponent.
void WriteNodes(const mesh::TetMesh& mesh, fmt::ostream& out) {
  out.print("*NODE, NSET=ALL\n");
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    const Eigen::Vector3d X = kMmPerM * mesh.nodes.col(n);
    out.print("{},{:.12g},{:.12g},{:.12g}\n", n + 1, X.x(), X.y(), X.z());
  }
}

void WriteCells(const mesh::TetMesh& mesh, int region, fmt::ostream& out) {
  out.print("*ELEMENT, TYPE=C3D10, ELSET=REGION{}\n", region);
  for (int e = 0; e < mesh.num_elements(); ++e) {
    if (mesh.region[e] != region) continue;
    out.print("{}", e + 1);
    for (int i = 0; i < 10; ++i) out.print(",{}", mesh.elements(i, e) + 1);
    out.print("\n");
  }
}

void WriteMaterial(const fem::Material& material, int region, bool linear, fmt::ostream& out) {
  out.print("*MATERIAL, NAME=MATERIAL{}\n", region);
  if (linear || material.model == fem::MaterialModel::kStVenantKirchhoff) {
    out.print("*ELASTIC\n{:.12g},{:.12g}\n", kMpaPerPa * material.youngs_modulus,
              material.poissons_ratio);
  } else {
    out.print("*HYPERELASTIC, NEO HOOKE\n{:.12g},{:.12g}\n", kMpaPerPa * material.mu() / 2,
              2 / (kMpaPerPa * material.kappa()));
  }
  out.print("*SOLID SECTION, ELSET=REGION{0}, MATERIAL=MATERIAL{0}\n", region);
}

}  // namespace

bool CalculixHasLaw(fem::MaterialModel model) {
  return model == fem::MaterialModel::kNeoHookean ||
         model == fem::MaterialModel::kStVenantKirchhoff;
}

void WriteCalculixModel(const std::filesystem::path& file, const fem::Body& body, bool linear,
                        const std::string& where) {
  if (body.mesh.order() != 2) {
    throw base::InputError(where, "got 4-node cells, expected 10-node cells",
                           "Write \"order: 2\" in the scene.");
  }
  for (const fem::Material& material : body.materials) {
    if (linear || CalculixHasLaw(material.model)) continue;
    throw base::InputError(
        where, fmt::format("CalculiX has no law like \"{}\"", fem::Name(material.model)),
        "Choose neo_hookean or st_venant_kirchhoff (--model), or --linear.");
  }
  fmt::ostream out = fmt::output_file(file.string());
  WriteNodes(body.mesh, out);
  for (size_t region = 0; region < body.materials.size(); ++region) {
    WriteCells(body.mesh, static_cast<int>(region), out);
    WriteMaterial(body.materials[region], static_cast<int>(region), linear, out);
  }
  out.print("*BOUNDARY\n");
  for (const int node : body.fixed_nodes) out.print("{},1,3\n", node + 1);
}

}  // namespace softforce::benchmarks
