#include "lab/bench/speed.hpp"

namespace weft::bench {

// A copy of scenes/sphere_drape.toml; a test compares them.
const char* const kSphereDrape =
    R"(# A sheet of canvas, 1 m x 1 m, falls flat on a sphere and drapes over it and the floor: the scene by which speed is
# compared with other programs. Its resolution is a parameter; 16 mm from particle to particle become 8 mm with
#
#     ./weft run scenes/sphere_drape.toml --set 'cloth.sheet.particles=[128,128]'
title = "Sphere drape"

[time]
duration = 3.0
fps = 25
step = 0.01

[[cloth]]
name = "sheet"
size = [1.0, 1.0]
particles = [64, 64]           # 4,096
position = [0.003, 0.002, 0.45]  # off the middle, so that no symmetry holds folds up
material = { fabric = "canvas", friction = 0.3 }

[cloth.look]
color = "#6a9bb6"
back_color = "#d8c9a4"

[[obstacle]]
name = "sphere"
shape = "sphere"
radius = 0.2
position = [0, 0, 0.205]
friction = 0.3
look = { color = [0.88, 0.52, 0.20], roughness = 0.3 }

[[obstacle]]
name = "floor"
shape = "plane"
friction = 0.3
look = { color = "#a8a39b", roughness = 0.8 }

[[camera]]
name = "front"
position = [1.3, -1.2, 0.85]
target = [0, 0, 0.16]
field_of_view = 26

[[light]]
name = "key"
direction = [0.5, 0.75, -0.7]
intensity = 1.0
softness = 5
)";

}  // namespace weft::bench
