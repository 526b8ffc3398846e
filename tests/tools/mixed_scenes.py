#!/usr/bin/env python3
"""Runs random scenes that mix everything, and judges each frame.

Usage: mixed_scenes.py BUILD FIRST END [--folder DIR] [--limit SECONDS]

BUILD is a build folder with bin/weft and bin/weft_judge. Scene number k is the same in each run. The scenes from FIRST
to END - 1 are written to DIR (by default a temporary folder) and simulated with one thread. A scene has one to four
cloths of any fabric and mesh, of 2 cm to 20 m; up to three bodies, which stand or are moved by keys or forces; and
sometimes wind, gusts, pins with keys, springs and releases, weights, a rope and an attachment. Methods are mixed, with
steps of 2 to 40 ms or a tolerance. Prints a line per scene: exit code, CPU seconds, steps, rejected steps, Newton
iterations per step, maximum strain, error of the solver over error of the steps, intersecting pairs in all frames,
first warning. The last line sums up."""
import argparse
import json
import pathlib
import random
import re
import shutil
import subprocess
import tempfile

FABRICS = ("cotton poplin denim canvas linen jersey wool suiting felt silk satin chiffon polyester faille ripstop "
           "leather").split()


def vector(*numbers):
    return "[" + ", ".join(f"{number:.5g}" for number in numbers) + "]"


def one_turn(r, angles):
    """A rotation about one axis. (About several axes, keys may turn by less than half a turn only.)"""
    rotation = [0, 0, 0]
    rotation[r.randrange(3)] = r.choice(angles)
    return vector(*rotation)


def header(r, size, seed):
    method = r.choice(["implicit_euler"] * 4 + ["bdf2", "implicit_midpoint"])
    duration = 1.2 * size**0.5 if size < 1 else min(2.4, 1.2 * size**0.25)
    text = f'[time]\nduration = {duration:.4g}\nintegrator = "{method}"\n'
    steps = r.random()
    if steps < 0.15:
        text += f"tolerance = {r.choice([1e-4, 1e-3, 3e-3]) * size:.3g}\n"
    elif steps < 0.5:
        text += f"step = {r.choice([0.002, 0.005, 0.02, 0.04])}\n"
    text += "[physics]\n"
    if r.random() < 0.3:
        text += f"wind = {vector(r.uniform(-6, 6), r.uniform(-6, 6), r.uniform(-1, 1))}\n"
    if r.random() < 0.1:
        text += "air_density = 0\n"
    if r.random() < 0.15:
        text += f"gusts = {{ speed = {r.uniform(0.5, 5):.2g}, size = {size * r.uniform(0.3, 2):.2g}, seed = {seed} }}\n"
    return text


def body(r, size, name, center, bottom):
    """A body whose lowest point is above `bottom`. Returns its text and its highest point."""
    shape = r.choice(["sphere", "box", "cone", "torus", "cylinder", "half_pipe"])
    a = size * r.uniform(0.08, 0.3)
    text = f'[[obstacle]]\nname = "{name}"\nshape = "{shape}"\nfriction = {r.choice([0, 0.1, 0.3, 0.3, 0.6, 1, 3])}\n'
    text += {
        "sphere": f"radius = {a:.4g}\n",
        "box": f"size = {vector(2 * a * r.uniform(0.3, 1.5), 2 * a * r.uniform(0.3, 1.5), 2 * a)}\n",
        "cone": f"radius = {a:.4g}\nheight = {2 * a:.4g}\n",
        "torus": f"radius = {a:.4g}\ntube_radius = {a * r.uniform(0.2, 0.6):.4g}\n",
        "cylinder": f"radius = {a * r.uniform(0.2, 1):.4g}\nheight = {2 * a:.4g}\n",
        "half_pipe": f"radius = {a:.4g}\nlength = {3 * a:.4g}\nthickness = {0.1 * a:.4g}\n",
    }[shape]
    height, motion = bottom + a + 0.01 * size, r.random()
    place = (*center, height + 1.2 * a)
    if motion < 0.2 and shape != "half_pipe":
        text += f"position = {vector(*place)}\nmass = {r.choice([0.05, 0.5, 3]) * size**3:.4g}\n"
        if r.random() < 0.5:
            text += f"velocity = {vector(*(size**0.5 * r.uniform(-2, 2) for _ in range(3)))}\n"
        if r.random() < 0.3:
            text += f"spin = {vector(*(r.uniform(-720, 720) for _ in range(3)))}\n"
    elif motion < 0.45:
        there = [c + size * r.uniform(-0.4, 0.4) for c in center] + [place[2] + size * r.uniform(-0.05, 0.5)]
        text += (f'interpolation = "{r.choice(["linear", "cubic"])}"\n'
                 f"keys = [{{ time = 0, position = {vector(*place)}, rotation = [0, 0, 0] }}, "
                 f"{{ time = {r.uniform(0.4, 1.2):.3g}, position = {vector(*there)}, "
                 f"rotation = {one_turn(r, [0, 0, 90, 720, -360])} }}]\n")
    else:
        text += f"position = {vector(*place)}\n"
        if r.random() < 0.5:
            text += f"rotation = {vector(*(r.uniform(-90, 90) for _ in range(3)))}\n"
    return text, height + 3.4 * a


