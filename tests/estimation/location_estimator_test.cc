#include "softforce/estimation/location_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "softforce/base/input_error.h"
#include "support/pressed_sheet.h"

namespace softforce::estimation {
namespace {

using testing::Press;
using testing::PressedSheet;

constexpr double kNoise = 4e-5;  // m

class LocationEstimatorTest : public ::testing::Test {
 protected:
  LocationEstimate Estimate(LocationEstimator* estimator, const std::vector<Press>& presses,
                            double noise = kNoise) {
    return estimator->Estimate(sheet_.Observe(truth_.Seen(presses), noise, &random_),
                               fem::NoActuation(sheet_.body()));
  }

  static const LocatedForce& NearestTo(const Eigen::Vector3d& place,
                                       const LocationEstimate& estimate) {
    return *std::min_element(estimate.forces.begin(), estimate.forces.end(),
                             [&](const LocatedForce& a, const LocatedForce& b) {
                               return (a.rest - place).norm() < (b.rest - place).norm();
                             });
  }

  // Errors beyond five standard deviations, in 2 or 3 directions, come by chance in one of 10⁵
  // draws.
  static void ExpectFound(const Press& press, const LocationEstimate& estimate) {
    ASSERT_FALSE(estimate.forces.empty());
    const LocatedForce& found = NearestTo(press.place, estimate);
    const Eigen::Vector2d apart = found.tangents.transpose() * (found.rest - press.place);
    EXPECT_LT(apart.dot(found.location_covariance.ldlt().solve(apart)), 25);
    const Eigen::Vector3d error = found.force - press.force;
    EXPECT_LT(error.dot(found.covariance.ldlt().solve(error)), 25);
  }

