#include "core/parallel.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <memory>

namespace weft {
namespace {

int g_threads = 0;  // 0 until set: all cores
std::unique_ptr<tbb::global_control> g_limit;

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

}  // namespace weft
