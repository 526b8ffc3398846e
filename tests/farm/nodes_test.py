"""A sweep on a Slurm whose nodes have neither Weft nor its libraries. They unpack and run the archive of
`weft farm submit --program`; the results equal those of one process to the bit.

nodes_test.py SOURCE WEFT START    exits with 77 if Slurm is not installed or no archive can be made.
"""
import glob
import os
import re
import shutil
import subprocess
import sys

from slurm import Slurm, missing, queue_is_empty, run_test

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../packaging"))
import archive  # pylint: disable=wrong-import-position

SCENE = """
[time]
duration = 0.4
fps = 25
[render]
width = 64
height = 36
[[cloth]]
name = "cloth"
size = [0.5, 0.5]
particles = [15, 15]
position = [0, 0, 0.3]
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.1
segments = 8
"""
SWEEP = ("s.toml", "--quality", "draft", "--set", "obstacle.ball.radius=0.1,0.11")
RUNS = ("radius=0.1", "radius=0.11")
# Runs a command in a mount namespace in which each given path is replaced by an empty file or folder.
HIDE = 'while [ "$1" != -- ]; do if [ -d "$1" ]; then mount --bind "$0/folder" "$1"; else mount --bind "$0/file" "$1"; fi; ' \
       'shift; done; shift; exec "$@"'


def libraries(*programs):
    """Paths of the libraries that the loader finds, by name."""
    listed = subprocess.run(["ldd", *programs], capture_output=True, text=True, check=False).stdout
    return dict(re.findall(r"(\S+) => (/\S+) ", listed))


def only_of_weft(weft):
    """The program's folder and its libraries, linked or opened, without those that programs of a node need."""
    named = subprocess.run(["readelf", "-dW", weft], capture_output=True, text=True, check=True).stdout
    found = {path for name, path in libraries(weft).items() if f"[{name}]" in named}
    for name in ("libOSMesa.so.8", "libEGL.so.1"):
        found.update(glob.glob(f"/usr/lib/x86_64-linux-gnu/{name}"))
    others = [shutil.which(name) for name in ("slurmd", "slurmstepd", "sbatch", "munged", "sh", "tar", "rm", "mount")]
    others += glob.glob("/usr/lib/x86_64-linux-gnu/slurm-wlm/*.so")
    found -= set(libraries(*filter(None, others)).values())
    assert any("libavcodec" in path for path in found), found
    return [os.path.dirname(weft), *map(os.path.realpath, sorted(found))]


def check(source, weft, start, folder):
    def run(*words, code=0, cwd=folder):
        done = subprocess.run(words, cwd=cwd, capture_output=True, text=True, check=False)
        assert done.returncode == code, f"{words}: {done.returncode}\n{done.stdout}{done.stderr}"
        return done.stdout + done.stderr

    path = archive.make(source, weft, start, os.path.join(folder, "made"))
    with open(os.path.join(folder, "s.toml"), "w", encoding="utf-8") as file:
        file.write(SCENE)
    run(weft, "sweep", *SWEEP, "-o", "one", "--threads", "1")
    os.mkdir(os.path.join(folder, "folder"))
    with open(os.path.join(folder, "file"), "w", encoding="utf-8"):
        pass
    bare = ["unshare", "--mount", "--propagation", "private", "sh", "-c", HIDE, folder, *only_of_weft(weft), "--"]
    # On such a node neither the program nor a copy of it runs.
    run(*bare, weft, "--version", code=127)
    shutil.copy(weft, os.path.join(folder, "copy"))
    assert "error while loading shared libraries" in run(*bare, os.path.join(folder, "copy"), "--version", code=127)

    slurm = Slurm(os.path.join(folder, "slurm"), ["n1", "n2"], bare)
    try:
        run(weft, "farm", "submit", *SWEEP, "-o", "farm", "--part", "4", "--program", path)
        slurm.wait(queue_is_empty, "an empty queue", 300)
        print(run(weft, "farm", "status", "farm"))
    finally:
        slurm.stop()
    for name in RUNS:
        made = []
        for sweep in ("one", "farm"):
            with open(os.path.join(folder, sweep, name, "s.mp4"), "rb") as file:
                made.append(file.read())
        assert made[0] == made[1], f"{name}: another video"
    unpacked = os.listdir(os.path.join(folder, "farm/farm/program"))
    assert len(unpacked) == 1 and not unpacked[0].endswith(".tar"), unpacked


if __name__ == "__main__":
    paths = map(os.path.abspath, sys.argv[1:])
    sys.exit(run_test(missing() or archive.missing(), lambda folder: check(*paths, folder)))
