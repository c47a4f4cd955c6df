#include "softforce/mesh/disjoint_sets.h"

#include <algorithm>
#include <numeric>

namespace softforce::mesh {

DisjointSets::DisjointSets(int count) : parent_(count) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

int DisjointSets::Root(int a) {
  while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
  return a;
}

void DisjointSets::Join(int a, int b) {
  const auto [low, high] = std::minmax({Root(a), Root(b)});
  parent_[high] = low;
}

std::vector<int> DisjointSets::Numbers() {
  std::vector<int> numbers(parent_.size());
  int next = 0;
  for (int a = 0; a < static_cast<int>(parent_.size()); ++a) {
    const int root = Root(a);  // the least member, so it has its number already
    numbers[a] = root == a ? next++ : numbers[root];
  }
  return numbers;
}

}  // namespace softforce::mesh
