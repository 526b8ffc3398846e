#include "tools/cli/child_process.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "core/error.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {
namespace {

TEST(ChildProcess, ThatCannotBeStartedIsAnOutputError) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{0, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  support::expect_error(ExitCode::output_failed, "true: cannot be started", [] { (void)run_process({"true"}); });
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(run_process({"true"}).exit_code, 0);
}

using ChildProcessLog = support::TestFolder;

TEST_F(ChildProcessLog, ThatIsAPipeIsRefusedWithoutWaitingForAReader) {
  const std::filesystem::path pipe = folder_ / "run.log";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0666), 0);
  support::expect_error(ExitCode::output_failed, pipe.string() + ": cannot be written",
                        [&] { (void)start_process({"true"}, pipe); });
}

}  // namespace
}  // namespace weft::cli
