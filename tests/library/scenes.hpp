// Small scenes for the public interface.
#pragma once

#include <string>

namespace weft::library {

/// A sheet falls on a ball.
inline const std::string kDrape = R"(
[time]
duration = 0.4
fps = 25

[[cloth]]
name = "sheet"
size = [0.5, 0.5]
particles = [16, 16]
position = [0, 0, 0.25]

[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.15
segments = 16
)";

/// A sheet is pinned to a handle, and nothing else touches it.
inline const std::string kHanging = R"(
[time]
duration = 0.4
fps = 25

[[cloth]]
name = "sheet"
size = [0.5, 0.5]
particles = [11, 11]
position = [0, 0, 0.75]
rotation = [90, 0, 0]

[[cloth.pin]]
low = [0, 1]
high = [1, 1]
follow = "handle"

[[obstacle]]
name = "handle"
shape = "sphere"
radius = 0.01
segments = 8
position = [0, 0, 1]
collide = false
)";

}  // namespace weft::library
