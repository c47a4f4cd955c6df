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
    contraction_ = steps_ > 0 ? root / root_ : std::numeric_limits<double>::infinity();
    if (root > 0) softness_ = std::max(softness_, move / root);
    root_ = root;
    ++steps_;
  }

  int steps() const { return steps_; }

  // m; how far a node may still move after the last step. Infinite while the iteration does not
  // contract, and before the third step: the first one shows what the load has changed, so that
  // the second alone tells little of how the iteration contracts.
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
  double root_ = 0;      // √J, of the last step
  double softness_ = 0;  // m/√J
  double contraction_ = std::numeric_limits<double>::infinity();
};

}  // namespace softforce::fem