def cloth(r, size, name, height):
    shape = r.choice(["quads", "quads", "crossed_triangles", "aligned_triangles"])
    text = (f'[[cloth]]\nname = "{name}"\nshape = "{shape}"\n'
            f"size = {vector(size * r.uniform(0.3, 1.1), size * r.uniform(0.3, 1.1))}\n"
            f"particles = [{r.randint(9, 27)}, {r.randint(9, 27)}]\n"
            f"position = {vector(size * r.uniform(-0.15, 0.15), size * r.uniform(-0.15, 0.15), height)}\n"
            f"rotation = {vector(r.uniform(-12, 12), r.uniform(-12, 12), r.uniform(-90, 90))}\n")
    if r.random() < 0.2:
        text += f"velocity = {vector(*(size**0.5 * r.uniform(-3, high) for high in (3, 3, 1)))}\n"
    material = f'fabric = "{r.choice(FABRICS)}"'
    for key, chance, values in (("friction", 0.15, [0, 1, 5]), ("max_stretch", 0.1, [0, 0.02, 0.5]),
                                ("stretch", 0.1, [5, 1e5, 1e6]), ("bend", 0.1, [0, 1e-7, 1e-3]),
                                ("thickness", 0.1, [1e-4 * size, 5e-3 * size])):
        if r.random() < chance:
            material += f", {key} = {r.choice(values):g}"
    text += f"material = {{ {material} }}\n"
    if r.random() < 0.35:
        pin = r.choice(["low = [0, 0], high = [0, 0]", "low = [0, 1], high = [1, 1]", "low = [0, 0], high = [0, 1]",
                        "low = [0.4, 0.4], high = [0.6, 0.6]"])
        if r.random() < 0.3:
            pin += f", release = {r.uniform(0.1, 0.8):.3g}"
        if r.random() < 0.4:
            pin += (f", keys = [{{ time = 0, offset = [0, 0, 0] }}, {{ time = {r.uniform(0.3, 1):.3g}, "
                    f"offset = {vector(*(size * r.uniform(-0.6, 0.6) for _ in range(3)))}, "
                    f"rotation = {one_turn(r, [0, 180, -360])} }}]")
        if r.random() < 0.2:
            pin += f", strength = {r.choice([10, 1000])}"
        text += f"pin = [{{ {pin} }}]\n"
    if r.random() < 0.1:
        text += f"weight = [{{ low = [0, 0], high = [0.1, 0.1], mass = {0.1 * size * size:.3g} }}]\n"
    return text


def scene(number):
    """The text of a scene, and the names of its obstacles."""
    r = random.Random(number)
    size = r.choice([1] * 5 + [0.1, 0.3, 4, 20])
    text, bodies, top = header(r, size, number), [], 0
    count = r.choice([0, 1, 1, 1, 2, 3])
    for k in range(count):
        center = [0, 0] if count == 1 else [size * r.uniform(-0.5, 0.5) for _ in range(2)]
        more, top = body(r, size, f"body{k}", center, top)
        text += more
        bodies.append(f"body{k}")
    if r.random() < 0.7:
        text += (f'[[obstacle]]\nname = "floor"\nshape = "plane"\nsize = {20 * max(1, size):.3g}\n'
                 f"friction = {r.choice([0.1, 0.5, 1])}\n")
        bodies.append("floor")
    height, cloths = top + 0.25 * size, r.choice([1, 1, 1, 2, 3, 4])
    for k in range(cloths):
        text += cloth(r, size, f"cloth{k}", height + 0.35 * k * size)
    if r.random() < 0.2:
        high = height + (0.35 * cloths + 0.1) * size
        text += (f'[[rope]]\nname = "rope"\nfrom = {vector(-0.4 * size, 0, high)}\n'
                 f"to = {vector(0.4 * size, 0.1 * size, high)}\n"
                 f"length = {size * r.uniform(0.83, 1.2):.4g}\ndiameter = {r.choice([0.004, 0.01]) * size:g}\n"
                 f'material = "{r.choice(["cotton", "nylon", "steel"])}"\n')
        if r.random() < 0.5:
            text += "pin = [{ at = 0 }]\n"
    if r.random() < 0.15 and count > 0:
        text += ('[[attach]]\nname = "tie"\ncloth = "cloth0"\nto = "body0"\nlow = [0, 0]\nhigh = [0.05, 0.05]\n'
                 f"begin = {r.uniform(0.2, 0.8):.3g}\n")
        if r.random() < 0.4:
            text += f"breaking_load = {r.choice([0.1, 5])}\n"
    return text, bodies


