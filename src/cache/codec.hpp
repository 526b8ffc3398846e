// What a frame cache holds, as payloads of its files. A list is its length (u64), then its entries; a text is a list of
// bytes; enumerations and truth values take a byte; all numbers are little endian, f64 where nothing else is said.
//
//   surfaces  up, sky colour, ground colour, sky intensity, heat quantity, largest heat;
//             list of surfaces: name, kind, visible, infinite floor, triangles (list of 3 × i32), quads (list of
//             4 × i32), uv (list of 2 × f64), crease angle, colour, back colour, roughness, thread spacing, checker;
//             for each surface the positions in frame 0 (count u64, then planes)
//   frame     time; cameras (list of name, position, target, field of view); lights (list of name, kind, direction,
//             position, target, cone angle, colour, intensity, softness); the report (see serialize(FrameReport) in
//             codec.cpp); for each surface a byte: 0 as in frame 0, 1 positions follow (planes);
//             and a byte: 0 no heat, 1 heat follows (planes of f32)
//   state     the solver's own bytes
//
// Planes: the first byte of every entry, then the second byte of every entry, and so on (24 planes for positions of
// 3 × f64, 4 for heat). Signs and exponents of neighbours are alike: this is what makes them shrink.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "frame/frame_report.hpp"
#include "frame/frame_snapshot.hpp"

namespace weft::cache {

/// The part that all frames share, and where everything is in frame 0.
struct Surfaces {
  std::shared_ptr<const frame::Stage> stage;
  std::vector<std::shared_ptr<const frame::Surface>> surfaces;
  std::vector<std::vector<Vec3>> positions;  ///< [m], one list per surface
};

struct CachedFrame {
  frame::SnapshotPtr snapshot;
  frame::FrameReport report;
  std::uint64_t scene_hash = 0;  ///< of the scene whose looks it has
};

Surfaces surfaces_of(const frame::FrameSnapshot& first);
std::string encode_surfaces(const Surfaces& surfaces);

/// Throws std::runtime_error, which says what is wrong.
Surfaces decode_surfaces(std::string_view payload);

/// The snapshot has the surfaces of `surfaces`.
std::string encode_frame(const frame::FrameSnapshot& snapshot, const frame::FrameReport& report,
                         const Surfaces& surfaces);

/// Throws std::runtime_error, which says what is wrong.
CachedFrame decode_frame(std::string_view payload, int frame, const Surfaces& surfaces);

}  // namespace weft::cache
