#include "softforce/base/entries.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "softforce/base/input_error.h"

namespace softforce::base {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

template <typename Action>
std::string Refusal(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Entries, GivesEachEntryOnce) {
  Entries entries(" Size = 6 mm,count=4 , white", "markers", "");
  EXPECT_EQ(entries.TakeQuantity("size", Dimension::kLength), 0.006);
  EXPECT_EQ(entries.TakeCount("count"), 4);
  EXPECT_TRUE(entries.TakeFlag("white"));
  EXPECT_FALSE(entries.TakeFlag("white"));
  EXPECT_NO_THROW(entries.RefuseRest("size"));
}

TEST(Entries, TakesWhatIsNotWrittenFromTheDefault) {
  Entries entries("", "markers", "");
  EXPECT_EQ(entries.Take("family", "tag36h11"), "tag36h11");
  EXPECT_EQ(entries.TakeQuantity("size", Dimension::kLength, "6 mm"), 0.006);
  EXPECT_EQ(entries.TakeCount("count", "12"), 12);
}

TEST(Entries, SaysWhereAndWhatIsWrong) {
  Entries entries("size,count=1.5,flag=maybe,length=3 kg,other=1", "markers", "Write size=6mm.");
  EXPECT_THAT(Refusal([&] { entries.Take("colour"); }),
              AllOf(HasSubstr("markers: \"colour\" is missing"), HasSubstr("Write size=6mm.")));
  EXPECT_THAT(Refusal([&] { entries.Take("size"); }), HasSubstr("\"size\" has no value"));
  EXPECT_THAT(Refusal([&] { entries.TakeCount("count"); }), HasSubstr("whole number"));
  EXPECT_THAT(Refusal([&] { entries.TakeFlag("flag"); }), HasSubstr("true or false"));
  EXPECT_THAT(Refusal([&] { entries.TakeQuantity("length", Dimension::kLength); }),
              HasSubstr("markers: length"));
  EXPECT_THAT(Refusal([&] { entries.RefuseRest("size, count"); }),
              AllOf(HasSubstr("\"other\" is no entry"), HasSubstr("expected size, count")));
  EXPECT_THAT(Refusal([] { Entries("a=1,A=2", "markers", ""); }), HasSubstr("given twice"));
}

}  // namespace
}  // namespace softforce::base
