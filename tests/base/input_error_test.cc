#include "softforce/base/input_error.h"

#include <gtest/gtest.h>

namespace softforce::base {
namespace {

TEST(InputError, SaysWhereAndWhat) {
  EXPECT_STREQ(InputError("rig.yaml:3", "no cameras").what(), "rig.yaml:3: no cameras");
}

TEST(InputError, PutsTheAdviceOnALineOfItsOwn) {
  EXPECT_STREQ(InputError("rig.yaml", "no cameras", "Add one.").what(),
               "rig.yaml: no cameras\n  Add one.");
}

}  // namespace
}  // namespace softforce::base
