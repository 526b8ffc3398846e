"""A sweep of 24 runs on a Slurm of three nodes, with killed nodes, a killed task and a cancelled farm. The final
results equal those of one process to the bit.

farm_test.py WEFT    exits with 77 if Slurm is not installed.
"""
import csv
import os
import re
import signal
import subprocess
import sys
import time

from slurm import Slurm, missing, queue_is_empty, run_test

SCENE = """
[time]
duration = 0.8
fps = 25
step = 0.01
[render]
width = 64
height = 36
[[cloth]]
name = "cloth"
size = [0.5, 0.5]
particles = [31, 31]
position = [0, 0, 0.3]
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.1
segments = 8
"""
FRAMES = 21
RUNS = 24
RETRY = b"exit code 137: try 1 of 3"
ELSEWHERE = b"continues from here in a new place in the queue"
SWEEP = ("s.toml", "--quality", "draft", "--set", "obstacle.ball.radius=0.1,0.11,0.12,0.13", "--set",
         "cloth.cloth.material.density=0.1,0.2,0.3", "--set", "obstacle.ball.position=[0,0,0],[0.1,0,0]")
# A subset of these runs for the test of a full disk.
FILLING = 8
FILLING_SWEEP = ("s.toml", "--quality", "draft", "--set", "obstacle.ball.radius=0.1,0.11", "--set",
                 "cloth.cloth.material.density=0.1,0.2", "--set", "obstacle.ball.position=[0,0,0],[0.1,0,0]")


