#include "tools/export/pc2.hpp"

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include "core/error.hpp"

namespace weft::exporter {

// PC2 is little endian, and numbers are copied as they are in memory.
static_assert(std::endian::native == std::endian::little);

PointCache::PointCache(const std::filesystem::path& file, std::size_t points, int first_frame, int step,
                       std::size_t given)
    : name_(file), file_(file), out_(file_.path(), std::ios::binary), step_(step) {
  put("POINTCACHE2", 12);
  const std::int32_t version = 1, point_count = static_cast<std::int32_t>(points),
                     sample_count = static_cast<std::int32_t>((given - 1) * static_cast<std::size_t>(step) + 1);
  const float start = static_cast<float>(first_frame), rate = 1;
  put(&version, 4), put(&point_count, 4), put(&start, 4), put(&rate, 4), put(&sample_count, 4);
}

void PointCache::put(const void* data, std::size_t size) {
  out_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  if (!out_) throw Error(ExitCode::output_failed, "{}: cannot be written: {}", name_.string(), std::strerror(errno));
}

void PointCache::add(const std::vector<Vec3>& positions) {
  for (int k = 1; k < step_ && !before_.empty(); ++k) {
    const double fraction = static_cast<double>(k) / step_;
    std::vector<Vec3> between;
    between.reserve(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
      between.emplace_back(before_[i] + fraction * (positions[i] - before_[i]));
    put(between);
  }
  put(positions);
  before_ = positions;
}

void PointCache::put(const std::vector<Vec3>& positions) {
  std::vector<float> sample;
  sample.reserve(3 * positions.size());
  for (const Vec3& x : positions)
    for (int axis = 0; axis < 3; ++axis) sample.push_back(static_cast<float>(x[axis]));
  put(sample.data(), sample.size() * sizeof(float));
}

void PointCache::commit() {
  out_.close();
  if (!out_) throw Error(ExitCode::output_failed, "{}: cannot be written: {}", name_.string(), std::strerror(errno));
  file_.commit(Flush::no);
}

}  // namespace weft::exporter
