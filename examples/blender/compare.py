#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares limn's maps with what Blender makes of the same control mesh.

    python3.11 -m venv venv && venv/bin/pip install bpy
    venv/bin/python examples/blender/compare.py --limn build/release/limn scenes/spot/spot.obj

Normals and positions: both programs bake the mesh, texel against texel. Displacement: limn bakes the
way to the denoised mesh, Blender's Displace modifier goes it, and the points are compared with those
that Blender's own subdivision of the denoised mesh has. Exit status 1 where a median is beyond its
bound. What the settings mean: docs/renderers.md.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import bpy
import numpy

# Blender's names of limn's rules for texture coordinates (--fvar).
UV_RULES = {
    "NONE": "all",
    "PRESERVE_CORNERS": "corners-only",
    "PRESERVE_CORNERS_AND_JUNCTIONS": "corners-plus1",
    "PRESERVE_CORNERS_JUNCTIONS_AND_CONCAVE": "corners-plus2",
    "PRESERVE_BOUNDARIES": "boundaries",
    "SMOOTH_ALL": "none",
}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", help="OBJ of one object, with texture coordinates in one tile")
    parser.add_argument("--limn", default="limn", help="the program (default: limn)")
    parser.add_argument("--size", type=int, default=1024, help="texels (default 1024)")
    parser.add_argument("--level", type=int, default=6, help="Blender's subdivision (default 6)")
    parser.add_argument("--uv-smooth", choices=UV_RULES, default="PRESERVE_CORNERS_AND_JUNCTIONS",
                        help="Blender's rule for texture coordinates (default: what limn's is)")
    parser.add_argument("--fvar", choices=UV_RULES.values(),
                        help="limn's rule (default: the same as Blender's)")
    parser.add_argument("--keep", metavar="FOLDER", help="keep the files of both programs there")
    arguments = parser.parse_args()
    arguments.fvar = arguments.fvar or UV_RULES[arguments.uv_smooth]
    return arguments


def run_limn(arguments, *words):
    command = [arguments.limn, *words, "--fvar", arguments.fvar, "--quiet"]
    subprocess.run([str(word) for word in command], check=True)


def load_subdivided(mesh, level, uv_smooth):
    """The mesh alone in a new scene, in the axes of its file, with Blender's limit points."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.obj_import(filepath=str(mesh))
    model = next(o for o in bpy.context.scene.objects if o.type == "MESH")
    model.rotation_euler = (0, 0, 0)  # the importer stands y upright
    for face in model.data.polygons:
        face.use_smooth = True
    modifier = model.modifiers.new("limit", "SUBSURF")
    modifier.levels = modifier.render_levels = level
    modifier.quality = 5
    modifier.use_limit_surface = True
    modifier.boundary_smooth = "PRESERVE_CORNERS"  # limn's edge-and-corner
    modifier.uv_smooth = uv_smooth
    return model


def read_rows(image):
    """Values of an image as [row][column][4], rows from the top."""
    values = numpy.empty(len(image.pixels), numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], 4)[::-1]


def load_image(path):
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    return image


def prepare_bake(model, size):
    """An image that Cycles bakes the model into, one sample a texel, without a margin."""
    image = bpy.data.images.new("bake", size, size, alpha=True, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    material = bpy.data.materials.new("bake")
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    model.data.materials.clear()
    model.data.materials.append(material)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    bpy.context.view_layer.objects.active = model
    model.select_set(True)
    return image


def bake_with_blender(mesh, arguments):
    """Normals and positions, [row][column][3] each."""
    model = load_subdivided(mesh, arguments.level, arguments.uv_smooth)
    image = prepare_bake(model, arguments.size)
    bpy.ops.object.bake(type="NORMAL", normal_space="OBJECT", margin=0, use_clear=True)
    normals = 2 * read_rows(image)[..., :3] - 1
    bpy.ops.object.bake(type="POSITION", margin=0, use_clear=True)
    return normals, read_rows(image)[..., :3].copy()


def bake_with_limn(mesh, arguments, folder):
    run_limn(arguments, "bake", mesh, "-o", folder / "{map}.exr", "--maps", "normal,position",
             "--size", arguments.size, "--padding", 0)
    return [read_rows(load_image(folder / f"{name}.exr"))[..., :3] for name in ("normal", "position")]


def lengths(vectors):
    return numpy.linalg.norm(vectors, axis=-1)


def report(what, distances, scale):
    median, high = numpy.percentile(distances, [50, 99])
    print(f"{what}: median {median:.2g}, 99th percentile {high:.2g}, of {scale:.3g}", flush=True)
    return median / scale


def compare_bakes(mesh, arguments, folder):
    """The medians of both maps' differences, over their size."""
    theirs = bake_with_blender(mesh, arguments)
    ours = bake_with_limn(mesh, arguments, folder)
    # Where nothing is baked limn's normals have no length, and Blender's are (-1, -1, -1).
    is_baked = (lengths(ours[0]) > 0.5) & (numpy.abs(lengths(theirs[0]) - 1) < 0.1)
    print(f"texels that both bake: {is_baked.sum()}, limn alone: "
          f"{((lengths(ours[0]) > 0.5) & ~is_baked).sum()}")
    extent = numpy.ptp(ours[1][is_baked], axis=0).max()
    return (report("normals", lengths(ours[0] - theirs[0])[is_baked], 1.0),
            report("positions", lengths(ours[1] - theirs[1])[is_baked], extent))


