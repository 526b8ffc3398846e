#include "lab/bench/accuracy.hpp"

namespace weft::bench {

// A copy of scenes/swinging_sheet.toml; a test compares them.
const char* const kSwingingSheet =
    R"(# A soft sheet, held at both ends of its upper edge, swings down from a slant, and nothing can touch: how exact the run is depends on
# the time integration alone.
title = "Swinging sheet"

[time]
duration = 1.0
fps = 25
step = 0.01

[contact]
self = false
obstacles = false

[[cloth]]
name = "sheet"
size = 1.0
particles = 21             # 441
position = [0, -0.35, 1.35]
rotation = [45, 0, 0]
look = { color = "#6a9dbb", back_color = "#c9b48c" }

# Smooth forces: waves that steps of a few milliseconds follow and viscosity takes away, too stiff to buckle in folds
# that tell one method from another, no dry friction of bending.
[cloth.material]
density = 0.2
stretch = 200
max_stretch = 0
shear = 60
bend = 1e-3
stretch_viscosity = 0.2
shear_viscosity = 0.1
bend_friction = 0

[[cloth.pin]]
low = [0, 1]
high = [0.2, 1]

[[cloth.pin]]
low = [0.8, 1]
high = [1, 1]
)";

}  // namespace weft::bench
