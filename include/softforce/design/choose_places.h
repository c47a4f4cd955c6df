#pragma once

#include <functional>
#include <vector>

#include "softforce/design/expected_errors.h"

namespace softforce::design {

struct ChoiceOptions {
  int count = 9;  // markers
  int among = 0;  // the first so many places; 0: all
  Criterion criterion = Criterion::kLocation;
  int max_passes = 20;  // of an exchange, over all markers
  int more_starts = 5;  // exchanges that begin with random places instead of the greedy choice

  void Check() const;  // throws InputError naming the option
};

// Throws InputError if there are fewer places than markers asked for.
void CheckRoom(int count, int num_places);

struct Choice {
  std::vector<int> places;
  double greedy = NAN;   // the criterion of the greedy choice
  double value = NAN;    // and of this one
  int exchanges = 0;     // that led here
  bool settled = false;  // no single exchange lowers the criterion any more

  bool ok() const { return !places.empty(); }
};

// Chooses marker places: first greedily, the place that tells most on top of the ones before, by
// log det (a single marker says too little about a place to be chosen by it); then marker by marker
// is taken away and put where the criterion is least, until none moves (exchange). The best of that
// and of exchanges from random places. The same input gives the same choice. `tell` is called with
// the number of steps done: greedy ones, and markers looked at in exchanges.
// Throws InputError if there are fewer places than markers asked for.
Choice ChoosePlaces(const ExpectedErrors& errors, const ChoiceOptions& options,
                    const std::function<void(int)>& tell = {});

// `count` of the places at random, each layout by itself: what no thought gives.
std::vector<std::vector<int>> RandomLayouts(int num_places, int count, int layouts,
                                            unsigned int seed);

}  // namespace softforce::design
