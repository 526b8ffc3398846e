#include "core/isolated.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/test_folder.hpp"

namespace weft {
namespace {

std::string reason(const std::function<std::string()>& work, unsigned cpu_seconds = 60, unsigned wall_seconds = 0) {
  try {
    run_isolated(work, {.name = "the reader",
                        .cpu_seconds = cpu_seconds,
                        .wall_seconds = wall_seconds,
                        .max_address_space = std::uint64_t{16} << 30});
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(Isolated, WorkReturnsItsBytesWhateverTheyAre) {
  std::string bytes(3'000'000, '\0');  // more than a pipe buffers
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<char>(k * k % 251);
  EXPECT_EQ(run_isolated([&] { return bytes; }, {}), bytes);
  EXPECT_EQ(run_isolated([] { return std::string(); }, {}), "");
}

TEST(Isolated, WorkChangesNothingInThisProcess) {
  int touched = 0;
  run_isolated([&] { return std::to_string(++touched); }, {});
  EXPECT_EQ(touched, 0);
}

TEST(Isolated, WorkThatThrowsIsReportedInItsWords) {
  EXPECT_EQ(reason([]() -> std::string { throw std::runtime_error("line 7 is odd"); }), "line 7 is odd");
  EXPECT_EQ(reason([]() -> std::string { throw 7; }), "an exception without a message");
  EXPECT_EQ(reason([]() -> std::string { throw std::bad_alloc(); }), "the reader exceeds its memory limit");
}

TEST(Isolated, WorkThatCrashesIsReportedBySignal) {
  EXPECT_EQ(reason([]() -> std::string {
              std::raise(SIGSEGV);
              return "";
            }),
            "the reader crashed: Segmentation fault");
  EXPECT_EQ(reason([]() -> std::string { std::abort(); }), "the reader crashed: Aborted");
  EXPECT_EQ(reason([]() -> std::string { std::_Exit(3); }), "the reader ended without a result");
}

TEST(Isolated, WorkWithoutEndIsStopped) {
  const auto endless = []() -> std::string {
    volatile bool on = true;
    while (on) {
    }
    return "";
  };
  EXPECT_EQ(reason(endless, 1), "the reader was stopped after 1 s of processor time");
}

std::string wait_for_ever() {
  for (;;) ::pause();
}

TEST(Isolated, WorkThatWaitsForEverIsStopped) {
  EXPECT_EQ(reason(wait_for_ever, 60, 1), "the reader was stopped after 1 s");
}

TEST(Isolated, WorkIsKilledOnceItIsToStop) {
  std::atomic<bool> stop = false;
  const std::jthread asks([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    stop = true;
  });
  support::expect_error(ExitCode::interrupted, "interrupted", [&] { run_isolated(wait_for_ever, {.stop = &stop}); });
}

#ifndef __SANITIZE_ADDRESS__
TEST(Isolated, WorkThatWantsTooMuchMemoryIsRefused) {
  const auto greedy = [] {
    std::vector<std::string> hoard(17);
    for (std::string& gigabyte : hoard) gigabyte.reserve(std::size_t{1} << 30);  // reserves addresses only, no memory
    return std::to_string(hoard.size());
  };
  EXPECT_EQ(reason(greedy), "the reader exceeds its memory limit");
}
#endif

}  // namespace
}  // namespace weft
