#include "softforce/design/choose_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "design/plate.h"
#include "softforce/base/input_error.h"

namespace softforce::design {
namespace {

ChoiceOptions Markers(int count) {
  ChoiceOptions options;
  options.count = count;
  return options;
}

double ValueOf(const ExpectedErrors& errors, const std::vector<int>& places) {
  return errors.Value(Criterion::kLocation, errors.Of(places));
}

TEST(ChoosePlaces, TheExchangeIsNoWorseThanTheGreedyChoice) {
  testing::Plate plate;
  const ExpectedErrors errors = plate.Errors();

  const Choice choice = ChoosePlaces(errors, Markers(5));

  EXPECT_LE(choice.value, choice.greedy);
  EXPECT_TRUE(choice.settled);
  EXPECT_NEAR(choice.value, ValueOf(errors, choice.places), 1e-9);  // rounding of the sums
  EXPECT_EQ(std::set<int>(choice.places.begin(), choice.places.end()).size(), 5u);
}

TEST(ChoosePlaces, NoSingleExchangeIsBetter) {
  testing::Plate plate;
  const ExpectedErrors errors = plate.Errors();
  const Choice choice = ChoosePlaces(errors, Markers(4));

  for (size_t k = 0; k < choice.places.size(); ++k) {
    for (int place = 0; place < errors.num_places(); ++place) {
      std::vector<int> other = choice.places;
      if (std::count(other.begin(), other.end(), place) > 0) continue;
      other[k] = place;
      EXPECT_GE(ValueOf(errors, other), choice.value - 1e-8) << k << ' ' << place;  // rounding
    }
  }
}

TEST(ChoosePlaces, MoreMarkersTellMore) {
  testing::Plate plate;
  const ExpectedErrors errors = plate.Errors();
  ChoiceOptions options = Markers(2);
  // The greedy choice alone: each is the one before and one more.
  options.max_passes = options.more_starts = 0;
  double before = INFINITY;
  std::vector<int> chosen;
  for (; options.count <= 8; ++options.count) {
    const Choice choice = ChoosePlaces(errors, options);
    EXPECT_LT(choice.value, before) << options.count;
    EXPECT_TRUE(std::equal(chosen.begin(), chosen.end(), choice.places.begin()));
    before = choice.value;
    chosen = choice.places;
  }
}

TEST(ChoosePlaces, APlaceOnTheClampIsNotChosen) {
  testing::Plate plate;
  const int first_held = static_cast<int>(plate.points.size());
  for (const double y : {5e-3, 20e-3, 40e-3, 55e-3}) plate.AddPlace({0, y, 4e-3});
  const ExpectedErrors errors = plate.Errors();

  const Choice choice = ChoosePlaces(errors, Markers(8));

  for (const int place : choice.places) EXPECT_LT(place, first_held);
}

TEST(ChoosePlaces, BeatsEveryOneOfFiftyRandomLayouts) {
  testing::Plate plate;
  const ExpectedErrors errors = plate.Errors();
  const Choice choice = ChoosePlaces(errors, Markers(4));

  for (const auto& layout : RandomLayouts(errors.num_places(), 4, 50, 3)) {
    EXPECT_LT(choice.value, ValueOf(errors, layout));
  }
}

TEST(ChoosePlaces, MoreStartsAreNoWorse) {
  testing::Plate plate;
  const ExpectedErrors errors = plate.Errors();
  ChoiceOptions options = Markers(4);
  options.more_starts = 0;
  const Choice one = ChoosePlaces(errors, options);
  options.more_starts = 3;

  EXPECT_LE(ChoosePlaces(errors, options).value, one.value);
}

TEST(ChoosePlaces, StaysAmongTheFirstPlacesIfToldTo) {
  testing::Plate plate;
  ChoiceOptions options = Markers(4);
  options.among = 10;

  for (const int place : ChoosePlaces(plate.Errors(), options).places) EXPECT_LT(place, 10);
}

TEST(ChoosePlaces, IsTheSameEachTime) {
  testing::Plate plate;
  EXPECT_EQ(ChoosePlaces(plate.Errors(), Markers(6)).places,
            ChoosePlaces(plate.Errors(), Markers(6)).places);
}

TEST(ChoosePlaces, ByLogDetIsBestByLogDet) {
  testing::Plate plate;
  const ExpectedErrors errors = plate.Errors();
  ChoiceOptions options = Markers(4);
  const Choice by_location = ChoosePlaces(errors, options);
  options.criterion = Criterion::kDOptimal;
  const Choice by_det = ChoosePlaces(errors, options);

  EXPECT_LE(by_det.value,
            errors.Value(Criterion::kDOptimal, errors.Of(by_location.places)) + 1e-9);  // rounding
}

TEST(ChoosePlaces, RefusesMoreMarkersThanPlaces) {
  testing::Plate plate;
  const ExpectedErrors errors = plate.Errors();
  try {
    ChoosePlaces(errors, Markers(36));
    FAIL() << "no refusal";
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("asks for 36 markers, but there are 35 places"),
              std::string::npos)
        << error.what();
  }
}

TEST(ChoosePlaces, RefusesOptionsOutOfRange) {
  ChoiceOptions options = Markers(0);
  EXPECT_THROW(options.Check(), base::InputError);
  options = Markers(3);
  options.max_passes = -1;
  EXPECT_THROW(options.Check(), base::InputError);
  options = Markers(3);
  options.more_starts = -1;
  EXPECT_THROW(options.Check(), base::InputError);
  options = Markers(3);
  options.among = -1;
  EXPECT_THROW(options.Check(), base::InputError);
}

TEST(RandomLayouts, AreOfDifferentPlacesAndTheSameForASeed) {
  const auto layouts = RandomLayouts(12, 5, 20, 4);

  EXPECT_EQ(layouts, RandomLayouts(12, 5, 20, 4));
  EXPECT_NE(layouts, RandomLayouts(12, 5, 20, 5));
  for (const auto& layout : layouts) {
    const std::set<int> places(layout.begin(), layout.end());
    EXPECT_EQ(places.size(), 5u);
    EXPECT_GE(*places.begin(), 0);
    EXPECT_LT(*places.rbegin(), 12);
  }
}

}  // namespace
}  // namespace softforce::design
