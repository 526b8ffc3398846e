#include "tools/compare/acceptance.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <memory>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/temporary_file.hpp"
#include "film/image/png.hpp"
#include "film/video/decoder.hpp"
#include "tools/compare/files.hpp"
#include "tools/compare/references.hpp"

namespace weft::compare {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLogName = "accepted.md";
constexpr const char* kLogHead =
    "# Accepted references\n"
    "\n"
    "Written by `weft accept`. Hashes: `sha256sum FILE | cut -c1-16`.\n"
    "\n"
    "| date (UTC) | reference | old | new | difference | reason | by |\n"
    "|---|---|---|---|---|---|---|\n";

// Reads the file to its end, since a reference must be complete.
void check_readable(const fs::path& file) {
  if (!fs::is_regular_file(file)) {
    throw Error(ExitCode::asset_unreadable, "{}: {}", file.string(),
                fs::is_directory(file) ? "expected a picture or video, got a folder; name each one to accept"
                                       : "does not exist");
  }
  if (!is_video(file)) {
    image::read_png(file);
    return;
  }
  video::Decoder decoder(file);
  int frames = 0;
  while (decoder.next()) ++frames;
  if (frames == 0) throw Error(ExitCode::asset_unreadable, "{}: holds no pictures", file.string());
}

std::string describe(const FileComparison& result) {
  const Figures& f = result.worst.figures;
  if (!result.problem.empty()) return result.problem;
  return fmt::format("{}{} pixels by up to {} levels, SSIM {:.5f}, FLIP {:.2g}",
                     result.video ? fmt::format("frame {} (worst): ", result.worst_frame) : "", f.pixels_changed,
                     f.largest, f.ssim, f.flip);
}

// Escapes one cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c == '\n' || c == '\r' ? ' ' : c;
  }
  return escaped;
}

std::string now() {
  const std::time_t seconds = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M", &utc);
  return text.data();
}

/// Creates a folder and locks it. Other FolderLock objects for this folder, in any process, wait in their constructors
/// until this object is destroyed. On file systems without locks, they do not wait.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder) {
    std::error_code ignored;  // the write to this folder reports the error
    fs::create_directories(folder, ignored);
    descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    while (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) continue;
  }
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

void add_line(const fs::path& log, const std::string& line) {
  // A link whose target is missing is not replaced: reading it fails.
  std::string text = fs::exists(fs::symlink_status(log)) ? read_file(log) : kLogHead;
  if (!text.empty() && text.back() != '\n') text += '\n';
  write_file(log, text + line);
}

}  // namespace

std::string short_hash_of(const std::string& bytes) {
  const std::unique_ptr<AVSHA, decltype(&av_free)> sha(av_sha_alloc(), av_free);
  std::array<std::uint8_t, 32> digest{};
  if (!sha || av_sha_init(sha.get(), 256) < 0) throw Error(ExitCode::internal, "libav offers no SHA-256");
  av_sha_update(sha.get(), reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  av_sha_final(sha.get(), digest.data());
  std::string text;
  for (std::size_t i = 0; i < 8; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

std::string short_hash(const fs::path& file) {
  return short_hash_of(read_file(file));
}

Acceptance Acceptance::plan(const fs::path& reference, const fs::path& test, const std::string& name) {
  Acceptance plan;
  if (!is_comparable(test)) {
    throw Error(ExitCode::usage, "{}: expected a picture (.png) or a video such as .mp4", test.string());
  }
  check_readable(test);
  if (is_heat_map(test))
    throw Error(ExitCode::usage, "{}: expected a picture of a scene, got a heat map of weft diff", test.string());
  plan.test = test;
  const bool is_file = is_comparable(reference) && !fs::is_directory(reference);
  if (is_file && reference.extension() != test.extension()) {
    throw Error(ExitCode::usage, "{} cannot take the place of {}: expected the same kind of file", test.string(),
                reference.string());
  }
  const fs::path folder = is_file ? reference.parent_path() : reference;
  plan.log = folder / kLogName;
  if (is_file) {
    plan.reference = reference;
    return plan;
  }
  const fs::path fresh = fs::is_directory(folder / "default") ? folder / "default" / name : folder / name;
  plan.reference = find_reference(folder, name, machine_class_of(test)).value_or(fresh);
  return plan;
}

bool Acceptance::carry_out() const {
  const fs::path folder = log.parent_path().empty() ? "." : log.parent_path();
  const FolderLock lock(folder);  // without it, two processes that rewrite the log could lose a line
  const std::string bytes = read_file(test);
  std::string old_hash = "none", difference = "new";
  if (fs::exists(reference)) {
    const FileComparison result = compare_files(reference, test, {});
    if (result.outcome == FileComparison::Outcome::same) return false;
    old_hash = short_hash(reference);
    difference = describe(result);
  }
  check_writable(reference);  // before the log is written: it must not name a reference that was not replaced
  const fs::path name = reference.lexically_proximate(folder);
  add_line(log, fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", now(), cell(name.generic_string()), old_hash,
                            short_hash_of(bytes), cell(difference), cell(reason), cell(user)));
  write_file(reference, bytes);
  return true;
}

}  // namespace weft::compare
