"""Runs the script of `weft export --format blender` in Blender: every frame has the positions of the PLY files, and the
print has the place of the scene keys. The imported PLY, OBJ and glTF files give the same.

blender_test.py WEFT    exits with 77 if Blender is not installed. Inside Blender, this file does the measurements.
"""
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile

LIMIT = 1e-6  # metres, or widths of the picture; the files have single precision

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
look = {{ image = "{picture}", image_width = 0.2, image_rotation = {rotation}, image_offset = [0.1, 0.05] }}
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


ROTATION = 30  # degrees
PICTURE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scenes/gallery/pictures/flowers.png")


def vertices(ply):
    """x, y, z of each vertex and, for cloth, weft and warp."""
    with open(ply, "rb") as file:
        content = file.read()
    end = content.index(b"end_header\n") + 11
    lines = content[:end].decode().splitlines()
    count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    vertex = struct.Struct("<3d2f" if "property float s" in lines else "<3d")
    return list(vertex.iter_unpack(content[end:end + vertex.size * count]))


def picture_uv(uv):
    """Texture coordinates in the square picture as the keys define them: turned counter-clockwise about its corner."""
    angle = math.radians(ROTATION)
    x, y = uv[0] - 0.1, uv[1] - 0.05
    return ((math.cos(angle) * x + math.sin(angle) * y) / 0.2, (math.cos(angle) * y - math.sin(angle) * x) / 0.2)


def farthest(mesh, matrix, expected, turned, layers):
    """Largest error over the corners of all faces, of positions and of texture coordinates."""
    from mathutils import Vector
    worst = 0
    for loop in mesh.loops:
        place = matrix @ mesh.vertices[loop.vertex_index].co
        distance, nearest = min(((place - turned(x[:3])).length, i) for i, x in enumerate(expected))
        worst = max(worst, distance)
        for layer, meaning in layers.items():
            uv = mesh.uv_layers[layer].data[loop.index].uv
            worst = max(worst, (uv - Vector(meaning(expected[nearest][3:]))).length)
    return worst


def read_others(folder, turned):
    """Checks the other formats that Blender imports, in frame 2."""
    import bpy
    expected, metres = vertices(os.path.join(folder, "ply/cloth_00002.ply")), {"UVMap": lambda uv: uv}
    read = {"OBJ": (lambda: bpy.ops.wm.obj_import(filepath=os.path.join(folder, "b/cloth.obj")), turned, metres),
            "PLY": (lambda: bpy.ops.import_mesh.ply(filepath=os.path.join(folder, "ply/cloth_00002.ply")), Vector3,
                    metres)}
    try:
        import numpy
        numpy.bool = bool  # Debian's importer uses a removed alias
        read["glTF"] = (lambda: bpy.ops.import_scene.gltf(filepath=os.path.join(folder, "g/s.glb")), turned,
                        {"UVMap": metres["UVMap"], "UVMap.001": picture_uv})
    except ImportError:
        print("glTF is left out: apt-get install python3-numpy")
    for name, (load, axes, layers) in read.items():
        bpy.ops.wm.read_factory_settings(use_empty=True)
        load()
        cloth = next(each for each in bpy.data.objects if each.name.startswith("cloth"))
        worst = farthest(cloth.data, cloth.matrix_world, expected, axes, layers)
        print(f"{name}: farthest from its place {worst:.3g}")
        assert worst < LIMIT, name


def Vector3(x):
    from mathutils import Vector
    return Vector(x)


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
            expected = vertices(os.path.join(folder, f"ply/{name}_{frame:05}.ply"))
            mesh = shown.to_mesh()
            assert len(mesh.vertices) == len(expected), name
            for vertex, place in zip(mesh.vertices, expected):
                worst = max(worst, (shown.matrix_world @ vertex.co - turned(place[:3])).length)
            if name == "cloth":
                worst = max(worst, farthest(mesh, shown.matrix_world, expected, turned, {"picture": picture_uv}))
    camera = scene.camera.matrix_world
    worst = max(worst, (camera.translation - turned((0.5, -4, 1.5))).length)
    aim = (turned((0, 0, 0.25)) - camera.translation).normalized()
    worst = max(worst, (camera.to_3x3() @ Vector((0, 0, -1)) - aim).length)
    assert abs(scene.camera.data.angle_y - 0.6981317) < 1e-6, "field of view"
    image = next(node for node in bpy.data.materials["cloth"].node_tree.nodes if node.type == "TEX_IMAGE").image
    assert image.size[0] > 0 and image.filepath.endswith("cloth.png"), "picture"
    print(f"farthest from its place: {worst:.3g} m")
    assert worst < LIMIT
    read_others(folder, turned)


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
                file.write(SCENE.format(up=up, picture=PICTURE, rotation=ROTATION))
            run(weft, "simulate", "s.toml", "--cache", "c", "--progress", "none")
            run(weft, "export", "c", "--format", "ply", "-o", "ply")
            run(weft, "export", "c", "--format", "gltf", "-o", "g", "--frames", "2:3")
            run(weft, "export", "c", "--format", "blender", "-o", "b", "--frames", "2:11:2")
            subprocess.run([blender, "-b", "--factory-startup", "--python-exit-code", "1", "-P",
                            os.path.join(folder, "b/s.py"), "-P", os.path.abspath(__file__), "--",
                            os.path.join(folder, "film.blend"), folder, up], check=True,
                           env={**os.environ, "PATH": os.defpath})  # otherwise Blender uses the modules of the first python3
    return 0


if "--" in sys.argv:
    measure(*sys.argv[-2:])
elif __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1])))
