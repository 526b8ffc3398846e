"""The archive of `ninja bundle`, for the tests that need one."""
import os
import shutil
import subprocess


def missing():
    """The reason why this machine cannot make or run an archive; empty if it can."""
    for tool in ("zstd", "unshare", "chroot"):
        if not shutil.which(tool):
            return f"{tool} is not found: apt-get install zstd util-linux coreutils"
    if os.geteuid() != 0 or subprocess.run(["unshare", "--mount", "true"], check=False).returncode:
        return "roots and mounts of one's own take root"
    return ""


def make(source, weft, start, folder, *opengl):
    """Makes the archive, with fast compression, and returns its path."""
    build = os.path.dirname(os.path.dirname(weft))
    done = subprocess.run([os.path.join(source, ".packaging/bundle.sh"), build, start, folder, *opengl],
                          env={**os.environ, "ZSTD_CLEVEL": "1"}, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    print(done.stdout.strip())
    return os.path.join(folder, "weft-x86_64.tar.zst")


def unpack(archive, folder):
    os.makedirs(folder)
    subprocess.run(f"zstd -dc '{archive}' | tar -xf - -C '{folder}'", shell=True, check=True)
