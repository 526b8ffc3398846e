#include "core/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "core/error.hpp"

namespace weft {
namespace {

// More left-overs of killed runs than this beside one file deserve a person's look.
constexpr int kMaxLeftOvers = 1000;

[[noreturn]] void fail(const std::filesystem::path& file, const char* step) {
  const std::string reason = std::generic_category().message(errno);
  throw Error(ExitCode::output_failed, "{}: cannot {}: {}", file.string(), step, reason);
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path file) : file_(std::move(file)) {
  // A rename onto a folder fails only after all the work, and one onto /dev/null would replace the device.
  std::error_code status_error;
  const auto status = std::filesystem::status(file_, status_error);
  if (!file_.has_filename() || (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))) {
    throw Error(ExitCode::output_failed, "{}: expected the name of a file to write, got a folder or a device",
                file_.string());
  }
  // O_EXCL: two writers never share a temporary file, whichever processes and machines they run on.
  const std::string stem = file_.stem().string(), extension = file_.extension().string();
  for (int n = 1; descriptor_ < 0; ++n) {
    temporary_ = file_;
    temporary_.replace_filename(stem + ".partial" + (n == 1 ? "" : std::to_string(n)) + extension);
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && (errno != EEXIST || n == kMaxLeftOvers)) fail(temporary_, "create this file");
  }
  owned_ = true;
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (owned_) unlink(temporary_.c_str());
}

void OutputFile::write(const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, next, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(temporary_, "write");
    next += written;
    size -= static_cast<std::size_t>(written);
  }
}

void OutputFile::commit() {
  // Data before name: after a power cut the final name must not stand for an empty file.
  if (fsync(descriptor_) != 0) fail(temporary_, "bring this file to the disk");
  if (close(std::exchange(descriptor_, -1)) != 0) fail(temporary_, "close this file");
  if (std::rename(temporary_.c_str(), file_.c_str()) != 0) fail(file_, "give the finished file this name");
  owned_ = false;
}

}  // namespace weft
