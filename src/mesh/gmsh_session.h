#pragma once

#include <functional>
#include <string>

namespace softforce::mesh {

// Gmsh at work: silent and without the user's configuration. Gmsh sets the number format of the
// locale and the number of OpenMP threads for the whole program; both are put back. One session at
// a time.
class GmshSession {
 public:
  GmshSession();
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

 private:
  std::string number_format_;
};

// Runs one step of Gmsh's work and returns what it complained about: empty if all went well,
// otherwise its error messages in one line ("unknown" if it failed without any).
std::string GmshComplaint(const std::function<void()>& step);

}  // namespace softforce::mesh
