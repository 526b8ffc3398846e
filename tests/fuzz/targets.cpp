#include "fuzz/targets.hpp"

#include <png.h>
#include <sys/mman.h>
#include <unistd.h>
#include <xxhash.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "cache/sample.hpp"
#include "core/error.hpp"
#include "core/json.hpp"
#include "core/nesting.hpp"
#include "core/toml.hpp"
#include "film/assets/character_reader.hpp"
#include "film/assets/raw_mesh.hpp"
#include "film/cache/codec.hpp"
#include "film/cache/container.hpp"
#include "film/cache/manifest.hpp"
#include "film/garment/outline.hpp"
#include "film/garment/pattern.hpp"
#include "film/garment/specification.hpp"
#include "film/garment/svg.hpp"
#include "film/image/exr.hpp"
#include "film/image/picture.hpp"
#include "film/image/png.hpp"
#include "film/scene/findings.hpp"
#include "film/scene/loader.hpp"
#include "tools/cli/diff_limits.hpp"
#include "tools/cli/sweep_plan.hpp"
#include "tools/review/decisions.hpp"
#include "tools/review/review.hpp"
#include "tools/review/run_data.hpp"

namespace weft::fuzz {
namespace {

using Bytes = std::span<const std::uint8_t>;

void require(bool promise, const char* text) {
  if (!promise) throw std::logic_error(text);
}

std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A file in memory, for readers that need a file name. A million files a minute would wear out a disk.
class MemoryFile {
 public:
  explicit MemoryFile(Bytes bytes) : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    require(descriptor_ >= 0, "no file in memory");
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      require(written > 0, "file in memory cannot be written");
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// Calls `read`; an error is accepted if its exit code is one of `codes`.
template <class Read>
void may_refuse(std::initializer_list<ExitCode> codes, const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    for (const ExitCode code : codes)
      if (error.code() == code) return;
    throw std::logic_error(std::string("refused as something else: ") + error.what());
  }
}

// The scenes of the corpus name files relative to the folder of this file, which need not exist.
constexpr const char* kSceneFile = WEFT_SOURCE_DIR "/tests/scene/fuzz.toml";

void read_scene(Bytes bytes) {
  const scene::LoadResult loaded = scene::load_text(text_of(bytes), kSceneFile);
  require(loaded.ok() == loaded.describe().empty(), "mistakes are described");
  if (!loaded.ok()) return;
  const scene::LoadResult again = scene::load_text(scene::effective_scene(loaded.scene), kSceneFile);
  if (!again.ok()) throw std::logic_error("the effective scene is refused: " + again.describe());
}

void read_pattern(Bytes bytes) {
  may_refuse({ExitCode::scene_invalid, ExitCode::asset_unreadable},
             [&] { (void)garment::load_pattern(MemoryFile(bytes).path(), "fuzz"); });
}

/// Reads patterns of GarmentCode.
void read_specification(Bytes bytes) {
  may_refuse({ExitCode::scene_invalid, ExitCode::asset_unreadable}, [&] {
    scene::Findings findings;
    garment::Pattern pattern;
    const bool read = garment::read_specification(std::string(text_of(bytes)), findings, pattern);
    require(read || !findings.take_mistakes().empty(), "what is refused is said");
    for (const garment::Panel& panel : pattern.panels)
      if (!garment::parse_path(panel.path).mistake.empty()) throw std::logic_error("no path: " + panel.path);
  });
}

int depth_of(const toml::node& node) {
  int deepest = 0;
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table) deepest = std::max(deepest, 1 + depth_of(value));
  } else if (const auto* list = node.as_array()) {
    for (const toml::node& value : *list) deepest = std::max(deepest, 1 + depth_of(value));
  }
  return deepest;
}

int depth_of(const nlohmann::ordered_json& json) {
  int deepest = 0;
  if (json.is_structured())
    for (const auto& value : json) deepest = std::max(deepest, 1 + depth_of(value));
  return deepest;
}

// nests_too_deep() limits the parts of a header to kMaxDepth, and separately the keys and values below it. Each part of
// a header can be an array of tables, which counts as two levels. The constant 3 is for levels that the check does not
// count, such as the first part of a key.
void read_toml(Bytes bytes) {
  try {
    require(depth_of(parse_toml(text_of(bytes))) <= 3 * kMaxDepth + 3, "TOML nests as deep as it may");
  } catch (const toml::parse_error&) {
  }
}

