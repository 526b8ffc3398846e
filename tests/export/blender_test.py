"""Blender runs the script of `weft export --format blender` and shows every frame where the PLY files say.

blender_test.py WEFT    ends with 77 where Blender is not installed. Run inside Blender, it measures instead.
"""
import os
import shutil
import struct
import subprocess
import sys
import tempfile

LIMIT = 1e-6  # metres; point caches are in single precision

SCENE = """
up = "{up}"
[time]
duration = 0.4
fps = 25
step = 0.02
[render]
width = 320
height = 180
[[cloth]]
name = "cloth"
size = [0.5, 0.5]
particles = [9, 9]
position = [0, 0, 0]
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.1
segments = 8
position = [0, -0.3, -0.3]
[[camera]]
name = "side"
position = [0.5, -4, 1.5]
target = [0, 0, 0.25]
field_of_view = 40
"""


def positions(ply):
    with open(ply, "rb") as file:
        content = file.read()
    end = content.index(b"end_header\n") + 11
    lines = content[:end].decode().splitlines()
    count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    return list(struct.iter_unpack("<3d", content[end:end + 24 * count]))


def measure(folder, up):
    import bpy
    from mathutils import Vector

    def turned(x):
        return Vector(x) if up == "z" else Vector((x[0], -x[2], x[1]))

    scene = bpy.context.scene
    assert (scene.render.fps, scene.frame_start, scene.frame_end) == (25, 2, 10), "frames"
    assert (scene.render.resolution_x, scene.render.resolution_y) == (320, 180), "size"
    worst = 0
    for frame in range(2, 11, 2):
        scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        for name in ("cloth", "ball"):
            shown = bpy.data.objects[name].evaluated_get(graph)
            expected = positions(os.path.join(folder, f"{name}_{frame:05}.ply"))
            mesh = shown.to_mesh()
            assert len(mesh.vertices) == len(expected), name
            for vertex, place in zip(mesh.vertices, expected):
                worst = max(worst, (shown.matrix_world @ vertex.co - turned(place)).length)
    camera = scene.camera.matrix_world
    worst = max(worst, (camera.translation - turned((0.5, -4, 1.5))).length)
    aim = (turned((0, 0, 0.25)) - camera.translation).normalized()
    worst = max(worst, (camera.to_3x3() @ Vector((0, 0, -1)) - aim).length)
    assert abs(scene.camera.data.angle_y - 0.6981317) < 1e-6, "field of view"
    print(f"farthest from its place: {worst:.3g} m")
    assert worst < LIMIT


def main(weft):
    blender = shutil.which("blender")
    if not blender:
        print("Blender is not installed: apt-get install blender")
        return 77
    for up in ("z", "y"):
        with tempfile.TemporaryDirectory() as folder:
            def run(*command):
                subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)

            with open(os.path.join(folder, "s.toml"), "w", encoding="utf-8") as file:
                file.write(SCENE.format(up=up))
            run(weft, "simulate", "s.toml", "--cache", "c", "--progress", "none")
            run(weft, "export", "c", "--format", "ply", "-o", "ply")
            run(weft, "export", "c", "--format", "blender", "-o", "b", "--frames", "2:11:2")
            subprocess.run([blender, "-b", "--factory-startup", "--python-exit-code", "1", "-P",
                            os.path.join(folder, "b/s.py"), "-P", os.path.abspath(__file__), "--",
                            os.path.join(folder, "film.blend"), os.path.join(folder, "ply"), up], check=True)
    return 0


if "--" in sys.argv:
    measure(*sys.argv[-2:])
elif __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1])))
