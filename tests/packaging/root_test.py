"""The archive of `ninja bundle` in an otherwise empty root: no shell, no C library, no /dev. Films, pictures, meshes
from files, sweeps and comparisons equal those of the built program to the bit; with EGL only, and with OSMesa if this
machine has it.

root_test.py SOURCE WEFT START    exits with 77 if no such root can be made.
"""
import os
import shutil
import subprocess
import sys
import tempfile

import archive

NOBODY = 65534
SCENE = """
[time]
duration = 0.16
fps = 25
[render]
width = 160
height = 90
[[cloth]]
name = "cloth"
size = [0.5, 0.5]
particles = [21, 21]
position = [0, 0, 0.24]
[[obstacle]]
name = "cube"
shape = "mesh"
file = "cube.obj"
"""
CUBE = """
v -0.1 -0.1 0.0
v 0.1 -0.1 0.0
v 0.1 0.1 0.0
v -0.1 0.1 0.0
v -0.1 -0.1 0.2
v 0.1 -0.1 0.2
v 0.1 0.1 0.2
v -0.1 0.1 0.2
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""
COMMANDS = (("doctor",),
            ("check", "cube.toml", "cube_gltf.toml"),
            ("run", "cube.toml", "-o", "cube.mp4"),
            ("run", "cube_gltf.toml", "-o", "gltf/{frame:05}.png"),
            ("sweep", "cube.toml", "--set", "cloth.cloth.material.density=0.1,0.2", "-o", "sweep", "--size", "64x36"),
            ("diff", "cube.mp4", "cube.mp4"),
            ("diff", "gltf", "gltf"),
            ("run", "cube.toml", "-o", "cube.mov", "--frames", "0:2"))
MADE = ("cube.mp4", "cube.mov", "gltf/00000.png", "gltf/00004.png", "sweep/density=0.2/cube.mp4")


def run(*words, **options):
    done = subprocess.run(words, capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, f"{words}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


def prepare(folder, weft):
    """Writes scenes of a cube from an OBJ file, and of an exported ball from a glTF file."""
    os.mkdir(folder)
    for name, text in (("cube.obj", CUBE), ("cube.toml", SCENE),
                       ("cube_gltf.toml", SCENE.replace("cube.obj", "ball/s.glb"))):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    with open(os.path.join(folder, "s.toml"), "w", encoding="utf-8") as file:
        file.write('[time]\nduration = 0.04\nfps = 25\n[[obstacle]]\nname = "ball"\nshape = "sphere"\nradius = 0.1\n')
    run(weft, "simulate", "s.toml", "--cache", "ball.cache", cwd=folder)
    run(weft, "export", "ball.cache", "--format", "gltf", "-o", "ball", cwd=folder)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def has_osmesa():
    """Whether this machine has OSMesa, which Mesa no longer has since version 25.1."""
    return "libOSMesa.so.8 " in run("ldconfig", "-p", env={**os.environ, "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"})


def is_same(weft, opengl, expected, found):
    """Compares bytes; with EGL, compares pixels, because files contain the name of the OpenGL implementation."""
    if opengl == "osmesa":  # which the built program prefers, too
        return read(expected) == read(found)
    run(weft, "diff", expected, found, "--pixel-tolerance", "0", "--pixel-budget", "0")
    return True


def enter(root, *words):
    """Executes the program as an unprivileged user in `root`, in a private mount namespace (its end unmounts /proc)."""
    subprocess.run(["mount", "-t", "proc", "proc", os.path.join(root, "proc")], check=True)
    os.chroot(root)
    os.chdir("/data")
    os.setgroups([])
    os.setgid(NOBODY)
    os.setuid(NOBODY)
    os.execve("/weft/bin/weft", ["weft", *words], {})


def try_archive(root, data):
    for name in ("proc", "tmp"):
        os.mkdir(os.path.join(root, name))
    os.chmod(os.path.join(root, "tmp"), 0o1777)
    shutil.copytree(data, os.path.join(root, "data"))
    run("chown", "-R", f"{NOBODY}:{NOBODY}", os.path.join(root, "data"))
    for words in COMMANDS:
        said = run("unshare", "--mount", "--propagation", "private", "--pid", "--fork", sys.executable, "-B", __file__,
                   "--enter", root, *words)
        print(said if words[0] == "doctor" else "", end="")


def main(source, weft, start):
    reason = archive.missing()
    if reason:
        print(reason)
        return 77
    folder = tempfile.mkdtemp()
    try:
        os.chmod(folder, 0o755)
        data, expected = os.path.join(folder, "data"), os.path.join(folder, "expected")
        prepare(data, weft)
        shutil.copytree(data, expected)
        for words in COMMANDS:
            run(weft, *words, cwd=expected)
        for opengl in ("osmesa", "egl") if has_osmesa() else ("egl",):
            path = archive.make(source, weft, start, os.path.join(folder, opengl), opengl)
            root = os.path.join(folder, opengl, "root")
            archive.unpack(path, root)
            try_archive(root, data)
            for name in MADE:
                same = is_same(weft, opengl, os.path.join(expected, name), os.path.join(root, "data", name))
                assert same, f"{opengl}: {name} differs"
    except AssertionError as problem:
        print(problem)
        return 1
    finally:
        shutil.rmtree(folder)
    return 0


if __name__ == "__main__":
    if sys.argv[1] == "--enter":
        enter(*sys.argv[2:])
    sys.exit(main(*map(os.path.abspath, sys.argv[1:])))
