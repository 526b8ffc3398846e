// A queue of limited length between two stages of a pipeline.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

namespace weft {

/// Passes items in order from one thread, the producer, to another, the consumer. If the producer fails, it calls
/// close() with its exception. The consumer first gets all waiting items, so that finished work is kept; then pop()
/// throws the exception. If the consumer fails, it calls cancel(); then push() returns false.
template <class T>
class BoundedQueue {
 public:
  /// `capacity`: maximum number of waiting items (at least 1); it bounds the memory of the pipeline.
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity > 0 ? capacity : 1) {}

  /// Waits for space. Returns false if the queue is closed or cancelled; the producer should then stop.
  [[nodiscard]] bool push(T item) {
    std::unique_lock lock(mutex_);
    space_available_.wait(lock, [&] { return items_.size() < capacity_ || closed_ || cancelled_; });
    if (closed_ || cancelled_) return false;
    items_.push_back(std::move(item));
    lock.unlock();
    item_available_.notify_one();
    return true;
  }

  /// Waits for an item. Returns nothing after cancel(), or if the queue is closed and empty. If the queue is empty and
  /// was closed with an exception, throws that exception instead.
  std::optional<T> pop() {
    std::unique_lock lock(mutex_);
    item_available_.wait(lock, [&] { return !items_.empty() || closed_ || cancelled_; });
    if (items_.empty() || cancelled_) {
      if (failure_ && !cancelled_) std::rethrow_exception(failure_);
      return std::nullopt;
    }
    std::optional<T> item(std::move(items_.front()));
    items_.pop_front();
    lock.unlock();
    space_available_.notify_one();
    return item;
  }

  /// The producer calls close() after its last push(). `failure`: exception of a producer that failed. Waiting items
  /// can still be popped. Only the first call has an effect.
  void close(std::exception_ptr failure = nullptr) {
    {
      const std::lock_guard lock(mutex_);
      if (!closed_) failure_ = std::move(failure);
      closed_ = true;
    }
    item_available_.notify_all();
    space_available_.notify_all();
  }

  /// The consumer calls cancel() when it pops no further items. Discards the waiting items.
  void cancel() {
    {
      const std::lock_guard lock(mutex_);
      cancelled_ = true;
      items_.clear();
    }
    item_available_.notify_all();
    space_available_.notify_all();
  }

 private:
  const std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable space_available_, item_available_;
  std::deque<T> items_;
  bool closed_ = false;
  bool cancelled_ = false;
  std::exception_ptr failure_;
};

}  // namespace weft
