#include "softforce/pipeline/overlay_layers.h"

#include <gtest/gtest.h>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

TEST(OverlayLayers, NamesChooseAndMinusSignsLeaveOut) {
  const OverlayLayers chosen = ParseOverlayLayers("net,forces", "--draw");
  EXPECT_TRUE(chosen.net && chosen.forces);
  EXPECT_FALSE(chosen.markers || chosen.chart || chosen.displacement);
  const OverlayLayers without = ParseOverlayLayers("-axes,-chart", "--draw");
  EXPECT_TRUE(without.net && without.forces && without.markers);
  EXPECT_FALSE(without.axes || without.chart);
  EXPECT_TRUE(ParseOverlayLayers("all", "--draw").regions);
  EXPECT_FALSE(ParseOverlayLayers("none", "--draw").net);
  EXPECT_TRUE(ParseOverlayLayers(OverlayLayerNames(), "--draw").cables);
}

TEST(OverlayLayers, ShowStressOnlyWhereItIsAskedFor) {
  EXPECT_FALSE(ParseOverlayLayers("all", "--draw").stress);
  EXPECT_FALSE(ParseOverlayLayers("-axes", "--draw").stress);
  EXPECT_TRUE(ParseOverlayLayers("net,stress", "--draw").stress);
}

TEST(OverlayLayers, RefusesWhatItDoesNotKnow) {
  for (const char* text : {"nets", "net,", "net,-axes", "-net,axes", "-", ","}) {
    EXPECT_THROW(ParseOverlayLayers(text, "--draw"), base::InputError) << text;
  }
}

}  // namespace
}  // namespace softforce::pipeline
