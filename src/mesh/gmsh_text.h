#pragma once

#include <string>
#include <string_view>

#include "mesh/gmsh_file.h"

namespace softforce::mesh {

// What to do with a Gmsh file that is refused.
inline constexpr char kGmshFileAdvice[] =
    "Export it again, or convert it with: gmsh -save -format msh41 IN -o OUT";

// Refuses the sections $Nodes and $Elements of a text file in which a character, a number or a line
// is missing or in excess. Throws InputError naming `where` and the place.
void CheckGmshText(const std::string& where, bool version_4, std::string_view nodes,
                   std::string_view elements, const GmshFileCounts& counts);

}  // namespace softforce::mesh
