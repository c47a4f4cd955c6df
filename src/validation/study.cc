#include "softforce/validation/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "softforce/base/input_error.h"
#include "softforce/validation/paper_figures.h"

namespace softforce::validation {
namespace {

void RefuseUnknownLayouts(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Layout& layout : SheetLayouts()) known.push_back(layout.name);
  for (const Layout& layout : RobotLayouts()) known.push_back(layout.name);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw base::InputError(
        "--cases", fmt::format("got \"{}\", must be among {}", name, fmt::join(known, " ")));
  }
}

std::vector<Layout> Chosen(std::vector<Layout> layouts, const std::vector<std::string>& names) {
  const auto not_chosen = [&](const Layout& layout) {
    return !names.empty() && std::find(names.begin(), names.end(), layout.name) == names.end();
  };
  layouts.erase(std::remove_if(layouts.begin(), layouts.end(), not_chosen), layouts.end());
  return layouts;
}

// Those for which the paper's Tables II and III have figures.
std::vector<Layout> OfTablesTwoAndThree(const std::vector<Layout>& layouts) {
  std::vector<Layout> some;
  std::copy_if(layouts.begin(), layouts.end(), std::back_inserter(some),
               [](const Layout& layout) { return !FiguresOf(layout.name).modulus.empty(); });
  return some;
}

}  // namespace

void StudyOptions::Check() const {
  if (frames < 1) {
    throw base::InputError("--frames", fmt::format("got {}, must be 1 or more", frames));
  }
  if (threads < 1) {
    throw base::InputError("--threads", fmt::format("got {}, must be 1 or more", threads));
  }
  RefuseUnknownLayouts(layouts);
}

Study RunStudy(const StudyOptions& options) {
  options.Check();
  for (const BodyKind body : {BodyKind::kSheet, BodyKind::kRobot}) {
    ReadBodyMesh(body, options.meshes);  // refuses what is missing before minutes of work
  }
  Study study;
  for (const BodyKind body : {BodyKind::kSheet, BodyKind::kRobot}) {
    const std::vector<Layout> layouts =
        Chosen(body == BodyKind::kSheet ? SheetLayouts() : RobotLayouts(), options.layouts);
    if (layouts.empty()) continue;
    const mesh::TetMesh given = mesh::RaiseOrder(ReadBodyMesh(body, options.meshes));
    for (ExactCase& exact : RunExact(body, given, layouts, options)) {
      study.exact.push_back(std::move(exact));
    }
    const std::vector<Layout> some = OfTablesTwoAndThree(layouts);
    if (some.empty()) continue;
    const Discretisations meshes = MakeDiscretisations(body, options.meshes);
    study.meshes.push_back({body, meshes.given.num_elements(), meshes.inverse.num_elements(),
                            meshes.truth.num_elements()});
    for (InexactCase& inexact : RunInexact(body, meshes, some, options)) {
      study.inexact.push_back(std::move(inexact));
    }
  }
  return study;
}

}  // namespace softforce::validation
