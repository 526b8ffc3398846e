// Payloads of the files of a frame cache. A list is stored as its length (u64), then its entries; a text is a list of
// bytes; enumerations and booleans take one byte. All numbers are little endian. Integers have the size of their C++
// type; other numbers are f64 unless noted otherwise.
//
//   surfaces  the stage (surroundings); list of textures; list of surfaces; for each surface the positions in frame 0
//             (count u64, then byte planes, see below)
//   frame     time; list of cameras; list of lights; the report; for each surface a byte, 0 if its positions are those
//             of frame 0, else 1, followed by the positions (byte planes); then a byte, 0 if the surface has no values
//             of the heat map, else 1, followed by these values (byte planes of f32)
//   state     bytes of Simulation::save
//
// The serialize() functions in codec.cpp define the members of each part and their order. An optional value is stored
// as a byte, 0 or 1, followed by the value if the byte is 1.
//
// Byte planes: the first byte of every entry, then the second byte of every entry, and so on (24 planes for positions
// of 3 × f64, 4 for the heat map). Neighbours have similar signs and exponents, so that planes compress well.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "physics/simulation/frame_report.hpp"

namespace weft::cache {

/// Data that all frames share, and the positions in frame 0.
struct Surfaces {
  std::shared_ptr<const frame::Stage> stage;
  std::vector<std::shared_ptr<const frame::Surface>> surfaces;
  std::vector<std::vector<Vec3>> positions;  ///< [m], one list per surface
};

struct CachedFrame {
  frame::SnapshotPtr snapshot;
  simulation::FrameReport report;
  std::uint64_t scene_hash = 0;  ///< hash of the scene for which the frame was written; set by Reader
};

/// The shared data of a run, from its frame 0.
Surfaces surfaces_of(const frame::FrameSnapshot& first);
std::string encode_surfaces(const Surfaces& surfaces);

/// Throws std::runtime_error that describes the defect.
Surfaces decode_surfaces(std::string_view payload);

/// `surfaces`: of frame 0 of the same run. Throws std::logic_error if a surface of the snapshot has another number of
/// vertices than in `surfaces`.
std::string encode_frame(const frame::FrameSnapshot& snapshot, const simulation::FrameReport& report,
                         const Surfaces& surfaces);

/// `frame`: number of the frame. Throws std::runtime_error that describes the defect.
CachedFrame decode_frame(std::string_view payload, int frame, const Surfaces& surfaces);

}  // namespace weft::cache
