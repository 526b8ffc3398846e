"""Real shells complete each command, option and choice of --help, and mandoc accepts the manual.

shells_test.py WEFT    ends with 77 where zsh, fish or mandoc is not installed.
"""
import os
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time

PROGRAMS = ("bash", "zsh", "fish", "mandoc")


def output(*words):
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


class Zsh:
    """An interactive shell at a terminal of its own, because completion works only interactively."""
    MARK = "all that there is"

    def __init__(self):
        process, self.terminal = pty.fork()
        if process == 0:
            os.environ.update(TERM="dumb", COLUMNS="250", LINES="200", PS1="> ")
            os.execvp("zsh", ["zsh", "-f", "-i"])
        # Lists all completions at once, without a menu.
        self.ask("stty cols 250 rows 200; autoload -Uz compinit && compinit -u -D; unsetopt auto_menu list_ambiguous\n"
                 "LISTMAX=10000; source <(weft completion zsh); echo all that there i''s\n", until=self.MARK)

    def ask(self, text, until=None):
        os.write(self.terminal, text.encode())
        answer, end = "", time.monotonic() + (20 if until else 0.4)
        while time.monotonic() < end and not (until and until in answer):
            if select.select([self.terminal], [], [], 0.05)[0]:
                answer += os.read(self.terminal, 65536).decode(errors="replace")
                end = max(end, time.monotonic() + 0.2)
        return answer

    def complete(self, line):
        answer = self.ask(line + "\t\t")
        self.ask("\x15")  # empties the line
        return set(re.findall(r"--[a-z-]+[a-z]|\b[a-z0-9_]+\b", answer))


def fish(line):
    text = output("fish", "--no-config", "-c", f"weft completion fish | source; complete -C '{line}'")
    return {entry.split("\t")[0] for entry in text.splitlines()}


def bash(line):
    words = line.split(" ")
    script = f"source <(weft completion bash); COMP_WORDS=({' '.join(words[:-1])} '{words[-1]}'); " \
             f"COMP_CWORD={len(words) - 1}; _weft; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    return set(output("bash", "-c", script).split())


def expected():
    """Pairs of a line and the words that must be offered as its completions."""
    commands = re.findall(r"^  ([a-z]+)[ ,]", output("weft", "--help").split("Subcommands:")[1].split("Examples:")[0], re.M)
    yield "weft ", set(commands)
    for command in commands:
        text = output("weft", command, "--help")
        options = re.findall(r"^  (?:-\w,)?(--[a-z-]+)(?:,-\w)?(?: (\S+))?", text, re.M)
        assert options, command
        yield f"weft {command} --", {name for name, _ in options}
        for name, value in options:
            if re.fullmatch(r"[a-z0-9_]+(\|[a-z0-9_]+)+", value):
                yield f"weft {command} {name} ", set(value.split("|"))
        first = re.search(r"^  [A-Z]+ ([a-z|]+\|[a-z|]+) REQUIRED", text, re.M)
        if first:
            yield f"weft {command} ", set(first.group(1).split("|"))


def main(weft):
    absent = [program for program in PROGRAMS if not shutil.which(program)]
    if absent:
        print(f"{', '.join(absent)} not found: apt-get install {' '.join(absent)}")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(weft, os.path.join(folder, "weft"))
        os.environ["PATH"] = folder + ":" + os.environ["PATH"]
        os.environ["HOME"] = folder
        os.mkdir(os.path.join(folder, "empty"))
        os.chdir(os.path.join(folder, "empty"))
        zsh, lines, problems = Zsh(), 0, []
        for line, words in expected():
            lines += 1
            for name, complete in (("bash", bash), ("zsh", zsh.complete), ("fish", fish)):
                missing = words - complete(line)
                problems += [f"{name}: '{line}' lacks {', '.join(sorted(missing))}"] if missing else []
        with open("weft.1", "w", encoding="utf-8") as file:
            file.write(output("weft", "man"))
        lint = subprocess.run(["mandoc", "-Tlint", "weft.1"], capture_output=True, text=True, check=False).stdout
        # Lines of --help keep their length in the manual.
        problems += [problem for problem in lint.splitlines() if "longer than 80 bytes" not in problem]
    print("\n".join(problems) or f"{lines} lines are completed by {', '.join(PROGRAMS[:3])}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1])))
