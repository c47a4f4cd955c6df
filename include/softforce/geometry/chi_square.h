#pragma once

namespace softforce::geometry {

// The value that a χ² variable of `degrees_of_freedom` ≥ 1 stays below with the given probability
// in (0, 1).
double ChiSquareQuantile(double probability, int degrees_of_freedom);

}  // namespace softforce::geometry
