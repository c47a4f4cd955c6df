// Solves a scene's body under given loads with softforce, and writes what CalculiX needs to solve
// the same: OUT/model.inp, the body, and OUT/case.json, the loads and softforce's answer (mm, N).
// compare_with_calculix, beside this file, does the rest.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>

#include "accuracy/calculix_model.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"
#include "softforce/pipeline/world.h"

namespace softforce::benchmarks {
namespace {

using nlohmann::json;

constexpr double kMmPerM = 1e3;

struct Request {
  std::string scene, out, mesh, model, youngs_modulus;
  std::vector<std::string> forces;  // "ID FX FY FZ", N
  double tension = 0;               // N, of each cable
  double shortening = NAN;          // mm, of each cable; instead of the tension
  bool linear = false;
};

scene::Scene LoadChangedScene(const Request& request) {
  scene::Scene scene = scene::LoadScene(request.scene);
  if (!request.mesh.empty()) scene.mesh.file = request.mesh;
  for (auto& [region, material] : scene.materials) {
    if (!request.youngs_modulus.empty()) {
      material.youngs_modulus = base::ParseQuantity(
          request.youngs_modulus, base::Dimension::kPressure, 1, "--youngs-modulus")[0];
    }
    if (request.model.empty()) continue;
    const auto model = fem::MaterialModelByName(request.model);
    if (!model) throw base::InputError("--model", "unknown law \"" + request.model + "\"");
    material.model = *model;
  }
  if (scene.gravity.norm() > 0) {
    throw base::InputError(request.scene + ": gravity", "is not carried over to CalculiX",
                           "Compare without gravity.");
  }
  return scene;
}

// A force at one place of the body.
struct Load {
  mesh::NodalWeights at;
  Eigen::Vector3d force;  // N
};

std::vector<Load> ReadLoads(const Request& request, const pipeline::World& world) {
  std::vector<Load> loads;
  for (const std::string& text : request.forces) {
    const std::vector<double> numbers =
        base::ParseQuantity(text, base::Dimension::kNumber, 4, "--force");
    const std::string id = fmt::format("{}", numbers[0]);
    const auto site = std::find_if(world.sites.begin(), world.sites.end(),
                                   [&](const auto& each) { return each.name == id; });
    if (site == world.sites.end()) {
      throw base::InputError("--force", "the scene has no candidate with id " + id);
    }
    loads.push_back({site->at, {numbers[1], numbers[2], numbers[3]}});
  }
  return loads;
}

fem::LoadCase LoadCaseOf(const Request& request, const std::vector<Load>& loads,
                         const pipeline::World& world) {
  fem::LoadCase load_case;
  load_case.actuation = fem::NoActuation(world.solver->body());
  load_case.forces = Eigen::Matrix3Xd::Zero(3, world.mesh().num_nodes());
  for (const Load& load : loads) {
    for (size_t i = 0; i < load.at.nodes.size(); ++i) {
      load_case.forces.col(load.at.nodes[i]) += load.at.weights[i] * load.force;
    }
  }
  fem::CableCommand command{fem::CableInput::kTension, request.tension};
  if (!std::isnan(request.shortening)) {
    command = {fem::CableInput::kDisplacement, request.shortening / kMmPerM};
  }
  load_case.actuation.cables.assign(world.solver->body().cables.size(), command);
  return load_case;
}

// The equilibrium, or with `linear` the first-order answer of the body at rest.
fem::Equilibrium Solve(const Request& request, const fem::LoadCase& load, pipeline::World* world) {
  fem::Equilibrium state = world->solver->AtRest();
  if (request.linear) {
    const Eigen::Map<const Eigen::VectorXd> forces(load.forces.data(), load.forces.size());
    const fem::Sensitivity answer = world->solver->Solve(state, forces, 0);
    Eigen::Map<Eigen::VectorXd>(state.u.data(), state.u.size()) = answer.du.col(0);
    return state;
  }
  const fem::SolveSummary summary = world->solver->Solve(load, &state);
  if (!summary.ok()) throw base::InputError(request.scene, summary.BriefReport());
  return state;
}

json ToJson(const mesh::NodalWeights& at) {
  json nodes = json::array();
  for (const int node : at.nodes) nodes.push_back(node + 1);
  return {{"nodes", nodes}, {"weights", at.weights}};
}

json ToJson(const Eigen::Matrix3Xd& field) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < field.cols(); ++i) {
    rows.push_back({field(0, i), field(1, i), field(2, i)});
  }
  return rows;
}

