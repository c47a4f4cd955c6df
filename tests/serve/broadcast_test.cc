#include "softforce/serve/broadcast.h"

#include <gtest/gtest.h>

#include <thread>

namespace softforce::serve {
namespace {

using std::chrono::milliseconds;

std::shared_ptr<const PageState> State(const std::string& json) {
  return std::make_shared<PageState>(PageState{json, {}, {}});
}

TEST(Broadcast, GivesTheNewestState) {
  Broadcast broadcast;
  EXPECT_EQ(broadcast.Read().state, nullptr);

  broadcast.Publish(State("1"));
  broadcast.Publish(State("2"));

  EXPECT_EQ(broadcast.Read().number, 2);
  EXPECT_EQ(broadcast.Read().state->json, "2");
}

TEST(Broadcast, KeepsAStateForThoseWhoStillReadIt) {
  Broadcast broadcast;
  broadcast.Publish(State("1"));
  const Broadcast::Newest held = broadcast.Read();

  broadcast.Publish(State("2"));

  EXPECT_EQ(held.state->json, "1");
}

TEST(Broadcast, WakesThoseWhoWait) {
  Broadcast broadcast;
  std::thread writer([&] { broadcast.Publish(State("1")); });

  const Broadcast::Newest newest = broadcast.WaitNewer(0, milliseconds(60'000));
  writer.join();

  EXPECT_EQ(newest.number, 1);
}

TEST(Broadcast, DoesNotLetWaitForWhatIsThere) {
  Broadcast broadcast;
  broadcast.Publish(State("1"));

  EXPECT_EQ(broadcast.WaitNewer(0, milliseconds(60'000)).number, 1);
}

TEST(Broadcast, ClosingWakesThoseWhoWait) {
  Broadcast broadcast;
  std::thread closer([&] { broadcast.Close(); });

  const Broadcast::Newest newest = broadcast.WaitNewer(0, milliseconds(60'000));
  closer.join();

  EXPECT_EQ(newest.number, 0);
}

}  // namespace
}  // namespace softforce::serve