def run(build, folder, number, limit):
    """Simulates a scene and counts its intersections. Returns its figures as a dictionary."""
    text, bodies = scene(number)
    path, meshes, cache = folder / f"{number}.toml", folder / "meshes", folder / "cache"
    statistics = folder / "statistics.json"
    path.write_text(text)
    for old in (meshes, cache):
        shutil.rmtree(old, ignore_errors=True)
    statistics.unlink(missing_ok=True)
    result = {"number": number, "cpu_s": limit, "pairs": 0, "warning": ""}
    try:
        program = subprocess.run([build / "bin/weft", "simulate", path, "--cache", cache, "--meshes", meshes, "--stats",
                                  statistics, "--threads", "1", "--progress", "none"],
                                 capture_output=True, text=True, timeout=limit)
        result["exit"] = program.returncode
        lines = [line for line in program.stderr.split("\n") if line.startswith(("warning", "weft:", str(path)))]
        result["warning"] = lines[0][:100] if lines else ""
    except subprocess.TimeoutExpired:
        result["exit"] = "limit"
    if statistics.exists():
        frames = json.loads(statistics.read_text())["frames"]
        keys = ("steps", "rejected_steps", "newton_iterations", "error_estimate_m", "solver_error_m", "simulate_cpu_ms")
        sums = {key: sum(frame.get(key) or 0 for frame in frames) for key in keys}
        result["cpu_s"] = sums["simulate_cpu_ms"] / 1e3
        result["steps"], result["rejected"] = sums["steps"], sums["rejected_steps"]
        result["iterations"] = sums["newton_iterations"] / max(sums["steps"], 1)
        result["strain"] = max(frame.get("max_strain") or 0 for frame in frames)
        result["solver"] = sums["solver_error_m"] / max(sums["error_estimate_m"], 1e-12)
    if meshes.is_dir() and any(meshes.iterdir()):
        names = [word for name in bodies for word in ("--obstacle", name)]
        judge = subprocess.run([build / "bin/weft_judge", meshes, *names], capture_output=True, text=True)
        found = re.search(r"(\d+) intersecting pairs", judge.stdout)
        result["pairs"] = int(found[1]) if found else -1
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("first", type=int)
    parser.add_argument("end", type=int)
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=90, help="seconds after which a scene is given up")
    options = parser.parse_args()
    folder = options.folder or pathlib.Path(tempfile.mkdtemp(prefix="mixed_scenes_"))
    folder.mkdir(parents=True, exist_ok=True)
    results = []
    for number in range(options.first, options.end):
        results.append(result := run(options.build.resolve(), folder, number, options.limit))
        print(f"{number}: exit {result['exit']}, {result['cpu_s']:.1f} s, {result.get('steps', 0)} steps, "
              f"{result.get('rejected', 0)} rejected, {result.get('iterations', 0):.1f} iterations, "
              f"strain {result.get('strain', 0):.2f}, solver {result.get('solver', 0):.2f}, {result['pairs']} pairs "
              f"{result['warning']}", flush=True)
    solved = [result for result in results if result["exit"] == 0 and "iterations" in result]
    middle = lambda key: sorted(result[key] for result in solved)[len(solved) // 2] if solved else 0
    print(f"{len(results)} scenes: {len(solved)} to the end, exit codes {sorted({str(r['exit']) for r in results})}, "
          f"{sum(result['pairs'] for result in results)} pairs; medians: {middle('iterations'):.1f} iterations a step, "
          f"solver {middle('solver'):.2f}; above a third: {sum(result['solver'] > 1 / 3 for result in solved)}")


if __name__ == "__main__":
    main()
