#include "softforce/base/quantity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::base {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

// The message of the refusal of `text`; fails the test if it is accepted.
std::string Refusal(const std::string& text, Dimension dimension, int count = 1) {
  try {
    ParseQuantity(text, dimension, count, "scene.yaml:7: size");
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "accepted " << text;
  return "";
}

double Parse(const std::string& text, Dimension dimension) {
  return ParseQuantity(text, dimension, 1, "here").at(0);
}

TEST(ParseQuantity, ConvertsEveryKindToSi) {
  EXPECT_DOUBLE_EQ(Parse("6 mm", Dimension::kLength), 6e-3);
  EXPECT_DOUBLE_EQ(Parse("25 mN", Dimension::kForce), 25e-3);
  EXPECT_DOUBLE_EQ(Parse("290 kPa", Dimension::kPressure), 290e3);
  EXPECT_DOUBLE_EQ(Parse("1.07 g/cm^3", Dimension::kDensity), 1070);
  EXPECT_DOUBLE_EQ(Parse("-9810 mm/s^2", Dimension::kAcceleration), -9.81);
  EXPECT_DOUBLE_EQ(Parse("20 ms", Dimension::kTime), 20e-3);
  EXPECT_DOUBLE_EQ(Parse("29.97 Hz", Dimension::kFrequency), 29.97);
  EXPECT_DOUBLE_EQ(Parse("180 deg", Dimension::kAngle), std::acos(-1.0));
  EXPECT_DOUBLE_EQ(Parse("0.45", Dimension::kNumber), 0.45);
}

TEST(ParseQuantity, ReadsSeveralNumbersWithOneUnit) {
  EXPECT_THAT(ParseQuantity(" -65 1.3e2 +10  mm ", Dimension::kLength, 3, "here"),
              ElementsAre(DoubleEq(-0.065), DoubleEq(0.13), DoubleEq(0.01)));
}

TEST(ParseQuantity, TakesBothLettersMu) {
  EXPECT_DOUBLE_EQ(Parse("5 \u00b5m", Dimension::kLength), 5e-6);
  EXPECT_DOUBLE_EQ(Parse("5 \u03bcm", Dimension::kLength), 5e-6);
}

TEST(ParseQuantity, TakesAUnitThatTouchesItsNumber) {
  EXPECT_DOUBLE_EQ(Parse("290kPa", Dimension::kPressure), 290e3);
}

TEST(ParseQuantity, RefusesAMissingUnit) {
  EXPECT_EQ(Refusal("290", Dimension::kPressure),
            "scene.yaml:7: size: \"290\": got no unit, expected a pressure in Pa, kPa, MPa, GPa\n"
            "  Write for example: 290 kPa");
}

TEST(ParseQuantity, RefusesAnUnknownUnit) {
  EXPECT_EQ(
      Refusal("0.5 n", Dimension::kForce),
      "scene.yaml:7: size: \"0.5 n\": got the unknown unit \"n\", expected a force in N, mN, kN\n"
      "  Write for example: 0.5 N");
}

TEST(ParseQuantity, RefusesAUnitOfTheWrongKind) {
  EXPECT_EQ(Refusal("1 2 3 kg/m^3", Dimension::kAcceleration, 3),
            "scene.yaml:7: size: \"1 2 3 kg/m^3\": got the unit \"kg/m^3\" of a density, "
            "expected an acceleration in m/s^2, mm/s^2\n"
            "  Write for example: 9.81 9.81 9.81 m/s^2");
}

TEST(ParseQuantity, RefusesAUnitOnAPlainNumber) {
  EXPECT_EQ(Refusal("0.45 mm", Dimension::kNumber),
            "scene.yaml:7: size: \"0.45 mm\": got the unit \"mm\" of a length, "
            "expected a number without unit\n"
            "  Write for example: 0.5");
}

TEST(ParseQuantity, RefusesAWrongCount) {
  EXPECT_EQ(Refusal("65 130 mm", Dimension::kLength, 3),
            "scene.yaml:7: size: got \"65 130 mm\", which has 2 numbers, expected 3\n"
            "  Write for example: 6 6 6 mm");
}

TEST(ParseQuantity, RefusesNumbersThatAreNotFinite) {
  for (const char* text : {"nan mm", "inf mm", "-inf mm", "1e999 mm"}) {
    EXPECT_EQ(Refusal(text, Dimension::kLength),
              std::string("scene.yaml:7: size: got \"") + text +
                  "\", which is not finite; expected ordinary numbers\n"
                  "  Write for example: 6 mm");
  }
}

TEST(ParseQuantity, RefusesTextWithoutANumber) {
  for (const char* text : {"", "mm", "six mm"}) {
    EXPECT_THAT(Refusal(text, Dimension::kLength),
                testing::HasSubstr("does not start with a number"));
  }
}

TEST(UnitInSi, GivesTheSizeOfAUnit) {
  EXPECT_DOUBLE_EQ(UnitInSi("mm", Dimension::kLength, "here"), 1e-3);
}

TEST(UnitInSi, RefusesAnUnknownUnit) {
  EXPECT_THROW(UnitInSi("inch", Dimension::kLength, "mesh: unit"), InputError);
}

}  // namespace
}  // namespace softforce::base
