#include "softforce/design/choose_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

#include "softforce/base/input_error.h"

namespace softforce::design {
namespace {

constexpr unsigned int kSeed = 1;
constexpr double kLeastGain = 1e-9;  // of the criterion, a logarithm: less is rounding

struct Best {
  int place = -1;
  double value = std::numeric_limits<double>::infinity();
};

// The place that lowers the criterion most on top of `sums`, of those not taken.
Best BestOn(const ExpectedErrors& errors, Criterion criterion,
            const std::vector<ExpectedErrors::Information>& sums, const std::vector<char>& taken) {
  Best best;
  for (int place = 0; place < static_cast<int>(taken.size()); ++place) {
    if (taken[place]) continue;
    const double value = errors.Value(criterion, sums, place);
    if (value < best.value - kLeastGain) best = {place, value};
  }
  return best;
}

// The sums without the k-th place. Summed anew: subtracting would leave rounding behind.
std::vector<ExpectedErrors::Information> Without(const ExpectedErrors& errors,
                                                 const std::vector<int>& places, size_t k) {
  std::vector<int> others = places;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
  return errors.Of(others);
}

std::vector<int> ChooseGreedily(const ExpectedErrors& errors, int count, int num_places,
                                const std::function<void()>& step) {
  std::vector<int> places;
  std::vector<char> taken(num_places, 0);
  std::vector<ExpectedErrors::Information> sums = errors.Start();
  while (static_cast<int>(places.size()) < count) {
    const Best best = BestOn(errors, Criterion::kDOptimal, sums, taken);
    places.push_back(best.place);
    taken[best.place] = 1;
    errors.Add(best.place, &sums);
    step();
  }
  return places;
}

// Marker by marker is put where the criterion is least, until none moves.
void Exchange(const ExpectedErrors& errors, const ChoiceOptions& options, int num_places,
              const std::function<void()>& step, Choice* choice) {
  std::vector<char> taken(num_places, 0);
  for (const int place : choice->places) taken[place] = 1;
  for (int pass = 0; pass < options.max_passes && !choice->settled; ++pass) {
    choice->settled = true;
    for (size_t k = 0; k < choice->places.size(); ++k) {
      int& place = choice->places[k];
      const Best best =
          BestOn(errors, options.criterion, Without(errors, choice->places, k), taken);
      if (best.value < choice->value - kLeastGain) {
        taken[place] = 0;
        taken[best.place] = 1;
        place = best.place;
        choice->value = best.value;
        ++choice->exchanges;
        choice->settled = false;
      }
      step();
    }
  }
}

}  // namespace

void ChoiceOptions::Check() const {
  if (count < 1) throw base::InputError("--count", "must be 1 or more");
  if (among < 0) throw base::InputError("design: among", "must be 0 or more");
  if (more_starts < 0) throw base::InputError("design: more_starts", "must be 0 or more");
  if (max_passes < 0) throw base::InputError("design: max_passes", "must be 0 or more");
}

void CheckRoom(int count, int num_places) {
  if (count <= num_places) return;
  throw base::InputError(
      "--count", fmt::format("asks for {} markers, but there are {} places", count, num_places),
      "Ask for fewer markers, put the places closer (--spacing), or take a larger surface (--on).");
}

Choice ChoosePlaces(const ExpectedErrors& errors, const ChoiceOptions& options,
                    const std::function<void(int)>& tell) {
  options.Check();
  const int num_places = options.among > 0 ? options.among : errors.num_places();
  CheckRoom(options.count, num_places);
  int steps = 0;
  const auto step = [&] {
    if (tell) tell(++steps);
  };
  Choice best;
  best.places = ChooseGreedily(errors, options.count, num_places, step);
  best.greedy = best.value = errors.Value(options.criterion, errors.Of(best.places));
  Exchange(errors, options, num_places, step, &best);
  // An exchange ends in the nearest valley; others may be deeper.
  for (std::vector<int>& start :
       RandomLayouts(num_places, options.count, options.more_starts, kSeed)) {
    Choice other;
    other.places = std::move(start);
    other.greedy = best.greedy;
    other.value = errors.Value(options.criterion, errors.Of(other.places));
    Exchange(errors, options, num_places, step, &other);
    if (other.value < best.value - kLeastGain) best = std::move(other);
  }
  return best;
}

std::vector<std::vector<int>> RandomLayouts(int num_places, int count, int layouts,
                                            unsigned int seed) {
  std::mt19937 random(seed);
  std::vector<int> all(num_places);
  std::iota(all.begin(), all.end(), 0);
  std::vector<std::vector<int>> drawn;
  for (int i = 0; i < layouts; ++i) {
    std::shuffle(all.begin(), all.end(), random);
    drawn.emplace_back(all.begin(), all.begin() + std::min(count, num_places));
  }
  return drawn;
}

}  // namespace softforce::design
