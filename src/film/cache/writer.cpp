#include "film/cache/writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/temporary_file.hpp"
#include "film/cache/container.hpp"
#include "film/cache/names.hpp"
#include "film/cache/reader.hpp"

namespace weft::cache {
namespace {

namespace fs = std::filesystem;

bool is_name_of_cache(std::string_view name) {
  return name == kManifestFile || name == kSceneFile || name == kSurfacesFile || name == kStateFile ||
         name == kLockFile || name == kOutputsFile || frame_of(name);
}

/// The first bytes that Weft writes to a file with the name `name`; nullopt if they are not fixed.
std::optional<std::string_view> beginning_of(std::string_view name) {
  if (name == kManifestFile) return kManifestStart;
  if (name == kOutputsFile) return "-";
  if (name.ends_with(".weft")) return kMagic;
  return std::nullopt;
}

/// Whether a file begins as Weft writes it, or with zero bytes, as after a crash of the machine before the content was
/// on disk.
bool begins_as_written(const fs::path& file) {
  const auto beginning = beginning_of(file.filename().string());
  if (!beginning) return false;
  const std::string start = read_start(file, beginning->size());
  return start == *beginning || (!start.empty() && start.find_first_not_of('\0') == std::string::npos);
}

/// Whether a file of the folder belongs to the cache, so that it may be removed. Its name must be that of a file of a
/// cache, or of a temporary file for such a file. The name of a temporary file suffices. Other files must be regular
/// files that are empty or begin as Weft writes them. The scene file has no fixed first bytes. It belongs to the cache
/// if the manifest or the surfaces file beside it begins as Weft writes it.
bool belongs_to_cache(const fs::path& folder, const std::string& name) {
  const std::string_view kept = final_name_of(name);
  if (!kept.empty()) return is_name_of_cache(kept);
  const fs::path file = folder / name;
  std::error_code error;
  if (!is_name_of_cache(name) || !fs::is_regular_file(fs::symlink_status(file, error))) return false;
  return fs::file_size(file, error) == 0 || begins_as_written(file) ||
         (name == kSceneFile &&
          (begins_as_written(folder / kManifestFile) || begins_as_written(folder / kSurfacesFile)));
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    names.push_back(entry->path().filename().string());
  if (error) throw Error(ExitCode::output_failed, "{}: cannot be read: {}", folder.string(), error.message());
  return names;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw Error(ExitCode::output_failed, "{}: cannot make the folder: {}", folder.string(),
                error ? error.message() : "there is a file of this name");
  for (const std::string& name : names_in(folder))
    if (!belongs_to_cache(folder, name))
      throw Error(ExitCode::output_failed, "{}: holds {}, which is no part of a frame cache; give another folder",
                  folder.string(), name);
}

}  // namespace

Lock::Lock(fs::path folder) : folder_(std::move(folder)) {
  const fs::path file = folder_ / kLockFile;
  do {
    if (descriptor_ >= 0) ::close(descriptor_);
    make_folder(folder_);
    descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throw Error(ExitCode::output_failed, "{}: cannot be written: {}", file.string(), std::strerror(errno));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      ::close(descriptor_);
      if (error == EWOULDBLOCK)
        throw Error(ExitCode::output_failed,
                    "{}: another process writes it; wait until that process ends, or give another name",
                    folder_.string());
      throw Error(ExitCode::output_failed, "{}: cannot be locked: {}", file.string(), std::strerror(error));
    }
    // Between open() and flock(), the previous owner of the lock may have removed the folder. Then tries again.
  } while (!has_name(file, descriptor_));
}

Lock::~Lock() {
  ::close(descriptor_);
}

bool Lock::empty() const {
  const std::vector<std::string> names = names_in(folder_);
  return std::ranges::all_of(names, [](const auto& name) { return name == kLockFile || name == kOutputsFile; });
}

void Lock::clear() const {
  // Removes the scene file first, because belongs_to_cache() recognises it by the files beside it. Then removes the
  // manifest, because the other files are no cache without it.
  for (const char* name : {kSceneFile, kManifestFile})
    if (belongs_to_cache(folder_, name)) ::unlink((folder_ / name).c_str());
  for (const std::string& name : names_in(folder_))
    if (name != kLockFile && belongs_to_cache(folder_, name)) ::unlink((folder_ / name).c_str());
}

void Lock::remove() const {
  clear();
  ::unlink((folder_ / kLockFile).c_str());
  ::rmdir(folder_.c_str());
}

Writer::Writer(const Lock& lock, Manifest manifest, std::string_view scene_text)
    : folder_(lock.folder()), manifest_(std::move(manifest)) {
  for (const std::string& name : names_in(folder_))
    if (const auto frame = frame_of(name)) own_frames_.insert(*frame);
  write(kManifestFile, manifest_text(manifest_));
  write(kSceneFile, std::string(scene_text));
}

void Writer::add(const frame::FrameSnapshot& snapshot, const simulation::FrameReport& report) {
  if (snapshot.frame == 0) {
    surfaces_ = surfaces_of(snapshot);
    const std::string content = pack({Kind::surfaces, 0, manifest_.scene_hash}, encode_surfaces(*surfaces_));
    write(kSurfacesFile, content);
    bytes_added_ += content.size();
  } else if (!surfaces_) {
    surfaces_ = surfaces_of(*Reader(folder_).snapshot(0));
  }
  const std::string content =
      pack({Kind::frame, snapshot.frame, manifest_.scene_hash}, encode_frame(snapshot, report, *surfaces_));
  // Because of the lock, no other Weft process writes to this folder. If a frame file that did not exist when this
  // Writer was created exists now, another program wrote it. Such a file must not be replaced.
  if (own_frames_.insert(snapshot.frame).second) protect_missing_file(folder_ / frame_file(snapshot.frame));
  write(frame_file(snapshot.frame), content);
  bytes_added_ += content.size();
}

void Writer::save_state(int frame, std::string_view bytes) {
  write(kStateFile, pack({Kind::state, frame, manifest_.scene_hash}, bytes));
}

void Writer::write(const std::string& name, const std::string& content) {
  // No flush: if the machine crashes before the data are on disk, readers find a wrong checksum.
  write_file(folder_ / name, content, Flush::no);
}

}  // namespace weft::cache
