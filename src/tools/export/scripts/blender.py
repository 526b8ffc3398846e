# Loads the meshes, motions and pictures beside this file, and sets the colours, cameras, lights, frame rate and picture
# size that this file contains.
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
    """Transform of the scene to Blender's axes, where z is up."""
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


def add_pictures(mesh, pictures):
    """Adds texture coordinates for the pictures, since a mapping may rotate and scale a picture."""
    if not pictures:
        return
    pattern = mesh.uv_layers.active
    layer = mesh.uv_layers.new(name="picture")
    slots = [pictures.get(material.name.split(".")[0]) if material else None for material in mesh.materials]
    for face in mesh.polygons:
        picture = slots[face.material_index]
        for corner in face.loop_indices if picture else ():
            u, v = pattern.data[corner].uv
            layer.data[corner].uv = [row[0] * u + row[1] * v + row[2] for row in (picture["across"], picture["up"])]
    for material, picture in zip(mesh.materials, slots):
        if picture:
            add_picture_nodes(material, picture)


def add_picture_nodes(material, picture):
    nodes, links = material.node_tree.nodes, material.node_tree.links
    for node in [node for node in nodes if node.type in ("TEX_IMAGE", "MAPPING", "TEX_COORD", "UVMAP")]:
        nodes.remove(node)
    places, image = nodes.new("ShaderNodeUVMap"), nodes.new("ShaderNodeTexImage")
    places.uv_map = "picture"
    image.image = bpy.data.images.load(os.path.join(FOLDER, picture["file"]), check_existing=True)
    if picture["extension"] in image.bl_rna.properties["extension"].enum_items:  # Blender 3.4 has no MIRROR
        image.extension = picture["extension"]
    links.new(places.outputs["UV"], image.inputs["Vector"])
    surface = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    links.new(image.outputs["Color"], surface.inputs["Base Color"])
    if picture["cutout"]:
        links.new(image.outputs["Alpha"], surface.inputs["Alpha"])
        material.blend_method = "CLIP"


def color_backs(mesh, backs):
    for material in mesh.materials:
        back = backs.get(material.name.split(".")[0]) if material else None
        if not back:
            continue
        nodes, links = material.node_tree.nodes, material.node_tree.links
        front = next(node for node in nodes if node.type == "BSDF_PRINCIPLED").inputs["Base Color"]
        side, mix = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeMixRGB")
        mix.inputs["Color1"].default_value, mix.inputs["Color2"].default_value = front.default_value, back + [1]
        for link_to_front in front.links:
            links.new(link_to_front.from_socket, mix.inputs["Color1"])
        links.new(side.outputs["Backfacing"], mix.inputs["Fac"])
        links.new(mix.outputs["Color"], front)


def add_mesh(film_object, collection):
    name, visible = film_object["name"], film_object["visible"]
    bpy.ops.object.select_all(action="DESELECT")
    bpy.ops.wm.obj_import(filepath=os.path.join(FOLDER, name + ".obj"))
    mesh = bpy.context.selected_objects[0]
    mesh.name = name
    add_pictures(mesh.data, film_object["pictures"])
    color_backs(mesh.data, film_object["backs"])
    mesh.hide_render = not visible
    mesh.hide_set(not visible)
    motion = mesh.modifiers.new("Weft", "MESH_CACHE")
    motion.cache_format = "PC2"
    motion.filepath = os.path.join(FOLDER, name + ".pc2")
    motion.frame_start = FILM["first"]
    link(mesh, collection)


def animate(item, path, index, frames, values):
    """Adds an animation curve with one value per frame, linear between frames; none if all values are equal."""
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
    """Adds a light. At strength 1, a white matte surface that faces the light appears white, as in Weft's pictures."""
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
    for name in ("Cube", "Camera", "Light"):  # objects of a new Blender file
        if name in bpy.data.objects:
            bpy.data.objects.remove(bpy.data.objects[name])
    scene = bpy.context.scene
    collection = bpy.data.collections.new(FILM["name"])
    scene.collection.children.link(collection)
    set_scene(scene)
    for film_object in FILM["objects"]:
        add_mesh(film_object, collection)
    for film_light in FILM["lights"]:
        add_light(film_light, collection)
    cameras = [add_camera(film_camera, collection) for film_camera in FILM["cameras"]]
    if cameras:
        scene.camera = cameras[0]
    scene.frame_set(FILM["first"])
    if "--" in sys.argv and len(sys.argv) > sys.argv.index("--") + 1:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(sys.argv[sys.argv.index("--") + 1]))


main()
