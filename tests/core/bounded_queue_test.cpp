#include "core/bounded_queue.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

namespace weft {
namespace {

TEST(BoundedQueue, HandsItemsOnInOrderAcrossThreads) {
  BoundedQueue<int> queue(3);
  std::thread producer([&] {
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(queue.push(i));
    queue.close();
  });
  std::vector<int> received;
  while (const auto item = queue.pop()) received.push_back(*item);
  producer.join();
  ASSERT_EQ(received.size(), 1000u);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(received[i], i);
}

TEST(BoundedQueue, NeverHoldsMoreThanItsCapacity) {
  BoundedQueue<int> queue(2);
  std::atomic<int> inside{0}, max_inside{0};
  std::thread producer([&] {
    for (int i = 0; i < 500; ++i) {
      const int now = ++inside;
      if (now > max_inside) max_inside = now;
      ASSERT_TRUE(queue.push(i));
    }
    queue.close();
  });
  while (queue.pop()) --inside;
  producer.join();
  // The count can exceed the capacity by two: the test counts an item before push() has a place for it, and until pop()
  // has returned.
  EXPECT_LE(max_inside, 4);
  EXPECT_GE(max_inside, 1);
}

TEST(BoundedQueue, KeepsFinishedItemsWhenTheProducerFailsAndThenThrowsItsFailure) {
  BoundedQueue<int> queue(4);
  ASSERT_TRUE(queue.push(7));
  ASSERT_TRUE(queue.push(8));
  queue.close(std::make_exception_ptr(std::runtime_error("no convergence")));
  EXPECT_EQ(queue.pop(), 7);
  EXPECT_EQ(queue.pop(), 8);
  try {
    queue.pop();
    FAIL() << "the failure was swallowed";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "no convergence");
  }
}

TEST(BoundedQueue, ReportsTheFirstFailureOnly) {
  BoundedQueue<int> queue(1);
  queue.close();
  queue.close(std::make_exception_ptr(std::runtime_error("too late")));
  EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(BoundedQueue, CancelWakesAWaitingProducerAndDropsWhatWaits) {
  BoundedQueue<std::shared_ptr<int>> queue(1);
  const auto item = std::make_shared<int>(1);
  ASSERT_TRUE(queue.push(item));
  std::atomic<bool> accepted{true};
  std::thread producer([&] { accepted = queue.push(item); });  // waits: the queue is full
  queue.cancel();
  producer.join();
  EXPECT_FALSE(accepted);
  EXPECT_EQ(item.use_count(), 1) << "the queue still owns the item";
  EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(BoundedQueue, TakesNothingAfterClosing) {
  BoundedQueue<int> queue(2);
  queue.close();
  EXPECT_FALSE(queue.push(1));
  EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(BoundedQueue, MovesItemsThatCannotBeCopied) {
  BoundedQueue<std::unique_ptr<int>> queue(1);
  ASSERT_TRUE(queue.push(std::make_unique<int>(5)));
  const auto item = queue.pop();
  ASSERT_TRUE(item.has_value());
  EXPECT_EQ(**item, 5);
}

}  // namespace
}  // namespace weft
