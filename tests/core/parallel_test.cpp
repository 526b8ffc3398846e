// Tests parallel loops.
#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/parallel_append.hpp"

namespace weft {
namespace {

class ParallelLoops : public testing::Test {
 protected:
  ParallelLoops() { set_thread_count(4); }
  ~ParallelLoops() override { set_thread_count(0); }
};

TEST_F(ParallelLoops, CallEachItemOnceHoweverManyFollowEachOther) {
  std::vector<std::atomic<int>> calls(1000);
  for (int k = 0; k < 5000; ++k)
    parallel_for(calls.size(), 17, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++calls[i];
    });
  for (const std::atomic<int>& of_item : calls) EXPECT_EQ(of_item, 5000);
}

TEST_F(ParallelLoops, UseSeveralThreads) {
  std::atomic<int> inside = 0;
  std::atomic<bool> together = false;
  // Each chunk waits until a second one runs. With one thread this never happens, so the wait is limited.
  parallel_for(4, 1, [&](std::size_t, std::size_t) {
    ++inside;
    for (int k = 0; k < 100'000 && !together; ++k) {
      if (inside > 1) together = true;
      std::this_thread::yield();
    }
    --inside;
  });
  EXPECT_TRUE(together);
}

TEST_F(ParallelLoops, RethrowAndGoOn) {
  for (int k = 0; k < 100; ++k)
    EXPECT_THROW(parallel_for(100, 1,
                              [&](std::size_t begin, std::size_t) {
                                if (begin == 37) throw std::runtime_error("of chunk 37");
                              }),
                 std::runtime_error);
  const int sum = parallel_sum(100, 1, [](std::size_t begin, std::size_t) { return static_cast<int>(begin); });
  EXPECT_EQ(sum, 4950);
}

int sum_of_sums() {
  return parallel_sum(50, 1, [](std::size_t begin, std::size_t) {
    return parallel_sum(begin + 1, 1, [](std::size_t i, std::size_t) { return static_cast<int>(i); });
  });
}

TEST_F(ParallelLoops, MayContainLoopsAndRunBesideLoopsOfOtherThreads) {
  int expected = 0;
  for (int n = 0; n < 50; ++n) expected += n * (n + 1) / 2;
  std::atomic<int> wrong = 0;
  std::vector<std::thread> callers;
  for (int t = 0; t < 3; ++t)
    callers.emplace_back([&] {
      for (int k = 0; k < 300; ++k)
        if (sum_of_sums() != expected) ++wrong;
    });
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(wrong, 0);
}

TEST_F(ParallelLoops, FindItemsThatDoNotHold) {
  EXPECT_TRUE(parallel_all_of(10'000, [](std::size_t) { return true; }));
  for (const std::size_t wrong : {0, 4711, 9999})
    EXPECT_FALSE(parallel_all_of(10'000, [&](std::size_t i) { return i != wrong; })) << wrong;
}

TEST(CountedLoops, TellWhatThreadsWouldGain) {
  set_thread_count(1);
  LoopCounts counts;
  counted_loops = &counts;
  const auto work = [](std::size_t, std::size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
  parallel_for(8, 1, work);
  parallel_for(5, 5, work);  // a single chunk does not count as a loop
  parallel_for(2, 1, [&](std::size_t, std::size_t) { parallel_for(3, 1, work); });
  counted_loops = nullptr;
  set_thread_count(0);
  EXPECT_EQ(counts.loops, 2);
  EXPECT_EQ(counts.chunks, 10);
  EXPECT_GE(counts.seconds, 14e-3);
  // On four threads, a loop of eight chunks takes as long as two chunks, and a loop of two chunks as long as one.
  EXPECT_LT(counts.seconds_on[1], 0.5 * counts.seconds);
  EXPECT_GT(counts.seconds_on[1], 5e-3 - 1e-6);
}

}  // namespace
}  // namespace weft
