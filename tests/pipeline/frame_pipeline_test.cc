#include "pipeline/frame_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>

#include "fem/cholesky.h"
#include "fem/elements.h"
#include "fem/tangent.h"
#include "support/soft_bodies.h"

namespace softforce::pipeline {
namespace {

// Frames numbered from 0.
FrameInput Numbers(int count) {
  return {"count", [count, next = 0](FrameInWork* frame) mutable {
            frame->set.frame = next;
            return next++ < count;
          }};
}

// Takes the longer, the earlier the frame comes in a group of three.
void Dawdle(const FrameInWork& frame) {
  std::this_thread::sleep_for(std::chrono::milliseconds(2 - frame.set.frame % 3));
}

std::vector<int> OrderAtTheEnd(int threads) {
  std::vector<int> order;
  const std::vector<Stage> stages{
      {"any", Stage::Order::kAny, [](FrameInWork* frame) { Dawdle(*frame); }},
      {"last", Stage::Order::kInOrder,
       [&](FrameInWork* frame) { order.push_back(frame->set.frame); }}};
  StageClock clock;
  RunStages(Numbers(20), stages, threads, 4, &clock);
  return order;
}

TEST(RunStages, KeepsTheOrderOfTheFramesOnAnyNumberOfThreads) {
  const std::vector<int> one = OrderAtTheEnd(1);

  ASSERT_EQ(one.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(one[i], i);
  EXPECT_EQ(OrderAtTheEnd(2), one);
  EXPECT_EQ(OrderAtTheEnd(5), one);
}

TEST(RunStages, KeepsToTheCallingThreadIfThereIsOne) {
  const std::thread::id here = std::this_thread::get_id();
  const std::vector<Stage> stages{{"any", Stage::Order::kAny, [&](FrameInWork*) {
                                     EXPECT_EQ(std::this_thread::get_id(), here);
                                   }}};
  StageClock clock;
  RunStages(Numbers(10), stages, 1, 4, &clock);
  EXPECT_EQ(clock.Report().back().count, 10);
}

TEST(RunStages, UsesSeveralThreadsAtOnce) {
  // Two frames that wait for each other: one thread alone would wait for ever.
  std::atomic<int> inside{0};
  const std::vector<Stage> stages{{"meet", Stage::Order::kAny, [&](FrameInWork*) {
                                     ++inside;
                                     while (inside < 2) std::this_thread::yield();
                                   }}};
  StageClock clock;
  RunStages(Numbers(2), stages, 2, 4, &clock);
  EXPECT_EQ(inside, 2);
}

TEST(RunStages, HasNoMoreFramesInFlightThanAllowed) {
  std::atomic<int> in_flight{0}, most{0};
  const FrameInput input{"count", [&, next = 0](FrameInWork* frame) mutable {
                           frame->set.frame = next;
                           most = std::max<int>(most, in_flight);
                           return next++ < 30;
                         }};
  const std::vector<Stage> stages{
      {"first", Stage::Order::kAny, [&](FrameInWork*) { ++in_flight; }},
      {"slow", Stage::Order::kInOrder, [&](FrameInWork* frame) { Dawdle(*frame); }},
      {"last", Stage::Order::kInOrder, [&](FrameInWork*) { --in_flight; }}};
  StageClock clock;
  RunStages(input, stages, 4, 3, &clock);
  EXPECT_LE(most, 3);
}

TEST(RunStages, ThrowsOnWhatAStageThrowsAndComesToRest) {
  for (const int threads : {1, 3}) {
    std::atomic<int> at_work{0};
    const auto guarded = [&](const auto& work) {
      return [&at_work, work](FrameInWork* frame) {
        ++at_work;
        const std::shared_ptr<void> leave(nullptr, [&](void*) { --at_work; });
        work(frame);
      };
    };
    const std::vector<Stage> stages{
        {"any", Stage::Order::kAny, guarded([](FrameInWork* frame) { Dawdle(*frame); })},
        {"throw", Stage::Order::kInOrder, guarded([](FrameInWork* frame) {
           if (frame->set.frame == 7) throw std::runtime_error("frame 7");
         })}};
    StageClock clock;
    try {
      RunStages(Numbers(20), stages, threads, 6, &clock);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "frame 7");
    }
    EXPECT_EQ(at_work, 0);
  }
}

TEST(RunStages, ThrowsOnWhatTheInputThrows) {
  const FrameInput input{"count", [](FrameInWork*) -> bool { throw std::runtime_error("input"); }};
  StageClock clock;
  EXPECT_THROW(
      RunStages(input, {{"none", Stage::Order::kInOrder, [](FrameInWork*) {}}}, 2, 4, &clock),
      std::runtime_error);
}

TEST(RunStages, CountsTheFramesThatWait) {
  // The stage lets nothing go before all that may be in flight wait for it.
  std::atomic<int> entered{0};
  const FrameInput input{"count", [&](FrameInWork* frame) {
                           frame->set.frame = entered;
                           return ++entered <= 8;
                         }};
  const std::vector<Stage> stages{{"first", Stage::Order::kAny, [](FrameInWork*) {}},
                                  {"wait", Stage::Order::kInOrder, [&](FrameInWork* frame) {
                                     const int all = std::min(frame->set.frame + 3, 8);
                                     while (entered < all) std::this_thread::yield();
                                   }}};
  StageClock clock;
  RunStages(input, stages, 2, 3, &clock);

  const std::vector<StageTimes> report = clock.Report();
  ASSERT_EQ(report.size(), 3u);
  EXPECT_FALSE(report[0].queued);  // the input
  EXPECT_TRUE(report[2].queued);
  EXPECT_GE(report[2].queue_max, 1);
  EXPECT_LE(report[2].queue_max, 2);  // of three in flight, one is in the stage
  EXPECT_GT(report[2].queue_mean, 0);
}

double ProcessorSeconds(clockid_t clock) {
  std::timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The limits that keep CHOLMOD's OpenMP threads idle belong to the thread that sets them.
TEST(RunStages, LeavesCholmodOnTheThreadOfItsStage) {
  const fem::Body bar = testing::MakeBar(2, 60);
  const fem::Elements elements(bar);
  fem::TangentAssembler assembler(bar, elements);
  assembler.Assemble(elements, Eigen::Matrix3Xd::Zero(3, bar.mesh.num_nodes()), {}, {});
  fem::Cholesky cholesky(assembler.matrix());
  ASSERT_TRUE(cholesky.Factorise(assembler.matrix()));

  // Of two frames on two threads, the one that is not on the calling thread factorises while the
  // other sleeps.
  const std::thread::id here = std::this_thread::get_id();
  std::atomic<int> inside{0};
  std::promise<void> done;
  double own_used = 0, all_used = 0;  // s of processor time
  const auto factorise = [&] {
    const double own = ProcessorSeconds(CLOCK_THREAD_CPUTIME_ID);
    const double all = ProcessorSeconds(CLOCK_PROCESS_CPUTIME_ID);
    while (ProcessorSeconds(CLOCK_THREAD_CPUTIME_ID) < own + 0.2) {
      EXPECT_TRUE(cholesky.Factorise(assembler.matrix()));
    }
    own_used = ProcessorSeconds(CLOCK_THREAD_CPUTIME_ID) - own;
    all_used = ProcessorSeconds(CLOCK_PROCESS_CPUTIME_ID) - all;
    done.set_value();
  };
  const std::vector<Stage> stages{{"factorise", Stage::Order::kAny, [&](FrameInWork*) {
                                     ++inside;
                                     while (inside < 2) std::this_thread::yield();
                                     if (std::this_thread::get_id() == here) {
                                       done.get_future().wait();
                                     } else {
                                       factorise();
                                     }
                                   }}};
  StageClock clock;
  RunStages(Numbers(2), stages, 2, 2, &clock);

  // A ratio of processor times, whatever else the machine does; OpenBLAS's and TBB's idle threads
  // spin for a moment before they sleep. Two spinning threads give 2.
  EXPECT_LT(all_used / own_used, 1.4);
}

}  // namespace
}  // namespace softforce::pipeline
