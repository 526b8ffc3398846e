#include "core/parallel.hpp"

#include <immintrin.h>
#include <sched.h>
#include <unistd.h>

#include <exception>
#include <memory>
#include <system_error>
#include <thread>

namespace weft {
namespace {

// Rounds in which a thread waits for work or for other threads without giving up its processor, 10 to 50 µs. Within a
// step loops follow each other faster; a thread that sleeps takes as long to wake up.
constexpr int kSpins = 1000;

// Waits until `done()` holds.
template <class Done>
void wait_until(const Done& done) {
  for (int k = 0; !done(); ++k) k < kSpins ? _mm_pause() : std::this_thread::yield();
}

/// A loop that threads share: each takes the next chunk until there is none.
struct Loop {
  std::size_t chunks;
  void (*run)(const void* body, std::size_t chunk);
  const void* body;
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  std::exception_ptr error = nullptr;  // of the first chunk that failed

  void take_part() {
    for (std::size_t c = next++; c < chunks; c = next++) {
      try {
        run(body, c);
      } catch (...) {
        if (!failed.exchange(true)) error = std::current_exception();
        next = chunks;
      }
    }
  }
};

// Whether the thread runs a chunk: loops inside of it are not divided.
thread_local bool t_in_loop = false;

/// Threads that help the one that calls. They wait without sleeping between loops that follow each other closely.
/// Measured with 16 threads, a drape of 64²: one loop of 16 short chunks takes 3 µs, with TBB 15.
class Helpers {
 public:
  explicit Helpers(int count) {
    try {
      for (int k = 0; k < count; ++k) threads_.emplace_back([this] { serve(); });
    } catch (const std::system_error&) {
      // The system gives no more threads: fewer help.
    }
  }
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;
  ~Helpers() {
    ends_ = true;
    announce();
    for (std::thread& thread : threads_) thread.join();
  }

  bool belong_to_this_process() const { return process_ == ::getpid(); }

  void run(Loop& loop) {
    current_ = &loop;
    announce();
    loop.take_part();
    // A helper that sees the loop has entered before; once all have left, none can see it any more.
    current_ = nullptr;
    wait_until([&] { return entered_ == 0; });
  }

 private:
  void announce() {
    ++round_;
    if (sleeping_ > 0) round_.notify_all();
  }

  void serve() {
    t_in_loop = true;
    int seen = 0;
    while (!ends_) {
      ++entered_;
      if (Loop* loop = current_) loop->take_part();
      --entered_;
      for (int k = 0; k < kSpins && round_ == seen; ++k) _mm_pause();
      if (round_ == seen) {
        ++sleeping_;
        round_.wait(seen);
        --sleeping_;
      }
      seen = round_;
    }
  }

  pid_t process_ = ::getpid();
  // Each in a cache line of its own: waiting threads read the first one all the time.
  alignas(64) std::atomic<int> round_ = 0;
  alignas(64) std::atomic<Loop*> current_ = nullptr;
  std::atomic<bool> ends_ = false;
  alignas(64) std::atomic<int> entered_ = 0;
  std::atomic<int> sleeping_ = 0;
  std::vector<std::thread> threads_;
};

int g_threads = 0;  // 0 until set: all cores
std::unique_ptr<Helpers> g_helpers;
std::atomic_flag g_busy;  // whether some thread uses g_helpers

int count_processors() {
  cpu_set_t allowed;
  return ::sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 1;
}

}  // namespace

void set_thread_count(int threads) {
  g_threads = threads;
  g_helpers.reset();
}

int thread_count() {
  static const int processors = count_processors();
  return g_threads > 0 ? g_threads : processors;
}

void run_chunks(std::size_t chunks, void (*run)(const void* body, std::size_t chunk), const void* body) {
  if (t_in_loop || g_busy.test_and_set()) {
    for (std::size_t c = 0; c < chunks; ++c) run(body, c);
    return;
  }
  Loop loop{chunks, run, body};
  // The threads of a parent process do not exist in its child; what represents them there cannot be joined.
  if (g_helpers != nullptr && !g_helpers->belong_to_this_process()) (void)g_helpers.release();
  if (g_helpers == nullptr) g_helpers = std::make_unique<Helpers>(thread_count() - 1);
  t_in_loop = true;
  g_helpers->run(loop);
  t_in_loop = false;
  g_busy.clear();
  if (loop.error) std::rethrow_exception(loop.error);
}

}  // namespace weft
