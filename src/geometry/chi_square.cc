#include "softforce/geometry/chi_square.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <cassert>

namespace softforce::geometry {

double ChiSquareQuantile(double probability, int degrees_of_freedom) {
  assert(probability > 0 && probability < 1 && degrees_of_freedom >= 1);
  return boost::math::quantile(boost::math::chi_squared(degrees_of_freedom), probability);
}

}  // namespace softforce::geometry
