#!/usr/bin/env python3
"""Checks sources with clang, with the flags of the build: those of src/ with clang-tidy (`tidy`), which also prints the
warnings of the compiler, those of tests/ with the compiler only (`syntax`). `changed` is `tidy` of the differences from
the commit before the last one; without that commit, of everything.

usage: lint.py BUILD syntax|tidy|changed [PART OF A PATH...]

Reads compile_commands.json of the build folder. Prints all findings; exits with 1 if there are any.
"""
import json
import os
import pathlib
import re
import resource
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

TREE = pathlib.Path(__file__).resolve().parents[2]

# Headers that are precompiled once for all sources, which reduces the time of clang to a third.
PRECOMPILED = ["Eigen/Dense", "fmt/format.h", "algorithm", "filesystem", "functional", "map", "memory", "optional",
               "string", "vector", "gtest/gtest.h", "fstream", "random", "sstream"]

# clang-tidy spends most of its time on included headers. Many sources are therefore checked as one file, a chunk. If
# clang reports an ambiguous name, a source and a header of one module use the same name: rename one of them.
CHUNKS = 2


class Source:
    def __init__(self, entry):
        self.path = pathlib.Path(entry["file"])
        self.flags = ["-Wno-unknown-warning-option"]  # flags for GCC without outputs and its precompiled header
        words = iter(shlex.split(entry["command"])[1:])
        for word in words:
            if word in ("-include", "-o", "-c", "--param"):
                next(words)
            elif word == "-isystem":
                self.flags.append(word + next(words))
            elif word != "-Winvalid-pch" and not word.startswith(("-fPIC", "-fvisibility")):
                self.flags.append(word)  # without the flags left out, these are the same for all sources

    def names(self):
        """Names that the source declares in unnamed namespaces or defines for another module, and names that it may
        use. No source of a chunk may use a name that another source of the chunk declares in this way."""
        text = self.path.read_text()
        outer = re.search(r"^namespace (weft\S*) \{", text, re.M)
        used = set(re.findall(r"(?<![\w.>:])(?:[a-z]\w*(?=\()|[A-Z]\w*|k[A-Z]\w*)", text))
        names = set(re.findall(r"^[\w:<>&* ]+ ((?:[a-z]\w*::)+[a-z]\w*)\(.*\{$", text, re.M))
        for part in re.findall(r"^namespace \{$(.*?)^\}  // namespace$", text, re.M | re.S):
            for line in re.findall(r"^(?!namespace|using \S+;)[\w\[].*$", part, re.M):
                declared = re.match(r"(?:using|struct|class|enum class) (\w+)|.*?(\w+)(?:\(|\{| = |;|\[)", line)
                if declared:
                    names.add(declared[1] or declared[2])
        return [{f"{outer and outer[1]}::{name}" for name in found} for found in (names, used | names)]


def compiled(entry):
    """The entries of a compiled file: for a unity file one entry for each of its sources."""
    path = pathlib.Path(entry["file"])
    if "Unity" not in path.parts:
        return [entry]
    return [{**entry, "file": name} for name in re.findall(r'^#include "(.*\.cpp)"$', path.read_text(), re.M)]


def changed_files():
    """Files below src/ that the last commit or the working tree has changed; None if there is no commit before it."""
    names = set()
    for words in (["diff", "--name-only", "--relative", "HEAD~1", "--", "src"],
                  ["ls-files", "--others", "--exclude-standard", "--", "src"]):
        try:
            run = subprocess.run(["git", *words], cwd=TREE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        except OSError:
            return None
        if run.returncode:
            return None
        names.update(run.stdout.split())
    return names


def through_headers(names, paths):
    """The sources among `names`, and for each header one source that includes it, directly or through other headers."""
    texts = {path: path.read_text() for path in [*paths, *sorted((TREE / "src").rglob("*.hpp"))]}
    chosen = {path for path in paths if str(path.relative_to(TREE)) in names}
    headers = sorted(TREE / name for name in names if name.endswith(".hpp"))
    for header in headers:  # the list grows during the loop
        line = f'#include "{header.relative_to(TREE / "src")}"'
        including = sorted((path for path in texts if line in texts[path]), key=lambda path: path.stem != header.stem)
        sources = [path for path in including if path.suffix == ".cpp"]
        if sources and not chosen & set(sources):
            chosen.add(sources[0])
        elif not sources:
            headers += [path for path in including[:1] if path not in headers]
    return chosen


def precompile(build, flags):
    header = build / "lint.hpp"
    header.write_text("".join(f"#include <{name}>\n" for name in PRECOMPILED))
    target = header.with_suffix(".pch")
    shared = [flag for flag in flags if not flag.startswith(("-DWEFT_", "-I"))]
    subprocess.run(["clang++-14", *shared, "-x", "c++-header", header, "-o", target], check=True)
    return target


def syntax_commands(build, sources):
    header = precompile(build, sources[0].flags)
    return [["clang++-14", "-fsyntax-only", *s.flags, "-include-pch", header, s.path] for s in sources]


def tidy_commands(build, sources):
    chunks = []  # each with its sources, declared names and used names
    for source in sources:
        declared, used = source.names()
        fitting = [chunk for chunk in chunks if not chunk[1] & used and not chunk[2] & declared]
        if len(chunks) < CHUNKS or not fitting:
            fitting = [([], set(), set())]
            chunks.append(fitting[0])
        shortest = min(fitting, key=lambda chunk: len(chunk[0]))
        shortest[0].append(source)
        shortest[1].update(declared)
        shortest[2].update(used)
    commands = []
    for number, (chunk, _, _) in enumerate(chunks):
        file = build / f"lint_{number}.cpp"
        file.write_text("".join(f'#include "{source.path}"\n' for source in chunk))
        # -Wshadow is left out, because a name may shadow a name of another source in the same chunk.
        flags = dict.fromkeys(flag for source in chunk for flag in source.flags if flag != "-Wshadow")
        commands.append(["clang-tidy-14", "--quiet", file, "--", *flags])
    return commands


def main():
    build, kind, patterns = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], sys.argv[3:]
    commands = json.loads((build / "compile_commands.json").read_text())
    entries = {entry["file"]: entry for command in commands for entry in compiled(command)}
    root = TREE / ("tests" if kind == "syntax" else "src")
    sources = [Source(entry) for name, entry in sorted(entries.items())
               if name.endswith(".cpp") and pathlib.Path(name).is_relative_to(root)
               and (not patterns or any(part in name for part in patterns))]
    if kind == "changed" and (names := changed_files()) is not None:
        chosen = through_headers(names, [source.path for source in sources])
        sources = [source for source in sources if source.path in chosen]
    commands = (syntax_commands if kind == "syntax" else tidy_commands)(build, sources)

    def findings(command):
        run = subprocess.run(command, cwd=TREE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        return (run.stdout or run.stderr or f"{command[0]}: {run.returncode}\n") if run.returncode else ""

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = "".join(pool.map(findings, commands))
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{found}{kind}: {len(sources)} sources, {used.ru_utime + used.ru_stime:.0f} CPU s")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
