#include "pipeline/source_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <future>
#include <utility>

namespace softforce::pipeline {
namespace {

// A source that never gives anything, as cameras that went away.
class SilentSource : public vision::FrameSource {
 public:
  std::optional<vision::FrameSet> Next() override {
    std::unique_lock<std::mutex> lock(mutex_);
    stopping_.wait(lock, [&] { return stopped_; });
    return std::nullopt;
  }
  void Stop() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    stopping_.notify_all();
  }
  bool live() const override { return true; }
  int announced_frames() const override { return 0; }
  vision::SourceReport Report() const override { return {}; }
  std::vector<std::string> TakeMessages() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(messages_, {});
  }
  void Say(const std::string& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    messages_.push_back(message);
  }

 private:
  std::mutex mutex_;
  std::condition_variable stopping_;
  bool stopped_ = false;
  std::vector<std::string> messages_;
};

TEST(SourceWatch, EndsTheWaitForFramesThatNeverCome) {
  SilentSource source;
  std::atomic<bool> stop{false};
  const SourceWatch watch(&source, &stop, nullptr);
  auto next = std::async(std::launch::async, [&] { return source.Next(); });

  stop = true;

  EXPECT_FALSE(next.get().has_value());
}

TEST(SourceWatch, EndsTheWaitAfterATime) {
  SilentSource source;
  SourceWatch watch(&source, nullptr, nullptr);
  auto next = std::async(std::launch::async, [&] { return source.Next(); });

  watch.StopAfter(0.1);

  EXPECT_FALSE(next.get().has_value());
}

TEST(SourceWatch, PassesOnMessagesWhileNoFramesCome) {
  SilentSource source;
  std::promise<std::string> told;
  SourceWatch watch(&source, nullptr, [&](const std::string& text) { told.set_value(text); });

  source.Say("camera left went away");

  EXPECT_EQ(told.get_future().get(), "camera left went away");
}

TEST(SourceWatch, KeepsSomeMessagesAndCountsTheRest) {
  SilentSource source;
  std::atomic<int> told{0};
  std::promise<void> all;
  const SourceWatch watch(&source, nullptr, [&](const std::string&) {
    if (++told == 100) all.set_value();
  });
  for (int i = 0; i < 100; ++i) source.Say("again");
  all.get_future().wait();

  std::vector<std::string> messages = watch.Messages();
  while (messages.size() < 41) messages = watch.Messages();  // the last one is being noted down
  EXPECT_EQ(messages.size(), 41u);
  EXPECT_THAT(messages.back(), ::testing::HasSubstr("more messages of the cameras"));
}

}  // namespace
}  // namespace softforce::pipeline
