// Point caches in PC2 format (3ds Max, Maya, Blender): positions of a fixed set of points over time. Little endian:
//
//   offset  size  content
//        0    12  "POINTCACHE2" and a zero
//       12     4  i32 version, 1
//       16     4  i32 points
//       20     4  f32 frame of the first sample
//       24     4  f32 frames between samples, 1
//       28     4  i32 samples
//       32     -  per sample, per point: three f32
#pragma once

#include <filesystem>
#include <fstream>
#include <vector>

#include "core/temporary_file.hpp"
#include "core/types.hpp"

namespace weft::exporter {

/// Blender's modifier ignores the field "frames between samples". So the file has a sample for
/// every frame of the scene from the first to the last added frame. Samples between two added
/// frames are interpolated linearly.
class PointCache {
 public:
  /// `given`: number of frames that will be added, `step` apart. All functions throw Error(output_failed).
  PointCache(const std::filesystem::path& file, std::size_t points, int first_frame, int step, std::size_t given);

  void add(const std::vector<Vec3>& positions);
  /// Gives the file its final name; call it after the last frame.
  void commit();

 private:
  void put(const void* data, std::size_t size);
  void put(const std::vector<Vec3>& positions);

  std::filesystem::path name_;
  TemporaryFile file_;
  std::ofstream out_;
  int step_;
  std::vector<Vec3> before_;  // positions of the last added frame
};

}  // namespace weft::exporter
