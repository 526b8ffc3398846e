#include "core/temporary_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "core/error.hpp"
#include "core/input_file.hpp"

namespace weft {
namespace {

namespace fs = std::filesystem;

// Path of a temporary file, for the signal handler, which may neither allocate memory nor wait for a lock. A run has
// far fewer than 64 temporary files at once.
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

std::string temporary_name(const std::string& final_name) {
  std::string name = fmt::format(".{}.weft-{}.tmp", final_name, ::getpid());
  if (name.size() <= NAME_MAX) return name;
  return fmt::format(".{:x}.weft-{}.tmp", std::hash<std::string>()(final_name), ::getpid());
}

std::string reason(int error) {
  return std::generic_category().message(error);
}

[[noreturn]] void fail(const fs::path& file, const char* what, const std::string& why) {
  throw Error(ExitCode::output_failed, "{}: {}: {}", file.string(), what, why);
}

bool lock(int descriptor) {
  return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
}

// Removes a temporary file or folder if no process holds its lock: the process that created it has
// then been killed.
void remove_abandoned(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  std::error_code ignored;
  if (lock(descriptor) && has_name(path, descriptor)) fs::remove_all(path, ignored);
  ::close(descriptor);
}

// At the first call for a folder, creates it and removes the temporary files that killed processes
// have left there. Later calls do not create it again: if somebody has removed the folder, output
// is not wanted there. Returns false, with the reason in `error`, if the folder cannot be created.
bool prepare_once(const fs::path& folder, std::error_code& error) {
  static std::mutex mutex;
  static std::set<fs::path> prepared;
  const std::lock_guard lock(mutex);
  if (prepared.contains(folder)) return true;
  fs::create_directories(folder, error);
  if (error) return false;
  prepared.insert(folder);
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end; entry.increment(ignored))
    if (!final_name_of(entry->path().filename().string()).empty()) remove_abandoned(entry->path());
  return true;
}

std::mutex g_kept_mutex;
std::set<fs::path> g_kept;  // absolute paths; see protect_missing_file()

fs::path normalise(const fs::path& file) {
  std::error_code error;
  return fs::absolute(file, error).lexically_normal();
}

// Renames a file and returns true. If the new name is in use, returns false with errno EEXIST.
bool rename_to_free_name(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  // If the file system lacks RENAME_NOREPLACE, it may still have hard links.
  if (::link(from.c_str(), to.c_str()) == 0) return ::unlink(from.c_str()) == 0;
  if (errno == EEXIST) return false;
  struct stat status {};
  if (::lstat(to.c_str(), &status) == 0) {
    errno = EEXIST;
    return false;
  }
  return std::rename(from.c_str(), to.c_str()) == 0;
}

// Creates and locks the file or folder; returns its descriptor, or −1 with errno. Before this
// process locks it, another process that cleans up the parent folder may lock and remove it. In
// this case, the function tries again, for half a second at most, because the other process may
// have to wait for a processor.
int create_and_lock(const fs::path& path, TemporaryName::Kind kind) {
  constexpr int kAttempts = 10;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (attempt > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1 << (attempt - 1)));
    if (kind == TemporaryName::Kind::folder && ::mkdir(path.c_str(), 0777) != 0 && errno != EEXIST) return -1;
    const int flags = kind == TemporaryName::Kind::file ? O_RDWR | O_CREAT : O_RDONLY | O_DIRECTORY;
    const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno != ENOENT) return -1;
    if (descriptor < 0) continue;
    // If the file system has no locks, remove_abandoned() removes nothing, so the lock is not needed.
    if ((lock(descriptor) || errno != EWOULDBLOCK) && has_name(path, descriptor)) return descriptor;
    ::close(descriptor);
    errno = EBUSY;
  }
  return -1;
}

}  // namespace

TemporaryName::TemporaryName(const fs::path& final_name, Kind kind) {
  // The path is absolute, so that it stays valid if the working folder changes.
  std::error_code error;
  const fs::path absolute = fs::absolute(final_name, error);
  if (error || !prepare_once(absolute.parent_path(), error))
    fail(final_name, "cannot make the folder", error.message());
  path_ = absolute.parent_path() / temporary_name(absolute.filename().string());
  descriptor_ = create_and_lock(path_, kind);
  if (descriptor_ < 0) fail(final_name, "cannot be written", reason(errno));
  if (kind == Kind::file) slot_ = claim_slot(path_.string());
}

