#include "core/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace weft {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw std::runtime_error(why);
}

/// An open regular file, closed by the destructor. The constructor throws std::runtime_error with the reason.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& file) {
    // Without O_NONBLOCK, opening a pipe would wait for a writer.
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    struct stat status {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
      const int error = errno;
      close();
      refuse(std::strerror(error));
    }
    size_ = static_cast<std::uintmax_t>(status.st_size);
    if (S_ISREG(status.st_mode)) return;
    close();
    refuse(S_ISDIR(status.st_mode) ? "expected a file, got a folder" : "expected a file, got a device or pipe");
  }
  ~InputFile() { close(); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::uintmax_t size() const { return size_; }

  /// Reads `count` bytes from `begin`, or fewer at the end of the file.
  std::string read(std::size_t count, std::uintmax_t begin = 0) const {
    std::string bytes(count, '\0');
    std::size_t done = 0;
    while (done < count) {
      const ssize_t got = ::pread(descriptor_, bytes.data() + done, count - done, static_cast<off_t>(begin + done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) refuse(std::strerror(errno));
      if (got == 0) break;
      done += static_cast<std::size_t>(got);
    }
    bytes.resize(done);
    return bytes;
  }

 private:
  void close() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }

  int descriptor_ = -1;
  std::uintmax_t size_ = 0;  // [bytes]
};

}  // namespace

std::string read_bytes(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  const InputFile input(file);
  if (input.size() > max_bytes) refuse(fmt::format("expected at most {} bytes, got {}", max_bytes, input.size()));
  try {
    return input.read(input.size());
  } catch (const std::bad_alloc&) {
    refuse(fmt::format("its {} bytes are too many for the memory of this machine", input.size()));
  }
}

std::string read_file(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  try {
    return read_bytes(file, max_bytes);
  } catch (const std::exception& error) {
    throw Error(ExitCode::asset_unreadable, "{}: cannot be read: {}", file.string(), error.what());
  }
}

void check_is_file(const std::filesystem::path& file) {
  const InputFile input(file);
}

std::string read_start(const std::filesystem::path& file, std::size_t count) {
  try {
    const InputFile input(file);
    return input.read(std::min<std::uintmax_t>(count, input.size()));
  } catch (const std::runtime_error&) {
    return {};
  }
}

std::string read_end(const std::filesystem::path& file, std::size_t count) {
  try {
    const InputFile input(file);
    const std::uintmax_t size = std::min<std::uintmax_t>(count, input.size());
    return input.read(size, input.size() - size);
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace weft
