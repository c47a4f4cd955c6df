#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include "mesh/generate.h"
#include "mesh/gmsh_session.h"
#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

using base::InputError;

constexpr char kAdvice[] = "Export it again, as a solid.";

// OpenCASCADE reads on for ever where some text files are cut off.
void RefuseIfCutOff(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string where = path.string();
  if (!file) throw InputError(where, "cannot be read", "Check the file's permissions.");
  const auto has = [&](const char* words) { return text.find(words) != std::string::npos; };
  const auto refuse = [&](const char* kind, const char* missing) {
    throw InputError(where, fmt::format("is not a whole {} file: it has no {}", kind, missing),
                     kAdvice);
  };

  if (LowerExtension(path) != ".brep") {
    for (const char* words : {"ISO-10303-21;", "END-ISO-10303-21;"}) {
      if (!has(words)) refuse("STEP", words);
    }
    return;
  }
  if (!has("CASCADE Topology")) refuse("BREP", "line \"CASCADE Topology …\"");
  if (!has("\nTShapes ")) refuse("BREP", "section TShapes");
  // The last line says which of the shapes before it is the whole: "+1 0". Each of those ends with
  // an asterisk, the lines in between with numbers only.
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  const std::size_t start = text.find_last_of('\n', end) + 1;
  const std::string last = text.substr(start, end + 1 - start);
  const std::size_t before = text.find_last_not_of(" \t\r\n", start - 1);
  const bool whole = (last[0] == '+' || last[0] == '-') && before != std::string::npos &&
                     text[before] == '*' && last.find('*') == std::string::npos;
  if (!whole) refuse("BREP", "last line such as \"+1 0\"");
}

gmsh::vectorpair Solids() {
  gmsh::vectorpair solids;
  gmsh::model::getEntities(solids, 3);
  return solids;
}

double VolumeOf(const gmsh::vectorpair& solids) {
  double sum = 0;
  const std::string problem = GmshComplaint([&] {
    for (const auto& solid : solids) {
      double volume = 0;
      gmsh::model::occ::getMass(3, solid.second, volume);
      sum += volume;
    }
  });
  return problem.empty() ? sum : NAN;  // solids of Gmsh's built-in kernel have no volume
}

}  // namespace

double LoadCad(const std::filesystem::path& path) {
  RefuseIfCutOff(path);
  const std::string where = path.string();
  gmsh::vectorpair shapes;
  const std::string problem = GmshComplaint([&] {
    gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
    gmsh::model::occ::importShapes(where, shapes);
    gmsh::model::occ::synchronize();
  });
  if (!problem.empty()) {
    throw InputError(where, fmt::format("OpenCASCADE cannot read it ({})", problem), kAdvice);
  }
  gmsh::vectorpair solids = Solids();
  if (solids.empty()) {
    throw InputError(where,
                     shapes.empty() ? "has no solid" : "has no solid, only surfaces or curves",
                     "Sew the surfaces into a solid in your CAD program, and export it again.");
  }
  if (solids.size() > 1) {  // solids that touch shall share faces, and so nodes
    const std::string complaint = GmshComplaint([&] {
      gmsh::vectorpair pieces;
      std::vector<gmsh::vectorpair> origin;
      gmsh::model::occ::fragment({solids[0]}, {solids.begin() + 1, solids.end()}, pieces, origin);
      gmsh::model::occ::synchronize();
    });
    if (!complaint.empty()) {
      throw InputError(where,
                       fmt::format("its {} solids cannot be joined ({})", solids.size(), complaint),
                       "Unite them in your CAD program.");
    }
    solids = Solids();
  }
  return VolumeOf(solids);
}

double LoadGeoScript(const std::filesystem::path& path) {
  const std::string where = path.string();
  if (const std::string problem = GmshComplaint([&] { gmsh::open(where); }); !problem.empty()) {
    throw InputError(where, fmt::format("Gmsh refuses the script ({})", problem),
                     "Correct the script; open it in Gmsh to see more.");
  }
  gmsh::vectorpair solids = Solids();
  if (solids.empty()) {
    throw InputError(where, "the script makes no volume",
                     "In Gmsh, a body needs for example: Surface Loop, then Volume.");
  }
  return VolumeOf(solids);
}

}  // namespace softforce::mesh
