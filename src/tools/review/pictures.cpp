#include "tools/review/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "film/image/png.hpp"
#include "film/image/shrink.hpp"
#include "film/video/decoder.hpp"
#include "tools/compare/files.hpp"

namespace weft::review {
namespace {

constexpr std::size_t kMaxTiles = 16;
constexpr int kTileWidth = 320;  // [pixels]; over twice the width on the page
constexpr int kHeatWidth = 640;  // maximum width of a FLIP map [pixels]

// Reads pictures one after the other, from a video or from files.
class Reader {
 public:
  explicit Reader(const RunFiles& run) : run_(run) {
    if (!run.video.empty()) decoder_.emplace(run.video);
  }

  std::optional<image::Image> next() {
    const auto at = static_cast<std::size_t>(next_++);
    if (decoder_) return decoder_->next();
    if (at >= run_.pictures.size()) return std::nullopt;
    return image::read_png(run_.pictures[at]);
  }

  /// The picture with this index; nullopt if there is none. Each index must be larger than that of the call before.
  std::optional<image::Image> skip_to(long long picture) {
    if (!decoder_) next_ = picture;
    while (next_ < picture) {
      if (!next()) return std::nullopt;
    }
    return next();
  }

  double fps() const { return decoder_ ? decoder_->fps() : 0; }

 private:
  const RunFiles& run_;
  std::optional<video::Decoder> decoder_;
  long long next_ = 0;
};

// Shrinks a plane to at most `width` pixels across. Each new value is the largest value of a square
// of pixels, so that a thin line keeps its brightness.
compare::Plane<float> shrink_to_largest(const compare::Plane<float>& plane, int width) {
  const int side = (plane.width + width - 1) / width;
  compare::Plane<float> small((plane.width + side - 1) / side, (plane.height + side - 1) / side);
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      float& value = small.row(y / side)[x / side];
      value = std::max(value, plane.row(y)[x]);
    }
  }
  return small;
}

}  // namespace

PictureSummary read_pictures(const RunFiles& run) {
  PictureSummary found;
  Reader reader(run);
  found.fps = reader.fps();
  // Keeps every stride-th picture. Doubles the stride when there are kMaxTiles tiles, since the number of pictures is
  // not known in advance.
  long long stride = 1;
  while (const std::optional<image::Image> image = reader.next()) {
    if (found.count == 0) {
      found.width = image->width;
      found.height = image->height;
    }
    if (found.count % stride == 0) found.tiles.push_back({found.count, image::shrink(*image, kTileWidth)});
    if (found.tiles.size() == kMaxTiles) {
      stride *= 2;
      std::erase_if(found.tiles, [stride](const Tile& tile) { return tile.picture % stride != 0; });
    }
    ++found.count;
  }
  return found;
}

long long index_at_same_time(long long k, const PictureTimes& from, const PictureTimes& to) {
  if (!from.frames.empty()) k = (from.frames[static_cast<std::size_t>(k)] - from.first) / from.step;
  if (from.fps > 0 && to.fps > 0) {
    const auto step = static_cast<double>(from.step), other_step = static_cast<double>(to.step);
    const double time = (static_cast<double>(from.first) / step + static_cast<double>(k)) / from.fps;
    k = std::llround(time * to.fps - static_cast<double>(to.first) / other_step);
  }
  if (to.frames.empty()) return k;
  const auto found = std::ranges::find(to.frames, to.first + k * to.step);
  return found == to.frames.end() ? -1 : found - to.frames.begin();
}

std::vector<PairComparison> compare_with_reference(const RunFiles& run, const PictureTimes& times,
                                                   const RunFiles& reference, const PictureTimes& reference_times,
                                                   const std::vector<long long>& at) {
  const compare::Limits limits = compare::limits_for({}, reference.video, run.video);
  std::vector<PairComparison> pairs;
  Reader ours(run), theirs(reference);
  long long last = -1;
  for (const long long picture : at) {
    const long long other = index_at_same_time(picture, times, reference_times);
    if (other <= last) continue;  // `other` is before the start of the reference, or already compared
    last = other;
    const std::optional<image::Image> b = theirs.skip_to(other), a = b ? ours.skip_to(picture) : std::nullopt;
    if (!a) break;
    if (a->width != b->width || a->height != b->height) {
      throw Error(ExitCode::asset_unreadable, "the pictures have {}x{} pixels, those of the reference {}x{}", a->width,
                  a->height, b->width, b->height);
    }
    const compare::Comparison found = compare::compare(*b, *a, limits.pixel_tolerance);
    PairComparison pair{picture, other, found.figures, compare::verdict(found.figures, limits), {}};
    if (pair.verdict != compare::Verdict::same)
      pair.heat = compare::heat_map(shrink_to_largest(found.flip, kHeatWidth));
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace weft::review
