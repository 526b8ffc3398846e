#include "film/cache/reader.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "film/cache/names.hpp"

namespace weft::cache {

namespace fs = std::filesystem;

namespace {

// Reads a file. If it does not begin with kMagic, throws before it reads the rest, which may be large.
std::string read_container(const fs::path& file) {
  const std::string start = read_start(file, kMagic.size());
  if (start.size() == kMagic.size() && start != kMagic) throw std::runtime_error("it is no file of a frame cache");
  return read_file(file);
}

}  // namespace

bool is_cache(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / kManifestFile, ignored);
}

Reader::Reader(fs::path folder, AcceptedLooks looks) : folder_(std::move(folder)), looks_(looks) {
  if (!is_cache(folder_))
    throw Error(ExitCode::asset_unreadable, "{}: expected a frame cache, a folder with a {}; weft simulate makes one",
                folder_.string(), kManifestFile);
  const fs::path manifest = folder_ / kManifestFile;
  manifest_ = read_checked(manifest, [&] { return parse_manifest(read_file(manifest), manifest.string()); });
  std::error_code ignored;
  if (fs::exists(folder_ / kSurfacesFile, ignored)) shared_surfaces();
}

const Surfaces& Reader::shared_surfaces() const {
  const std::lock_guard lock(mutex_);
  if (surfaces_) return *surfaces_;
  const fs::path file = folder_ / kSurfacesFile;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) throw Error(ExitCode::asset_unreadable, "{}: holds no frame yet", folder_.string());
  surfaces_ = read_checked(file, [&] {
    Surfaces surfaces = decode_surfaces(read_part(kSurfacesFile, Kind::surfaces, 0).payload);
    check_objects(surfaces);
    return surfaces;
  });
  return *surfaces_;
}

void Reader::check_objects(const Surfaces& surfaces) const {
  const bool same = std::equal(manifest_.objects.begin(), manifest_.objects.end(), surfaces.surfaces.begin(),
                               surfaces.surfaces.end(), [](const auto& object, const auto& surface) {
                                 return object.name == surface->name && object.kind == surface->kind;
                               });
  if (!same) throw std::runtime_error("its objects are not those of the manifest");
  for (std::size_t i = 0; i < manifest_.objects.size(); ++i)
    if (manifest_.objects[i].vertices != surfaces.positions[i].size())
      throw std::runtime_error(fmt::format("expected {} vertices of '{}' as in the manifest, got {}",
                                           manifest_.objects[i].vertices, manifest_.objects[i].name,
                                           surfaces.positions[i].size()));
}

void Reader::check_scene(std::uint64_t hash) const {
  const std::vector<std::uint64_t>& former = manifest_.former_hashes;
  if (hash == manifest_.scene_hash) return;
  if (std::find(former.begin(), former.end(), hash) == former.end())
    throw std::runtime_error(
        fmt::format("expected a file of scene {:016x}, got one of {:016x}", manifest_.scene_hash, hash));
  if (looks_ == AcceptedLooks::of_scene)
    throw std::runtime_error(
        "it has the look from before the scene was changed; weft simulate --resume continues the cache");
}

Content Reader::read_part(const char* name, Kind kind, std::optional<int> frame) const {
  const fs::path file = folder_ / name;
  return read_checked(file, [&] {
    Content content = unpack(read_container(file));
    check_scene(content.label.scene_hash);
    if (content.label.kind != kind || (frame && content.label.frame != *frame))
      throw std::runtime_error("it is another file of the cache under this name");
    return content;
  });
}

std::string Reader::scene_text() const {
  const fs::path file = folder_ / kSceneFile;
  // Runs copy this file to their output folder. A link could thereby expose a file from elsewhere.
  std::error_code ignored;
  if (fs::is_symlink(file, ignored))
    throw Error(ExitCode::asset_unreadable, "{}: broken: expected a file of the cache, got a link", file.string());
  return read_file(file, kMaxTextBytes);
}

std::vector<int> Reader::frames() const {
  std::vector<int> frames;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    const std::optional<int> frame = frame_of(entry->path().filename().string());
    std::error_code ignored;
    if (frame && *frame < manifest_.frame_count && entry->is_regular_file(ignored)) frames.push_back(*frame);
  }
  if (error) throw Error(ExitCode::asset_unreadable, "{}: cannot be read: {}", folder_.string(), error.message());
  std::sort(frames.begin(), frames.end());
  return frames;
}

bool Reader::has(int frame) const {
  std::error_code ignored;
  return frame >= 0 && frame < manifest_.frame_count && fs::is_regular_file(folder_ / frame_file(frame), ignored);
}

CachedFrame Reader::read(int frame) const {
  const std::string name = frame_file(frame);
  const Surfaces& shared = shared_surfaces();
  const Content content = read_part(name.c_str(), Kind::frame, frame);
  CachedFrame cached = read_checked(folder_ / name, [&] { return decode_frame(content.payload, frame, shared); });
  cached.scene_hash = content.label.scene_hash;
  return cached;
}

std::uint64_t Reader::verify(int frame) const {
  const fs::path file = folder_ / frame_file(frame);
  return read_checked(file, [&] {
    const Label label = cache::verify(read_container(file));
    check_scene(label.scene_hash);
    if (label.kind != Kind::frame || label.frame != frame)
      throw std::runtime_error("it is another file under this name");
    return label.scene_hash;
  });
}

std::optional<SolverState> Reader::state() const {
  std::error_code ignored;
  if (!fs::exists(folder_ / kStateFile, ignored)) return std::nullopt;
  Content content = read_part(kStateFile, Kind::state, std::nullopt);
  return SolverState{content.label.frame, std::move(content.payload)};
}

}  // namespace weft::cache