void read_json(Bytes bytes) {
  try {
    const auto json = parse_json(text_of(bytes));
    require(depth_of(json) <= kMaxDepth, "JSON nests as deep as it may");
    (void)json_text(json);
    (void)review::mistake_of_decision(json);
  } catch (const std::logic_error&) {
    throw;
  } catch (const std::exception&) {
  }
}

/// Reads run data for a review page from arbitrary statistics.
void read_statistics(Bytes bytes) {
  review::RunFiles run;
  run.stats = "s.json";
  try {
    run.stats_json = parse_json(text_of(bytes));
  } catch (const std::exception&) {
    return;
  }
  if (!review::take_statistics(run)) return;
  const review::Json data = review::run_data(run);
  require(data.at("digest").is_object() && data.at("columns").size() <= 200, "columns are bounded");
  require(review::picture_times(run).count >= 0, "pictures are counted");
  (void)review::script_json(data);
}

/// Reads lists of runs of `weft sweep`, as TOML and as CSV, and an argument such as `key=a,b,c`.
void read_list(Bytes bytes) {
  const std::string text(text_of(bytes));
  for (const char* file : {"fuzz.toml", "fuzz.csv"}) {
    may_refuse({ExitCode::usage, ExitCode::asset_unreadable}, [&] {
      std::set<std::string> names;
      for (const cli::SweepRun& run : cli::plan_sweep(cli::parse_list(file, text), {})) {
        require(run.name != "." && run.name != ".." && run.name.find('/') == std::string::npos, "a name of a folder");
        require(!run.name.empty() && run.name.size() < 140 && names.insert(run.name).second, "a name of its own");
      }
    });
  }
  may_refuse({ExitCode::usage}, [&] { (void)cli::plan_sweep({}, {cli::parse_axis(text)}); });
}

/// Reads limits of single pictures, as in `weft diff --limits`.
void read_limits(Bytes bytes) {
  may_refuse({ExitCode::asset_unreadable}, [&] {
    const compare::Limits limits = cli::DiffLimits({}, MemoryFile(bytes).path()).of("front/a.png").limits;
    require(limits.pixel_tolerance >= 0 && limits.pixel_tolerance <= 255, "a tolerance is in levels");
    require(!limits.flip || (*limits.flip >= 0 && *limits.flip <= 1), "a limit is a share");
  });
}

void check_outline(const garment::Outline& outline) {
  require(!outline.empty(), "an outline has curves");
  for (std::size_t i = 0; i < outline.size(); ++i) {
    for (const Vec2& point : outline[i].control) require(point.allFinite(), "an outline is finite");
    require(outline[i].start() == outline[(i + outline.size() - 1) % outline.size()].end(), "an outline is closed");
  }
}

// In all drawings of the corpus, the id of the panel's element is "front".
void read_svg(Bytes bytes) {
  may_refuse({ExitCode::asset_unreadable},
             [&] { check_outline(garment::load_svg_panel(MemoryFile(bytes).path(), "front").outline); });
}

void read_outline(Bytes bytes) {
  const garment::ParsedPath parsed = garment::parse_path(text_of(bytes));
  if (!parsed.mistake.empty()) return;
  check_outline(parsed.outline);
  require(garment::Arclength(parsed.outline).length() >= 0, "a length is no less than zero");
}

/// Corrects the checksums of a PNG file, so that the fuzzer reaches the code after the check.
std::vector<std::uint8_t> with_right_sums(Bytes bytes) {
  std::vector<std::uint8_t> mended(bytes.begin(), bytes.end());
  for (std::size_t chunk = 8; chunk + 12 <= mended.size();) {
    const std::size_t length = png_get_uint_32(&mended[chunk]);
    if (length > mended.size() - chunk - 12) break;
    uLong sum = crc32(0, &mended[chunk + 4], static_cast<uInt>(length + 4));
    for (std::size_t i = 4; i-- > 0; sum >>= 8) mended[chunk + 8 + length + i] = static_cast<std::uint8_t>(sum);
    chunk += length + 12;
  }
  return mended;
}

