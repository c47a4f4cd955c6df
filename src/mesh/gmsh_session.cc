#include "mesh/gmsh_session.h"

#include <gmsh.h>
#include <omp.h>

#include <algorithm>
#include <clocale>
#include <vector>

namespace softforce::mesh {

GmshSession::GmshSession() : number_format_(std::setlocale(LC_NUMERIC, nullptr)) {
  const int threads = omp_get_max_threads();
  gmsh::initialize(0, nullptr, false);
  omp_set_num_threads(threads);
  std::setlocale(LC_NUMERIC, "C");  // numbers in files have decimal points
  gmsh::option::setNumber("General.Terminal", 0);
}

GmshSession::~GmshSession() {
  gmsh::finalize();
  std::setlocale(LC_NUMERIC, number_format_.c_str());
}

std::string GmshComplaint(const std::function<void()>& step) {
  gmsh::logger::start();
  bool failed = false;
  try {
    step();
  } catch (...) {  // what the SDK throws differs between its versions
    failed = true;
  }
  std::vector<std::string> log;
  gmsh::logger::get(log);
  gmsh::logger::stop();
  std::string errors, last;
  for (const std::string& line : log) {
    if (line.rfind("Error", 0) != 0 || line == last) continue;
    std::size_t start = line.find_first_not_of(": ", 5);  // after "Error: "
    start = std::min(start, line.size());
    const std::size_t end = line.find_last_not_of(" \n") + 1;
    errors += (errors.empty() ? "" : "; ") + line.substr(start, end - std::min(start, end));
    last = line;
  }
  return errors.empty() && failed ? "unknown" : errors;
}

}  // namespace softforce::mesh
