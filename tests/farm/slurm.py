"""A private Slurm on this machine: one controller and several nodes, in a folder of their own."""
import os
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol")

CONFIGURATION = """
ClusterName=weft
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=3
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,bf_interval=1
SlurmdParameters=config_overrides
SlurmdTimeout=5
MessageTimeout=3
ReturnToService=2
KillWait=5
JobRequeue=1
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
{nodes}
PartitionName=all Nodes=ALL Default=YES State=UP
"""


def missing():
    """Missing packages or privileges as text; empty if Slurm can run here."""
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    programs = [program for program in PROGRAMS if not shutil.which(program)]
    if programs:
        return f"{', '.join(programs)} not found: apt-get install slurm-wlm munge"
    if os.geteuid() != 0:
        return "a Slurm of one's own takes root"
    return ""


def run_test(reason, check):
    """Calls `check` with a new folder, which stays if an assertion fails. Returns the exit code of the test: 77 if a
    `reason` is given why it cannot run here."""
    if reason:
        print(reason)
        return 77
    folder = tempfile.mkdtemp()
    try:
        os.mkdir(os.path.join(folder, "slurm"))
        check(folder)
    except AssertionError as problem:
        print(f"{problem}; what there is lies in {folder}")
        return 1
    shutil.rmtree(folder)
    return 0


def queue_is_empty():
    return not subprocess.run(["squeue", "-h"], capture_output=True, text=True, check=True).stdout


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Slurm:
    def __init__(self, folder, nodes, before=()):
        """`before`: words that precede the command that starts a node."""
        self.folder, self.nodes, self.before, self.processes = folder, nodes, before, {}
        lines = [f"NodeName={node} NodeHostname={socket.gethostname()} NodeAddr=127.0.0.1 Port={free_port()} CPUs=2 "
                 "RealMemory=8000" for node in nodes]
        self.configuration = os.path.join(folder, "slurm.conf")
        with open(self.configuration, "w", encoding="utf-8") as file:
            file.write(CONFIGURATION.format(folder=folder, host=socket.gethostname(), port=free_port(),
                                            nodes="\n".join(lines)))
        os.mkdir(os.path.join(folder, "state"))
        key = os.path.join(folder, "munge.key")
        with open(key, "wb") as file:
            file.write(os.urandom(128))
        os.chmod(key, 0o400)
        os.environ["SLURM_CONF"] = self.configuration
        self.start("munged", "munged", "--foreground", "--force", "--key-file", key, "--num-threads", "2",
                   "--socket", f"{folder}/munge.socket", "--pid-file", f"{folder}/munge.pid",
                   "--log-file", f"{folder}/munge.log", "--seed-file", f"{folder}/munge.seed")
        self.wait(lambda: os.path.exists(f"{folder}/munge.socket"), "munged")
        self.start("slurmctld", "slurmctld", "-D", "-c", "-f", self.configuration)
        for node in nodes:
            self.start_node(node)
        self.wait(lambda: self.idle() == len(nodes), "the nodes")

    def start(self, name, *command):
        with open(os.path.join(self.folder, name + ".out"), "ab") as out:
            self.processes[name] = subprocess.Popen(command, stdout=out, stderr=out, stdin=subprocess.DEVNULL,
                                                    start_new_session=True)

    def start_node(self, node):
        self.start(node, *self.before, "slurmd", "-D", "-c", "-N", node, "-f", self.configuration)

    def idle(self):
        nodes = subprocess.run(["sinfo", "-h", "-N", "-o", "%N %T"], capture_output=True, text=True, check=False).stdout
        return sum(line.split()[1] in ("idle", "mixed", "allocated") for line in nodes.splitlines())

    @staticmethod
    def wait(condition, what, seconds=60):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, f"waited {seconds} s for {what}"
            time.sleep(0.2)

    def tasks(self, node, program=""):
        """Processes of jobs on a node, found by their environment."""
        found = []
        for name in os.listdir("/proc"):
            if not name.isdigit():
                continue
            try:
                with open(f"/proc/{name}/environ", "rb") as file:
                    variables = file.read().split(b"\0")
                with open(f"/proc/{name}/cmdline", "rb") as file:
                    command = file.read().replace(b"\0", b" ").decode(errors="replace")
            except OSError:
                continue
            ours = f"SLURM_CONF={self.configuration}".encode()
            if ours in variables and f"SLURMD_NODENAME={node}".encode() in variables and program in command:
                found.append(int(name))
        return found

    def kill_node(self, node, with_tasks):
        """Kills the daemon of a node, and with `with_tasks` its jobs too, as if the machine failed."""
        self.processes[node].kill()
        self.processes[node].wait()
        if with_tasks:
            for process in self.tasks(node):
                try:
                    os.kill(process, signal.SIGKILL)
                except ProcessLookupError:
                    pass

    def stop(self):
        for node in self.nodes:
            self.kill_node(node, with_tasks=True)
        for name in ("slurmctld", "munged"):
            if name in self.processes:
                self.processes[name].kill()
                self.processes[name].wait()