void read_image(Bytes bytes) {
  may_refuse({ExitCode::asset_unreadable}, [&] {
    image::Metadata metadata;
    const image::Image image = image::read_png(MemoryFile(with_right_sums(bytes)).path(), &metadata);
    require(image.rgb.size() == 3 * std::size_t(image.width) * std::size_t(image.height), "an image is whole");
  });
}

/// Reads pictures of all formats that cloth accepts.
void read_picture(Bytes bytes) {
  try {
    const image::Picture picture = image::decode_picture(text_of(bytes));
    require(picture.rgba.size() == 4 * std::size_t(picture.width) * std::size_t(picture.height), "a picture is whole");
  } catch (const std::logic_error&) {
    throw;
  } catch (const std::runtime_error&) {
  }
}

void read_layers(Bytes bytes) {
  may_refuse({ExitCode::asset_unreadable}, [&] {
    const image::ExrHeader header = image::read_exr_header(MemoryFile(bytes).path());
    require(header.width > 0 && header.height > 0, "a picture has a size");
  });
}

// Decodes the answer of a Weft child process. The child reads arbitrary files, which may corrupt it, so its answer
// cannot be trusted.
template <auto decode>
void read_answer(Bytes bytes) {
  try {
    (void)decode(text_of(bytes));
  } catch (const std::runtime_error&) {
  }
}

// Corrects sizes and checksum of the header, so that the fuzzer reaches the code after the check.
void read_container(Bytes bytes) {
  constexpr std::size_t kStoredSizeAt = 40, kSumAt = 48, kHeaderSize = 56;
  std::string file(text_of(bytes));
  if (file.size() >= kHeaderSize) {
    const std::uint64_t stored_size = file.size() - kHeaderSize;
    std::memcpy(&file[kStoredSizeAt], &stored_size, sizeof stored_size);
    std::string summed = file.substr(0, kSumAt) + file.substr(kHeaderSize);
    const std::uint64_t sum = XXH3_64bits(summed.data(), summed.size());
    std::memcpy(&file[kSumAt], &sum, sizeof sum);
  }
  try {
    const cache::Content content = cache::unpack(file);
    require(cache::unpack(cache::pack(content.label, content.payload)).payload == content.payload,
            "what was unpacked can be packed");
  } catch (const std::runtime_error&) {
  }
}

void read_surfaces(Bytes bytes) {
  try {
    const cache::Surfaces surfaces = cache::decode_surfaces(text_of(bytes));
    require(cache::encode_surfaces(surfaces) == text_of(bytes), "what was read is what was written");
  } catch (const std::runtime_error&) {
  }
}

void read_frame(Bytes bytes) {
  static const cache::Surfaces kSurfaces = cache::surfaces_of(*cache::Sample().snapshot(0));
  try {
    const cache::CachedFrame read = cache::decode_frame(text_of(bytes), 1, kSurfaces);
    const std::string written = cache::encode_frame(*read.snapshot, read.report, kSurfaces);
    require(
        cache::encode_frame(*cache::decode_frame(written, 1, kSurfaces).snapshot, read.report, kSurfaces) == written,
        "what was read can be written");
  } catch (const std::runtime_error&) {
  }
}

void read_manifest(Bytes bytes) {
  std::string written;
  try {
    written = cache::manifest_text(cache::parse_manifest(text_of(bytes)));
  } catch (const std::runtime_error&) {
    return;
  }
  require(cache::manifest_text(cache::parse_manifest(written)) == written, "what was read can be written");
}

constexpr std::array kTargets{Target{"scene", read_scene},
                              Target{"pattern", read_pattern},
                              Target{"specification", read_specification},
                              Target{"toml", read_toml},
                              Target{"json", read_json},
                              Target{"statistics", read_statistics},
                              Target{"list", read_list},
                              Target{"limits", read_limits},
                              Target{"svg", read_svg},
                              Target{"outline", read_outline},
                              Target{"image", read_image},
                              Target{"picture", read_picture},
                              Target{"layers", read_layers},
                              Target{"character", read_answer<assets::character_from_bytes>},
                              Target{"mesh", read_answer<assets::from_bytes>},
                              Target{"container", read_container},
                              Target{"surfaces", read_surfaces},
                              Target{"frame", read_frame},
                              Target{"manifest", read_manifest}};

}  // namespace

std::span<const Target> targets() {
  return kTargets;
}

}  // namespace weft::fuzz
