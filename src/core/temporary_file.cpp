#include "core/temporary_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>

#include "core/error.hpp"

namespace weft {
namespace {

// What the signal handler may read: fixed memory, no locks. 64 is far above the few files a run has open at once.
struct Slot {
  enum State : int { free, claimed, active };
  std::atomic<int> state{free};
  std::array<char, 4096> path{};
};
std::array<Slot, 64> g_slots;

int claim_slot(const std::string& path) {
  if (path.size() >= g_slots[0].path.size()) return -1;
  for (std::size_t i = 0; i < g_slots.size(); ++i) {
    int expected = Slot::free;
    if (!g_slots[i].state.compare_exchange_strong(expected, Slot::claimed)) continue;
    std::memcpy(g_slots[i].path.data(), path.c_str(), path.size() + 1);
    g_slots[i].state.store(Slot::active);
    return static_cast<int>(i);
  }
  return -1;
}

std::string reason(int error) {
  return std::generic_category().message(error);
}

// Without it a crash of the machine soon after the rename can leave an empty file under the final name.
int flush_to_disk(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int error = ::fsync(descriptor) != 0 && errno != EINVAL ? errno : 0;
  ::close(descriptor);
  return error;
}

}  // namespace

TemporaryFile::TemporaryFile(std::filesystem::path final_name) : final_name_(std::move(final_name)) {
  // A rename onto a folder would fail after all the work, and one onto /dev/null would replace the device.
  std::error_code status_error;
  const auto status = std::filesystem::status(final_name_, status_error);
  if (!final_name_.has_filename() || (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))) {
    throw Error(ExitCode::output_failed, "{}: expected the name of a file to write, got a folder or a device",
                final_name_.string());
  }
  // Absolute, so that the name stays right whatever happens to the working folder.
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(final_name_, error);
  if (!error) std::filesystem::create_directories(absolute.parent_path(), error);
  if (error) {
    throw Error(ExitCode::output_failed, "{}: cannot make the folder: {}", final_name_.string(), error.message());
  }
  path_ = absolute.parent_path() / fmt::format(".{}.{}.tmp", absolute.filename().string(), ::getpid());
  slot_ = claim_slot(path_.string());
}

TemporaryFile::~TemporaryFile() {
  if (path_.empty()) return;
  ::unlink(path_.c_str());
  if (slot_ >= 0) g_slots[static_cast<std::size_t>(slot_)].state.store(Slot::free);
}

void TemporaryFile::commit(Flush flush) {
  int error = flush == Flush::yes ? flush_to_disk(path_) : 0;
  if (error == 0 && std::rename(path_.c_str(), final_name_.c_str()) != 0) error = errno;
  if (error != 0)
    throw Error(ExitCode::output_failed, "{}: cannot be written: {}", final_name_.string(), reason(error));
  if (slot_ >= 0) g_slots[static_cast<std::size_t>(slot_)].state.store(Slot::free);
  path_.clear();
}

void remove_temporary_files() noexcept {
  for (Slot& slot : g_slots) {
    if (slot.state.load() == Slot::active) ::unlink(slot.path.data());
  }
}

void write_file(const std::filesystem::path& file, std::string_view content, Flush flush) {
  TemporaryFile temporary(file);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(temporary.path().c_str(), "wbe"),
                                                            [](std::FILE* f) { return std::fclose(f); });
  bool good = out && std::fwrite(content.data(), 1, content.size(), out.get()) == content.size();
  good = good && std::fflush(out.get()) == 0;
  if (!good) throw Error(ExitCode::output_failed, "{}: cannot be written: {}", file.string(), reason(errno));
  temporary.commit(flush);
}

}  // namespace weft
