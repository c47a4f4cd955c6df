#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace softforce::fem {

// Judges from the steps of an iteration how far it still has to go. The steps' energies −r · du
// fall evenly, where the largest movement of a node does not: on thin bodies steps that bend
// alternate with steps that stretch. The softest movement seen per square root of energy turns
// what is left of the energy into metres.
class Progress {
 public:
  void Add(double move, double energy) {  // m, J
    const double root = std::sqrt(std::max(0.0, energy));
    const double contraction = steps_ > 0 ? root / root_ : 0;
    contraction_ = std::max(contraction, last_contraction_);
    last_contraction_ = contraction;
    if (root > 0) softness_ = std::max(softness_, move / root);
    root_ = root;
    ++steps_;
  }

  int steps() const { return steps_; }

  // m; how far a node may still move after the last step. Infinite while the iteration does not
  // contract, and before the third step: how the first one, with a tangent made for it, contracted
  // says little of the next ones.
  double remaining() const {
    if (steps_ < 3 || !(contraction_ < 1)) return std::numeric_limits<double>::infinity();
    return softness_ * root_ * contraction_ / (1 - contraction_);
  }

  // How many more steps will bring what remains below `tolerance` (m).
  double steps_left(double tolerance) const {
    if (steps_ < 3) return 1;
    if (!(contraction_ < 1)) return std::numeric_limits<double>::infinity();
    return std::max(0.0, std::log(tolerance / remaining()) / std::log(contraction_));
  }

 private:
  int steps_ = 0;
  double root_ = 0;                                // √J, of the last step
  double softness_ = 0;                            // m/√J
  double contraction_ = 0, last_contraction_ = 0;  // the former is the worse of the last two
};

}  // namespace softforce::fem
