# Loads what lies beside this file: meshes that move, their colours, cameras, lights, frame rate and picture size.
#
#   blender -P FILE.py                      opens it
#   blender -b -P FILE.py -- FILE.blend     saves it
import json
import math
import os
import sys

import bpy
from mathutils import Matrix, Vector

FILM = json.loads(FILM_TEXT)
FOLDER = os.path.dirname(os.path.abspath(__file__))


def world_from_scene():
    """z is up in Blender."""
    return Matrix.Identity(4) if FILM["z_up"] else Matrix.Rotation(math.pi / 2, 4, "X")


def set_scene(scene):
    fps = max(1, math.ceil(FILM["fps"]))
    scene.render.fps, scene.render.fps_base = fps, fps / FILM["fps"]
    scene.frame_start, scene.frame_end = FILM["first"], FILM["last"]
    scene.render.resolution_x, scene.render.resolution_y = FILM["size"]
    scene.render.resolution_percentage = 100
    scene.unit_settings.system, scene.unit_settings.scale_length = "METRIC", 1
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new(FILM["name"])
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"].inputs
    background["Color"].default_value = FILM["sky"]["color"] + [1]
    background["Strength"].default_value = FILM["sky"]["strength"]


def link(item, collection):
    for other in item.users_collection:
        other.objects.unlink(item)
    collection.objects.link(item)


def add_mesh(name, visible, collection):
    bpy.ops.object.select_all(action="DESELECT")
    bpy.ops.wm.obj_import(filepath=os.path.join(FOLDER, name + ".obj"))
    mesh = bpy.context.selected_objects[0]
    mesh.name = name
    mesh.hide_render = not visible
    mesh.hide_set(not visible)
    motion = mesh.modifiers.new("Weft", "MESH_CACHE")
    motion.cache_format = "PC2"
    motion.filepath = os.path.join(FOLDER, name + ".pc2")
    motion.frame_start = FILM["first"]
    link(mesh, collection)


def animate(item, path, index, frames, values):
    """One value for each frame, straight lines between; none where all are the same."""
    if all(value == values[0] for value in values):
        return
    if not item.animation_data:
        item.animation_data_create()
    if not item.animation_data.action:
        item.animation_data.action = bpy.data.actions.new(item.name)
    curve = item.animation_data.action.fcurves.new(path, index=index)
    curve.keyframe_points.add(len(frames))
    for point, frame, value in zip(curve.keyframe_points, frames, values):
        point.co = (frame, value)
        point.interpolation = "LINEAR"
    curve.update()


def add_camera(film_camera, collection):
    lens = bpy.data.cameras.new(film_camera["name"])
    camera = bpy.data.objects.new(film_camera["name"], lens)
    collection.objects.link(camera)
    camera.rotation_mode = "QUATERNION"
    lens.sensor_fit, lens.clip_start = "VERTICAL", 0.01
    lengths, places, turns = [], [], []
    for angle, *rows in film_camera["frames"]:
        place, turn, _ = (world_from_scene() @ Matrix(rows + [[0, 0, 0, 1]])).decompose()
        if turns and turn.dot(turns[-1]) < 0:
            turn.negate()
        lengths.append(lens.sensor_height / 2 / math.tan(math.radians(angle) / 2))
        places.append(place)
        turns.append(turn)
    lens.lens, camera.location, camera.rotation_quaternion = lengths[0], places[0], turns[0]
    animate(lens, "lens", 0, FILM["frames"], lengths)
    for axis in range(3):
        animate(camera, "location", axis, FILM["frames"], [place[axis] for place in places])
    for part in range(4):
        animate(camera, "rotation_quaternion", part, FILM["frames"], [turn[part] for turn in turns])
    return camera


def add_light(film_light, collection):
    """As bright as there: a white matte surface that faces it comes out white at a strength of 1."""
    sun = film_light["kind"] == "sun"
    light = bpy.data.lights.new(film_light["name"], "SUN" if sun else "SPOT")
    lamp = bpy.data.objects.new(film_light["name"], light)
    collection.objects.link(lamp)
    position, direction = Vector(film_light["position"]), Vector(film_light["direction"])
    light.color = film_light["color"]
    if sun:
        light.energy = math.pi * film_light["strength"]
        light.angle = math.radians(film_light["softness"])
    else:
        light.energy = 4 * math.pi**2 * direction.length_squared * film_light["strength"]
        light.spot_size = math.radians(film_light["cone_angle"])
        light.shadow_soft_size = direction.length * math.tan(math.radians(film_light["softness"]) / 2)
    lamp.matrix_world = world_from_scene() @ (
        Matrix.Translation(position) @ direction.to_track_quat("-Z", "Y").to_matrix().to_4x4())


def main():
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for name in ("Cube", "Camera", "Light"):  # of a new file
        if name in bpy.data.objects:
            bpy.data.objects.remove(bpy.data.objects[name])
    scene = bpy.context.scene
    collection = bpy.data.collections.new(FILM["name"])
    scene.collection.children.link(collection)
    set_scene(scene)
    for film_object in FILM["objects"]:
        add_mesh(film_object["name"], film_object["visible"], collection)
    for film_light in FILM["lights"]:
        add_light(film_light, collection)
    cameras = [add_camera(film_camera, collection) for film_camera in FILM["cameras"]]
    if cameras:
        scene.camera = cameras[0]
    scene.frame_set(FILM["first"])
    if "--" in sys.argv and len(sys.argv) > sys.argv.index("--") + 1:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(sys.argv[sys.argv.index("--") + 1]))


main()
