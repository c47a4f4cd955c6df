#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace softforce::fem {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

// Elastic laws by the energy density they stand for, with mu and lambda the Lamé parameters, kappa
// the bulk modulus, F the deformation gradient, J = det F, I1 = tr FᵀF.
enum class MaterialModel {
  kCorotational,  // mu |F − R|² + lambda/2 (tr(RᵀF) − 3)²: Hooke's law in the rotated frame R of F
                  // = RS
  kStVenantKirchhoff,  // mu |E|² + lambda/2 (tr E)², E = (FᵀF − I)/2
  kNeoHookean,  // mu/2 (J^(−2/3) I1 − 3) + kappa/4 (J² − 1 − 2 ln J): deviatoric and volumetric
                // part split
  kNeoHookeanLogarithmic  // mu/2 (I1 − 3) − mu ln J + lambda/2 (ln J)²
};

// The name in scene files ("neo_hookean"), and back; nothing for an unknown name.
const char* Name(MaterialModel model);
std::optional<MaterialModel> MaterialModelByName(const std::string& name);

// Whether the energy grows without bound as J → 0, so that no cell can turn inside out.
bool HasBarrier(MaterialModel model);

struct Material {
  MaterialModel model = MaterialModel::kNeoHookean;
  double youngs_modulus = NAN;  // Pa, at small strain; > 0
  double poissons_ratio = NAN;  // [0, 0.5)

  double mu() const { return youngs_modulus / (2 * (1 + poissons_ratio)); }  // Pa
  double lambda() const {                                                    // Pa
    return youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio));
  }
  double kappa() const { return youngs_modulus / (3 * (1 - 2 * poissons_ratio)); }  // Pa

  // Throws InputError naming `where` for values outside the ranges above.
  void Check(const std::string& where) const;
};

// Energy density (J/m³), first Piola–Kirchhoff stress P = ∂energy/∂F (Pa) and, if asked, the
// elasticity ∂P/∂F with index 3·column + row in both directions (Pa).
struct MaterialResponse {
  double energy = NAN;
  Eigen::Matrix3d P = Eigen::Matrix3d::Constant(NAN);
  Matrix9d dPdF = Matrix9d::Constant(NAN);  // only if asked for
  bool valid = false;  // false where the law has no value: J ≤ 0 for the neo-Hookean laws
};

MaterialResponse Evaluate(const Material& material, const Eigen::Matrix3d& F, bool with_elasticity);

}  // namespace softforce::fem
