#pragma once

#include <vector>

namespace softforce::mesh {

// Sets of numbers 0 … count − 1 that grow together.
class DisjointSets {
 public:
  explicit DisjointSets(int count);
  void Join(int a, int b);
  // The set of each number: sets are counted from 0 in the order of their least members.
  std::vector<int> Numbers();

 private:
  int Root(int a);
  std::vector<int> parent_;
};

}  // namespace softforce::mesh