  PressedSheet truth_{13}, sheet_{10};
  std::mt19937 random_{5};
};

TEST_F(LocationEstimatorTest, FindsAForceBetweenCandidates) {
  LocationEstimator estimator = sheet_.Estimator(PressedSheet::Options());
  const Press press{{0.037, 0.061, 0}, {0, 0, 0.4}};

  const LocationEstimate estimate = Estimate(&estimator, {press});

  ASSERT_TRUE(estimate.ok()) << estimate.reason;
  ASSERT_EQ(estimate.forces.size(), 1);
  ExpectFound(press, estimate);
  EXPECT_LT(estimate.forces[0].location_sd(), 1e-3);  // m: candidates are 25 mm apart
}

TEST_F(LocationEstimatorTest, TheFloorIsOfTheNoiseAlone) {
  LocationEstimator estimator = sheet_.Estimator(PressedSheet::Options());
  const Press press{{0.037, 0.061, 0}, {0, 0, 0.4}};
  const LocationEstimate estimate = Estimate(&estimator, {press});
  ASSERT_TRUE(estimate.ok()) << estimate.reason;
  const auto floor = [&](double noise) {
    return estimator.Floor(sheet_.Observe(truth_.Seen({press}), noise, &random_), estimate.forces)
        .at(0);
  };

  const LocatedForce one = floor(kNoise), two = floor(2 * kNoise);
  EXPECT_NEAR(two.location_sd() / one.location_sd(), 2, 1e-6);  // rounding of the response
  EXPECT_LT((two.covariance - 4 * one.covariance).norm(), 1e-6 * two.covariance.norm());
  EXPECT_LT(one.location_sd(), estimate.forces[0].location_sd());  // allows for the model's error
}

// A force through the sheet moves the markers alike from above and from below.
TEST_F(LocationEstimatorTest, SaysThatAForceMayActOnTheOtherFace) {
  std::vector<LocationCandidate> candidates = sheet_.Candidates();
  const auto below = static_cast<int>(candidates.size());
  for (int c = 0; c < below; ++c) {
    const Eigen::Vector3d above = PressedSheet::CandidatePlace(c) + Eigen::Vector3d(0, 0, 0.008);
    candidates.push_back({"above " + std::to_string(c), sheet_.At(above)});
  }
  LocationEstimator both = sheet_.Estimator(PressedSheet::Options(), candidates);
  LocationEstimator one = sheet_.Estimator(PressedSheet::Options());
  const Press press{{0.037, 0.061, 0}, {0, 0, 0.1}};

  const LocationEstimate in_doubt = Estimate(&both, {press});
  const LocationEstimate certain = Estimate(&one, {press});

  ASSERT_TRUE(in_doubt.ok()) << in_doubt.reason;
  ASSERT_EQ(in_doubt.forces.size(), 1);
  EXPECT_LT(in_doubt.probability, 0.99);
  const std::vector<int>& alternatives = in_doubt.forces[0].alternatives;
  const bool found_above = in_doubt.forces[0].rest.z() > 0.004;
  EXPECT_TRUE(std::any_of(alternatives.begin(), alternatives.end(),
                          [&](int c) { return (c >= below) != found_above; }));
  ASSERT_TRUE(certain.ok()) << certain.reason;
  EXPECT_GT(certain.probability, 0.99);
}

TEST_F(LocationEstimatorTest, FindsThreeForces) {
  LocationEstimator estimator = sheet_.Estimator(PressedSheet::Options());
  const std::vector<Press> presses{{{0.03, 0.03, 0}, {0, 0, 0.4}},
                                   {{0.07, 0.041, 0}, {0, 0, -0.5}},
                                   {{0.05, 0.08, 0}, {0, 0, 0.3}}};

  const LocationEstimate estimate = Estimate(&estimator, presses);

  ASSERT_TRUE(estimate.ok()) << estimate.reason;
  ASSERT_EQ(estimate.forces.size(), 3);
  for (const Press& press : presses) ExpectFound(press, estimate);
}

// The first frame has the whole load: the sheet of 100 mm is bent by 15 mm.
TEST_F(LocationEstimatorTest, FindsForcesOnABodyThatIsFullyLoadedFromTheStart) {
  const std::vector<Press> one{{{0.037, 0.061, 0}, {0, 0, 2}}};
  const std::vector<Press> two{{{0.037, 0.061, 0}, {0, 0, 1.5}}, {{0.07, 0.03, 0}, {0, 0, -1.2}}};
  for (const std::vector<Press>& presses : {one, two}) {
    LocationEstimator cold = sheet_.Estimator(PressedSheet::Options());
    LocationEstimator warm = sheet_.Estimator(PressedSheet::Options());
    const std::vector<Observation> observations =
        sheet_.Observe(truth_.Seen(presses), kNoise, &random_);
    const fem::Actuation none = fem::NoActuation(sheet_.body());

    const LocationEstimate at_once = cold.Estimate(observations, none);
    for (const double share : {0.0, 0.25, 0.5, 0.75}) {
      std::vector<Press> part = presses;
      for (Press& press : part) press.force *= share;
      ASSERT_TRUE(Estimate(&warm, part).ok()) << share;
    }
    const LocationEstimate step_by_step = warm.Estimate(observations, none);

    ASSERT_TRUE(at_once.ok()) << at_once.reason;
    EXPECT_LE(at_once.rounds, 12);
    ASSERT_EQ(at_once.forces.size(), presses.size());
    ASSERT_EQ(step_by_step.forces.size(), presses.size());
    for (const Press& press : presses) ExpectFound(press, at_once);
    for (const LocatedForce& force : step_by_step.forces) {
      const LocatedForce& same = NearestTo(force.rest, at_once);
      const Eigen::Vector3d apart = same.force - force.force;
      EXPECT_LT(apart.dot(force.covariance.ldlt().solve(apart)), 1);  // sd
      EXPECT_LT((same.rest - force.rest).norm(), force.location_sd());
    }
  }
}

TEST_F(LocationEstimatorTest, FindsNoForceWhereThereIsNone) {
  LocationEstimator estimator = sheet_.Estimator(PressedSheet::Options());

  const LocationEstimate estimate = Estimate(&estimator, {});

  ASSERT_TRUE(estimate.ok()) << estimate.reason;
  EXPECT_TRUE(estimate.forces.empty());
}

TEST_F(LocationEstimatorTest, AForceThatSlidesStaysTheSame) {
  LocationEstimator estimator = sheet_.Estimator(PressedSheet::Options());
  std::set<int> identities;
  for (double y = 0.02; y < 0.081; y += 0.005) {
    const Press press{{0.045, y, 0}, {0, 0, 0.4}};
    const LocationEstimate estimate = Estimate(&estimator, {press});
    ASSERT_TRUE(estimate.ok()) << estimate.reason;
    ASSERT_EQ(estimate.forces.size(), 1) << "at " << y;
    ExpectFound(press, estimate);
    identities.insert(estimate.forces[0].identity);
  }
  EXPECT_EQ(identities.size(), 1);
}

TEST_F(LocationEstimatorTest, AForceThatComesAndGoesLeavesTheOther) {
  LocationEstimator estimator = sheet_.Estimator(PressedSheet::Options());
  const Press stays{{0.03, 0.03, 0}, {0, 0, 0.4}}, comes{{0.07, 0.07, 0}, {0, 0, 0.4}};

  const LocationEstimate before = Estimate(&estimator, {stays});
  const LocationEstimate both = Estimate(&estimator, {stays, comes});
  const LocationEstimate after = Estimate(&estimator, {stays});

  ASSERT_EQ(before.forces.size(), 1);
  ASSERT_EQ(both.forces.size(), 2);
  ASSERT_EQ(after.forces.size(), 1);
  EXPECT_EQ(after.forces[0].identity, before.forces[0].identity);
  ExpectFound(comes, both);
}

// As one that is too weak for a while, or a contact that bounces.
TEST_F(LocationEstimatorTest, AForceThatIsGoneForAFewFramesComesBackAsTheSame) {
  LocationEstimator estimator = sheet_.Estimator(PressedSheet::Options());
  const Press stays{{0.03, 0.03, 0}, {0, 0, 0.4}}, bounces{{0.07, 0.07, 0}, {0, 0, 0.4}};
  const Press elsewhere{{0.07, 0.03, 0}, {0, 0, 0.4}};
  const auto identity_of = [&](const Press& press, const std::vector<Press>& presses) {
    const LocationEstimate estimate = Estimate(&estimator, presses);
    EXPECT_EQ(estimate.forces.size(), presses.size());
    return NearestTo(press.place, estimate).identity;
  };

  const int first = identity_of(bounces, {stays, bounces});
  const int other = identity_of(stays, {stays});
  EXPECT_NE(identity_of(elsewhere, {stays, elsewhere}), first) << "40 mm from where it was";
  EXPECT_EQ(identity_of(bounces, {stays, bounces}), first);
  for (int frame = 0; frame < 16; ++frame) EXPECT_EQ(identity_of(stays, {stays}), other);
  EXPECT_NE(identity_of(bounces, {stays, bounces}), first) << "after half a second at 30 Hz";
}

TEST_F(LocationEstimatorTest, TellsWhichCandidatesAreLoaded) {
  LocationEstimator estimator =
      sheet_.Estimator(PressedSheet::Options(LocationMethod::kCandidates));

  const LocationEstimate estimate =
      Estimate(&estimator, {{PressedSheet::CandidatePlace(1), {0, 0, 0.4}},
                            {PressedSheet::CandidatePlace(6), {0, 0, 0.3}}});

  ASSERT_TRUE(estimate.ok()) << estimate.reason;
  ASSERT_EQ(estimate.forces.size(), 2);
  EXPECT_EQ(estimate.forces[0].candidate, 1);
  EXPECT_EQ(estimate.forces[1].candidate, 6);
}

TEST_F(LocationEstimatorTest, AForceThatMayOnlyPushIsAlongTheInwardNormal) {
  LocationEstimator estimator = sheet_.Estimator(PressedSheet::Options(), ForceDirection::kPush);
  const Press press{{0.037, 0.061, 0}, {0, 0, 0.4}};

  const LocationEstimate estimate = Estimate(&estimator, {press});

  ASSERT_TRUE(estimate.ok()) << estimate.reason;
  ASSERT_EQ(estimate.forces.size(), 1);
  EXPECT_EQ(estimate.forces[0].force.head<2>().norm(), 0);
  EXPECT_NEAR(estimate.forces[0].force.z(), 0.4,
              5 * std::sqrt(estimate.forces[0].covariance(2, 2)));
}

TEST_F(LocationEstimatorTest, TheThresholdMergesNeighboursAtTheirCentre) {
  LocationEstimator estimator =
      sheet_.Estimator(PressedSheet::Options(LocationMethod::kThreshold), ForceDirection::kPush);
  const Press press{{0.0375, 0.05, 0}, {0, 0, 0.4}};  // half-way between candidates 3 and 4

  const LocationEstimate estimate = Estimate(&estimator, {press});

  ASSERT_TRUE(estimate.ok()) << estimate.reason;
  ASSERT_EQ(estimate.forces.size(), 1);
  EXPECT_LT((estimate.forces[0].rest - press.place).norm(), 1e-3);  // m
}

TEST_F(LocationEstimatorTest, AnImpossibleMarkerIsRejectedAndHasNoInfluence) {
  const Press press{{0.037, 0.061, 0}, {0, 0, 0.4}};
  std::vector<Observation> observations = sheet_.Observe(truth_.Seen({press}), kNoise, &random_);
  observations[6].position.z() += 0.004;
  LocationEstimator with = sheet_.Estimator(PressedSheet::Options());
  LocationEstimator without = sheet_.Estimator(PressedSheet::Options());
  const fem::Actuation none = fem::NoActuation(sheet_.body());

  const LocationEstimate poisoned = with.Estimate(observations, none);
  observations.erase(observations.begin() + 6);
  const LocationEstimate clean = without.Estimate(observations, none);

  ASSERT_TRUE(poisoned.ok()) << poisoned.reason;
  ASSERT_TRUE(clean.ok()) << clean.reason;
  EXPECT_EQ(std::count(poisoned.rejected.begin(), poisoned.rejected.end(), char{1}), 1);
  EXPECT_EQ(poisoned.rejected[6], 1);
  ASSERT_EQ(poisoned.forces.size(), clean.forces.size());
  // Both converge until nothing moves by more than a twentieth of a standard deviation.
  EXPECT_LT((poisoned.forces[0].rest - clean.forces[0].rest).norm(),
            0.1 * clean.forces[0].location_sd());
}

// Far enough for no force to be looked for, and near enough for two opposite ones to explain it.
TEST_F(LocationEstimatorTest, PoisonDoesNotChangeTheAnswer) {
  const std::vector<Press> presses{{{0.037, 0.061, 0}, {0, 0, 0.8}},
                                   {{0.07, 0.041, 0}, {0, 0, -0.6}}};
  const std::vector<Observation> clean = sheet_.Observe(truth_.Seen(presses), kNoise, &random_);
  const fem::Actuation none = fem::NoActuation(sheet_.body());
  std::vector<Observation> without = clean;
  without.erase(without.begin() + 6);
  LocationEstimator reference_of = sheet_.Estimator(PressedSheet::Options());
  const LocationEstimate reference = reference_of.Estimate(without, none);
  ASSERT_EQ(reference.forces.size(), 2);
  for (const double poison : {0.003, 0.01, 0.04, 0.15, 1e6}) {
    std::vector<Observation> observations = clean;
    observations[6].position += Eigen::Vector3d(0.3, 0.1, 1) * poison;
    LocationEstimator estimator = sheet_.Estimator(PressedSheet::Options());

    const LocationEstimate estimate = estimator.Estimate(observations, none);

    ASSERT_TRUE(estimate.ok()) << poison << " m: " << estimate.reason;
    EXPECT_EQ(std::count(estimate.rejected.begin(), estimate.rejected.end(), char{1}), 1) << poison;
    EXPECT_EQ(estimate.rejected[6], 1) << poison;
    EXPECT_LE(estimate.rounds, reference.rounds + 2) << poison;
    ASSERT_EQ(estimate.forces.size(), 2) << poison;
    for (const LocatedForce& force : reference.forces) {
      // Each converges until nothing moves by more than a tenth of a standard deviation.
      EXPECT_LT((NearestTo(force.rest, estimate).rest - force.rest).norm(),
                0.2 * force.location_sd())
          << poison;
    }
  }
}

TEST_F(LocationEstimatorTest, WithoutMarkersItSaysSoAndRecovers) {
  LocationEstimator estimator = sheet_.Estimator(PressedSheet::Options());
  const Press press{{0.037, 0.061, 0}, {0, 0, 0.4}};

  const LocationEstimate lost = estimator.Estimate({}, fem::NoActuation(sheet_.body()));
  const LocationEstimate found = Estimate(&estimator, {press});

  EXPECT_EQ(lost.status, ForceEstimate::Status::kTooFewObservations);
  ASSERT_TRUE(found.ok()) << found.reason;
  ExpectFound(press, found);
}

TEST_F(LocationEstimatorTest, RefusesOptionsThatCannotBe) {
  LocationOptions options = PressedSheet::Options();
  options.false_alarm = 1;

  EXPECT_THROW(sheet_.Estimator(options), base::InputError);
}

}  // namespace
}  // namespace softforce::estimation