class Test:
    def __init__(self, weft, folder):
        self.weft, self.folder, self.last_signal = weft, folder, 0
        os.environ["WEFT_PAUSE"] = "1"
        with open(os.path.join(folder, "s.toml"), "w", encoding="utf-8") as file:
            file.write(SCENE)

    def run(self, *words, code=0):
        done = subprocess.run([self.weft, *words], cwd=self.folder, capture_output=True, text=True, check=False)
        assert done.returncode == code, f"{words}: {done.returncode}\n{done.stdout}{done.stderr}"
        return done.stdout + done.stderr

    def status(self, folder="farm"):
        done = subprocess.run([self.weft, "farm", "status", folder], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stdout

    def done(self):
        return self.status()[1].count("  done\n")

    def read(self, *names):
        with open(os.path.join(self.folder, *names), "rb") as file:
            return file.read()

    def table(self, sweep):
        """The result table of the runs, without the columns of cost."""
        rows = list(csv.DictReader(self.read(sweep, "table.csv").decode().splitlines()))
        return [{key: value for key, value in row.items() if "CPU s" not in key} for row in rows]

    def submit(self, code=0, folder="farm", sweep=SWEEP):
        return self.run("farm", "submit", *sweep, "-o", folder, "--part", "8", code=code)

    def logs(self):
        folder = os.path.join(self.folder, "farm/farm/log")
        return b"".join(self.read(folder, log) for log in os.listdir(folder))

    def one_goes_on_elsewhere(self, slurm):
        """Signals a script on n1, at most every 5 s. True once a task continues in another place of the queue."""
        if ELSEWHERE in self.logs():
            return True
        programs = slurm.tasks("n1", " simulate /")
        if programs and time.monotonic() > self.last_signal + 5:
            self.last_signal = time.monotonic()
            with open(f"/proc/{programs[-1]}/stat", encoding="utf-8") as file:
                os.kill(int(file.read().rsplit(")", 1)[1].split()[1]), signal.SIGUSR1)
        return False

    def check(self):
        slurm = None
        try:
            self.run("sweep", *SWEEP, "-o", "one", "--threads", "1")
            slurm = Slurm(os.path.join(self.folder, "slurm"), ["n1", "n2", "n3"])
            self.submit()
            assert "weft farm cancel" in self.submit(code=6), "jobs that run already are told"

            # Kills a process: its task tries again.
            slurm.wait(lambda: slurm.tasks("n1", " simulate /"), "a simulation on n1")
            os.kill(slurm.tasks("n1", " simulate /")[-1], signal.SIGKILL)
            slurm.wait(lambda: RETRY in self.logs(), "another try")
            # Sends the signal that Slurm sends near the time limit (--signal=B:USR1@60). The task is queued again.
            slurm.wait(lambda: self.one_goes_on_elsewhere(slurm), "a task that goes on in a new place")
            # Kills a daemon. Its tasks continue until they are also assigned to another node.
            slurm.wait(lambda: slurm.tasks("n2", " simulate /"), "a simulation on n2")
            slurm.kill_node("n2", with_tasks=False)
            # Kills a machine.
            slurm.wait(lambda: slurm.tasks("n3", " simulate /"), "a simulation on n3")
            slurm.kill_node("n3", with_tasks=True)
            slurm.wait(lambda: self.done() >= 3, "the first runs", 300)
            self.run("farm", "cancel", "farm")
            slurm.wait(queue_is_empty, "an empty queue")
            code, text = self.status()
            assert code == 9 and 3 <= text.count("  done\n") < RUNS, text
            print("after cancel:", text.splitlines()[-1])

            for node in ("n2", "n3"):
                slurm.start_node(node)
            self.submit()
            slurm.wait(lambda: self.status()[0] == 0 and queue_is_empty(), "all runs", 600)
            print("at the end:", self.status()[1].splitlines()[-1])
            assert "all runs are done" in self.submit(), "nothing is done twice"
            self.fill_disk(slurm)
        finally:
            if slurm:
                slurm.stop()
        self.compare()

    def fill_disk(self, slurm):
        """Runs on a shared folder with space for half of the simulations, then half of the pictures, then all."""
        names = [row["run"] for row in self.table("one")
                 if row["run"].startswith(("radius=0.1_density=0.1_", "radius=0.1_density=0.2_",
                                           "radius=0.11_density=0.1_", "radius=0.11_density=0.2_"))]
        assert len(names) == FILLING, names
        def size(*folder):
            """Size on a disk in memory, in whole pages [bytes]."""
            return sum(-(-os.path.getsize(os.path.join(place, file)) // 4096) * 4096 for name in names
                       for place, _, files in os.walk(os.path.join(self.folder, "farm", name, *folder)) for file in files)

        caches = size("cache")
        disk = os.path.join(self.folder, "disk")
        os.mkdir(disk)
        mount = ["mount", "-t", "tmpfs", "-o"]
        if subprocess.run([*mount, f"size={caches // 2}", "tmpfs", disk], capture_output=True, check=False).returncode:
            print("no full disk: this machine does not let us mount one")
            return
        try:
            for room, task in ((caches // 2, "simulate_"), (caches + size("frames") // 2 + 2**19, "draw_")):
                subprocess.run([*mount, f"remount,size={room}", "tmpfs", disk], check=True)
                self.submit(folder="disk/farm", sweep=FILLING_SWEEP)
                slurm.wait(queue_is_empty, "the end of what has no room", 300)
                code, text = self.status("disk/farm")
                print("on a full disk:", text, sep="\n")
                # A task may have no space for its exit code either; `status` then asks whether the disk is full.
                assert code == 9 and re.search("No space left on device|is the disk full", text) and task in text, text
                kept = self.whole_files(names)
            assert kept, "some pictures found room"
            subprocess.run([*mount, f"remount,size={4 * size() + 2**24}", "tmpfs", disk], check=True)
            self.submit(folder="disk/farm", sweep=FILLING_SWEEP)
            slurm.wait(lambda: self.status("disk/farm")[0] == 0 and queue_is_empty(), "all runs, with room", 300)
            for file, changed in kept.items():
                assert os.stat(os.path.join(disk, "farm", file)).st_mtime_ns == changed, f"{file} was made again"
            made = self.whole_files(names)
            print(f"with room again: {len(made)} pictures and videos, {len(kept)} of them kept")
            assert len(made) == FILLING * (FRAMES + 1), sorted(made)
        finally:
            subprocess.run(["umount", "-l", disk], check=True)

    def whole_files(self, names):
        """Pictures and videos on the disk, with their times. Expects each to equal that of the first farm."""
        found = {}
        for name in names:
            for folder, _, files in os.walk(os.path.join(self.folder, "disk/farm", name)):
                for file in files:
                    if file.endswith((".png", ".mp4")) and not file.startswith("."):
                        path = os.path.relpath(os.path.join(folder, file), os.path.join(self.folder, "disk/farm"))
                        assert self.read("disk/farm", path) == self.read("farm", path), f"{path} is not whole"
                        found[path] = os.stat(os.path.join(folder, file)).st_mtime_ns
        return found

    def compare(self):
        assert self.table("farm") == self.table("one"), "tables differ"
        assert len(self.table("one")) == RUNS
        for words in (RETRY, ELSEWHERE):
            assert words in self.logs(), f"expected in a log: {words}"
        for row in self.table("one"):
            name = row["run"]
            assert self.read("one", name, "s.mp4") == self.read("farm", name, "s.mp4"), f"{name}: another video"
            pictures = sorted(os.listdir(os.path.join(self.folder, "farm", name, "frames")))
            expected = [f"{frame:05}.png" for frame in range(FRAMES)]
            assert [picture for picture in pictures if picture.endswith(".png")] == expected, pictures


if __name__ == "__main__":
    sys.exit(run_test(missing(), lambda folder: Test(os.path.abspath(sys.argv[1]), folder).check()))