TemporaryName::~TemporaryName() {
  const fs::path path = path_;
  // The process may have no free file descriptor. unlink() needs none, but remove_all() of a folder
  // needs some. Therefore release(), which closes one, comes before remove_all().
  const bool removed = path.empty() || ::unlink(path.c_str()) == 0;
  release();
  std::error_code ignored;
  if (!removed) fs::remove_all(path, ignored);
}

void TemporaryName::release() {
  if (slot_ >= 0) g_slots[slot_].state.store(Slot::free);
  if (descriptor_ >= 0) ::close(descriptor_);
  slot_ = descriptor_ = -1;
  path_.clear();
}

namespace {

// Refuses folders and devices: renaming onto a folder would fail at the end of the work, and renaming onto /dev/null
// would replace the device.
const fs::path& require_file_name(const fs::path& final_name) {
  std::error_code ignored;
  const auto status = fs::status(final_name, ignored);
  if (!final_name.has_filename() || (fs::exists(status) && !fs::is_regular_file(status)))
    throw Error(ExitCode::output_failed, "{}: expected the name of a file to write, got a folder or a device",
                final_name.string());
  return final_name;
}

}  // namespace

TemporaryFile::TemporaryFile(fs::path final_name)
    : final_name_(std::move(final_name)), temporary_(require_file_name(final_name_), TemporaryName::Kind::file) {}

void TemporaryFile::commit(Flush flush) {
  const bool replaces = may_replace(final_name_);
  const bool good =
      (flush == Flush::no || ::fsync(temporary_.descriptor()) == 0 || errno == EINVAL) &&
      (replaces ? std::rename(path().c_str(), final_name_.c_str()) == 0 : rename_to_free_name(path(), final_name_));
  if (!good && !replaces && errno == EEXIST)
    throw Error(ExitCode::output_failed,
                "{}: was made by somebody else while this command worked, and is kept; give --overwrite to replace it, "
                "or another name",
                final_name_.string());
  if (!good) fail(final_name_, "cannot be written", reason(errno));
  temporary_.release();
  const std::lock_guard lock(g_kept_mutex);
  g_kept.erase(normalise(final_name_));
}

void protect_missing_file(const fs::path& file) {
  const std::lock_guard lock(g_kept_mutex);
  g_kept.insert(normalise(file));
}

bool may_replace(const fs::path& file) {
  const std::lock_guard lock(g_kept_mutex);
  return !g_kept.contains(normalise(file));
}

std::string_view final_name_of(std::string_view name) {
  constexpr std::string_view kMark = ".weft-", kEnding = ".tmp";
  const std::size_t mark = name.rfind(kMark);
  if (!name.starts_with('.') || !name.ends_with(kEnding) || mark == std::string_view::npos || mark == 0) return {};
  const std::size_t first = mark + kMark.size(), last = name.size() - kEnding.size();
  const bool is_number = first < last && name.find_first_not_of("0123456789", first) == last;
  return is_number ? name.substr(1, mark - 1) : std::string_view();
}

void remove_temporary_files() noexcept {
  for (Slot& slot : g_slots) {
    if (slot.state.load() == Slot::active) ::unlink(slot.path.data());
  }
}

bool has_name(const fs::path& path, int descriptor) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::lstat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

bool holds(const fs::path& file, std::string_view content) {
  std::error_code error;
  return fs::file_size(file, error) == content.size() && !error && read_start(file, content.size()) == content;
}

void write_file(const fs::path& file, std::string_view content, Flush flush) {
  TemporaryFile temporary(file);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(temporary.path().c_str(), "wbe"),
                                                            [](std::FILE* f) { return std::fclose(f); });
  bool good = out && std::fwrite(content.data(), 1, content.size(), out.get()) == content.size();
  good = good && std::fflush(out.get()) == 0;
  if (!good) fail(file, "cannot be written", reason(errno));
  // Several machines may draw parts of one film. Each of them writes the same scene file beside the film, so a
  // protected file with the same content is no conflict.
  const auto is_there = [&] { return !may_replace(file) && holds(file, content); };
  if (is_there()) return;
  try {
    temporary.commit(flush);
  } catch (const Error&) {
    if (!is_there()) throw;  // if it is there, another machine has written it meanwhile
  }
}

void check_writable(const fs::path& file) {
  const TemporaryFile probe(file);
}

}  // namespace weft
