#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <weft/settings.hpp>

#include "core/log.hpp"
#include "core/parallel.hpp"
#include "core/stop.hpp"
#include "core/version.hpp"

namespace weft {

const char* version() {
  return kVersion;
}

void set_threads(int threads) {
  if (threads < 0) throw std::invalid_argument(fmt::format("threads: expected 0 or more, got {}", threads));
  set_thread_count(threads);
}

void set_warning_handler(std::function<void(std::string_view warning)> handle) {
  log::set_handler(std::move(handle));
}

void set_interrupt_check(std::function<void()> check) {
  host_check = std::move(check);
}

}  // namespace weft
