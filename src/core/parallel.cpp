#include "core/parallel.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <memory>
#ifdef __SANITIZE_THREAD__
#include <thread>
#endif

namespace weft {
namespace {

int g_threads = 0;  // 0: as many as processors
std::unique_ptr<tbb::global_control> g_limit;

#ifdef __SANITIZE_THREAD__
// The thread sanitizer does not see how TBB synchronises threads, because libtbb is not built with
// the sanitizer; it would report a data race in every loop. Under the sanitizer, loops use two
// standard threads instead, so that only races between chunks are reported.
void run_on_threads(std::size_t chunks, FunctionOfIndex run) {
  const auto each_second = [&](std::size_t first) {
    for (std::size_t c = first; c < chunks; c += 2) run(c);
  };
  std::thread other(each_second, 1);
  each_second(0);
  other.join();
}
#else
void run_on_threads(std::size_t chunks, FunctionOfIndex run) {
  tbb::parallel_for(std::size_t{0}, chunks, run);
}
#endif

}  // namespace

void set_thread_count(int threads) {
  g_threads = threads;
  g_limit = threads > 0 ? std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                                static_cast<std::size_t>(threads))
                        : nullptr;
}

int thread_count() {
  return g_threads > 0 ? g_threads : tbb::info::default_concurrency();
}

void run_chunks(std::size_t chunks, FunctionOfIndex run) {
  if (chunks > 1 && thread_count() > 1) return run_on_threads(chunks, run);
  const CountedLoop counted(chunks);
  for (std::size_t c = 0; c < chunks; ++c) run(c);
}

}  // namespace weft