json CablesToJson(const fem::Body& body, const fem::Equilibrium& state) {
  json cables = json::array();
  for (size_t c = 0; c < body.cables.size(); ++c) {
    const fem::Cable& cable = body.cables[c];
    json points = json::array();
    for (const mesh::NodalWeights& point : cable.points) points.push_back(ToJson(point));
    const Eigen::Vector3d guide = kMmPerM * cable.guide;
    cables.push_back({{"name", cable.name},
                      {"points", points},
                      {"guide", {guide.x(), guide.y(), guide.z()}},
                      {"tension", state.tension(static_cast<Eigen::Index>(c))},
                      {"shortening", kMmPerM * state.shortening(static_cast<Eigen::Index>(c))}});
  }
  return cables;
}

void Export(const Request& request) {
  const scene::Scene scene = LoadChangedScene(request);
  pipeline::World world = pipeline::BuildWorld(scene);
  const fem::Body& body = world.solver->body();
  const std::filesystem::path out = request.out;
  std::filesystem::create_directories(out);
  WriteCalculixModel(out / "model.inp", body, request.linear, request.scene);

  const std::vector<Load> loads = ReadLoads(request, world);
  const fem::LoadCase load_case = LoadCaseOf(request, loads, world);
  const fem::Equilibrium state = Solve(request, load_case, &world);
  json places = json::array();
  for (const Load& load : loads) {
    places.push_back(ToJson(load.at));
    places.back()["force"] = {load.force.x(), load.force.y(), load.force.z()};
  }
  json markers = json::array();
  for (const pipeline::BodyPoint& marker : world.markers) markers.push_back(ToJson(marker.weights));
  const json record = {{"mesh", scene.mesh.file.string()},
                       {"cells", body.mesh.num_elements()},
                       {"linear", request.linear},
                       {"rest", ToJson(kMmPerM * body.mesh.nodes)},
                       {"displacement", ToJson(kMmPerM * state.u)},
                       {"forces", ToJson(load_case.forces)},
                       {"cables", CablesToJson(body, state)},
                       {"loaded", places},
                       {"markers", markers}};
  std::ofstream file(out / "case.json");
  file << record << '\n';
  if (!file) throw base::InputError((out / "case.json").string(), "cannot be written");
}

int RunProgram(int argc, char** argv) {
  Request request;
  CLI::App program{"Solves a case with softforce and writes it for CalculiX"};
  program.add_option("scene", request.scene, "scene.yaml")->required()->check(CLI::ExistingFile);
  program.add_option("--out", request.out, "folder to write model.inp and case.json to")
      ->required();
  program.add_option("--mesh", request.mesh, "mesh to take instead of the scene's, same unit")
      ->check(CLI::ExistingFile);
  program.add_option("--model", request.model, "elastic law instead of the scene's");
  program.add_option("--youngs-modulus", request.youngs_modulus,
                     "instead of the scene's, with unit, for example \"300 kPa\"");
  program
      .add_option("--force", request.forces,
                  "force at a candidate of the scene: \"ID FX FY FZ\", N; may be repeated")
      ->allow_extra_args(false);
  program.add_option("--tension", request.tension, "of every cable, N")->capture_default_str();
  program.add_option("--shortening", request.shortening,
                     "of every cable, mm, instead of a tension");
  program.add_flag("--linear", request.linear,
                   "the first-order answer of the body at rest; cables are left slack");
  CLI11_PARSE(program, argc, argv);
  Export(request);
  return 0;
}

}  // namespace
}  // namespace softforce::benchmarks

int main(int argc, char** argv) {
  try {
    return softforce::benchmarks::RunProgram(argc, argv);
  } catch (const softforce::base::InputError& error) {
    fmt::print(stderr, "export_to_calculix: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {  // out of memory, a full disk: not the user's input
    fmt::print(stderr, "export_to_calculix: unexpected: {}\n", error.what());
    return 1;
  }
}