def evaluate_points(model):
    evaluated = model.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    points = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get("co", points)
    evaluated.to_mesh_clear()
    return points.reshape(-1, 3)


def displace(model, path, is_vector):
    texture = bpy.data.textures.new("displacement", "IMAGE")
    texture.image = load_image(path)
    texture.extension = "EXTEND"
    texture.use_clamp = False
    modifier = model.modifiers.new("displacement", "DISPLACE")
    modifier.texture = texture
    modifier.texture_coords = "UV"
    modifier.mid_level = 0
    modifier.strength = 1
    modifier.direction = "RGB_TO_XYZ" if is_vector else "NORMAL"


def compare_displacement(mesh, arguments, folder):
    """The median of what the vector leaves of the way, over its median length."""
    level = min(arguments.level, 4)  # Blender looks the map up once a vertex
    target = folder / "denoised.obj"
    run_limn(arguments, "denoise", mesh, "-o", target, "--detail", 1, "--steps", 6)
    wanted = evaluate_points(load_subdivided(target, level, arguments.uv_smooth))
    way = numpy.median(lengths(
        evaluate_points(load_subdivided(mesh, level, arguments.uv_smooth)) - wanted))
    for kind, flags in (("along the normal", []), ("vector", ["--vector"])):
        path = folder / f"displacement_{'vector' if flags else 'scalar'}.exr"
        run_limn(arguments, "bake", mesh, "-o", path, "--maps", "displacement", "--against",
                 target, "--size", arguments.size, *flags)
        model = load_subdivided(mesh, level, arguments.uv_smooth)
        displace(model, path, is_vector=bool(flags))
        left = report(f"displacement {kind}, what is left",
                      lengths(evaluate_points(model) - wanted), way)
    return left


def main():
    arguments = parse_arguments()
    mesh = pathlib.Path(arguments.mesh).resolve()
    print(f"Blender {bpy.app.version_string}, {mesh.name}, {arguments.size} x {arguments.size}, "
          f"{arguments.uv_smooth}, limn's {arguments.fvar}")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(arguments.keep or scratch)
        normals, positions = compare_bakes(mesh, arguments, folder)
        displacement = compare_displacement(mesh, arguments, folder)
    is_close = normals < 1e-3 and positions < 1e-4 and displacement < 0.02
    print("within bounds" if is_close else "beyond bounds")
    return 0 if is_close else 1


if __name__ == "__main__":
    sys.exit(main())
