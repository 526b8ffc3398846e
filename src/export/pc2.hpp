// Point caches of the form PC2 (3ds Max, Maya, Blender): the same points again and again. Little endian:
//
//   offset  size  what
//        0    12  "POINTCACHE2" and a zero
//       12     4  i32 version, 1
//       16     4  i32 points
//       20     4  f32 frame of the first sample
//       24     4  f32 frames from sample to sample, 1
//       28     4  i32 samples
//       32     -  per sample, per point: three f32
#pragma once

#include <filesystem>
#include <fstream>
#include <vector>

#include "core/temporary_file.hpp"
#include "core/types.hpp"

namespace weft::exporter {

/// One sample for each frame, those between given ones on straight lines: Blender's modifier counts samples, whatever
/// the file says of the distance between them.
class PointCache {
 public:
  /// Of `given` frames, `step` apart. Throws Error(output_failed), as the others do.
  PointCache(const std::filesystem::path& file, std::size_t points, int first_frame, int step, std::size_t given);

  void add(const std::vector<Vec3>& positions);
  /// After the last sample: gives the file its name.
  void commit();

 private:
  void put(const void* data, std::size_t size);
  void put(const std::vector<Vec3>& positions);

  std::filesystem::path name_;
  TemporaryFile file_;
  std::ofstream out_;
  int step_;
  std::vector<Vec3> before_;  // the positions that were given last
};

}  // namespace weft::exporter
