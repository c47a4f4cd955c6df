#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "softforce/validation/discretisation.h"
#include "softforce/validation/inverse_model.h"
#include "softforce/validation/layout.h"

namespace softforce::validation {

// What the inverse models of Tables II and III have wrong (paper VI.C).
inline constexpr std::array<double, 3> kWrongModuli{280e3, 260e3, 240e3};  // Pa, instead of 300 kPa
inline constexpr std::array<double, 3> kMarkerShifts{5e-5, 1e-4, 1.5e-4};  // m, along z
inline constexpr std::array<double, 3> kTensionErrors{0.1, 0.15, 0.2};     // N, of each cable

struct StudyOptions {
  std::filesystem::path meshes;      // folder of sheet.msh, robot.msh and their .geo
  std::vector<std::string> layouts;  // names; empty: all sixteen
  // In how many frames the loads of the linear method grow: two seconds of the paper's sheet; and
  // before them those of the robot's cables.
  int frames = 32;
  int threads = 2;
  bool show_progress = true;

  void Check() const;  // throws InputError naming the option
};

// A line of Table I.
struct ExactCase {
  Layout layout;
  double I_w = NAN;        // N/m
  double converged = NAN;  // I_e, N
  double linear = NAN;     // I_e of the paper's method, N
};

// What was found with three sizes of one error, I_e in N. NaN: no answer.
using Errors = std::array<double, 3>;

// A layout of Table II or III.
struct InexactCase {
  Layout layout;
  double alone = NAN;  // plain least squares, nothing wrong but the discretisation
  Errors modulus{}, markers{}, tension{};  // plain least squares; `tension`: robot only
  // Of the remedies. What calibration takes away does not depend on how much it was: one figure.
  ForceErrors remedied_alone;  // nothing wrong but the discretisation
  ForceErrors modulus_remedied, tension_remedied;
  std::array<ForceErrors, 3> markers_remedied;
  std::array<ForceErrors, 3> markers_untared;  // robot: without the frame before the forces
  double youngs_modulus = NAN;                 // Pa, as identified from the worst of kWrongModuli
};

struct Study {
  std::vector<ExactCase> exact;
  std::vector<InexactCase> inexact;
  struct BodyMeshes {
    BodyKind body;
    int given = 0, inverse = 0, truth = 0;  // cells
  };
  std::vector<BodyMeshes> meshes;  // of the bodies in `inexact`
};

// Table I for the chosen layouts of a body: its direct models are computed on the same mesh.
std::vector<ExactCase> RunExact(BodyKind body, const mesh::TetMesh& mesh,
                                const std::vector<Layout>& layouts, const StudyOptions& options);

// Table II or III for the chosen layouts of a body.
std::vector<InexactCase> RunInexact(BodyKind body, const Discretisations& meshes,
                                    const std::vector<Layout>& layouts,
                                    const StudyOptions& options);

// The simulated study of the paper (VI). Throws InputError for meshes that are missing or of no
// use, and for layouts that do not exist.
Study RunStudy(const StudyOptions& options);

}  // namespace softforce::validation
