#!/usr/bin/env python3
"""Holds what the documentation promises.

- Every relative link of a Markdown file leads to a file of the project, and a #fragment to one of
  its headings.
- Every `manoscope ...` command in a fenced sh block names a subcommand that `manoscope --help`
  lists, with long options that `manoscope SUBCOMMAND --help` lists.
- Every `make TARGET` there is a target of the Makefile.
- Every scenario in a fenced toml block (one with a line `scenario = 1`) is made by `manoscope twin`,
  seen by a small camera.

usage: tools/check_docs.py [--program build/manoscope] [ROOT]
exit code 0: all hold, 1: some do not, 2: the program cannot be asked
"""

import argparse
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path
from urllib.parse import unquote

SKIPPED = ("build", ".git", "manoscope-demo", "node_modules")
LINK = re.compile(r"!?\[(?:[^\]\[]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
REFERENCE = re.compile(r"^\s{0,3}\[[^\]]+\]:\s*<?(\S+?)>?(?:\s|$)")
HTML_LINK = re.compile(r"<(?:img|a)\b[^>]*?\b(?:src|href)=\"([^\"]+)\"")
FENCE = re.compile(r"^\s{0,3}(`{3,}|~{3,})\s*([\w+-]*)")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*\s*$")
SHELL_LANGUAGES = {"sh", "bash", "shell", "console"}


def markdown_files(root):
    for path in sorted(root.rglob("*.md")):
        folders = path.relative_to(root).parts[:-1]
        if not any(part in SKIPPED or part.startswith("build-") for part in folders):
            yield path


def split_fences(text):
    """Lines of prose and lines of fenced code: (number, line, language or None for prose)."""
    fence, language = None, None
    for number, line in enumerate(text.split("\n"), start=1):
        match = FENCE.match(line)
        if fence is None and match:
            fence, language = match.group(1), match.group(2)
        elif fence is not None and match and match.group(1).startswith(fence) and not match.group(2):
            fence = None
        elif fence is None:
            yield number, line, None
        else:
            yield number, line, language


def anchors(path):
    """The #fragments of a Markdown file's headings, made as code hosts make them."""
    found, seen = set(), {}
    for _, line, language in split_fences(path.read_text(encoding="utf-8")):
        match = HEADING.match(line) if language is None else None
        if match:
            title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", match.group(1)).lower()
            slug = re.sub(r"[^\w\- ]", "", title).replace(" ", "-")
            count = seen.get(slug, 0)
            seen[slug] = count + 1
            found.add(slug if count == 0 else f"{slug}-{count}")
    return found


def link_faults(root, path):
    faults = []
    for number, line, language in split_fences(path.read_text(encoding="utf-8")):
        if language is not None:
            continue
        prose = re.sub(r"`[^`]*`", "", line)
        targets = [match.group(1) for match in LINK.finditer(prose)]
        targets += [match.group(1) for match in HTML_LINK.finditer(prose)]
        targets += [match.group(1) for match in [REFERENCE.match(prose)] if match]
        for target in targets:
            if re.match(r"[a-zA-Z][a-zA-Z0-9+.-]*:", target):
                continue
            place = f"{path.relative_to(root)}:{number}"
            name, _, fragment = target.partition("#")
            goal = (path.parent / unquote(name)).resolve() if name else path
            if not goal.exists():
                faults.append(f"{place}: {target} does not exist")
            elif not goal.is_relative_to(root.resolve()):
                faults.append(f"{place}: {target} lies outside the project")
            elif fragment and goal.suffix == ".md" and fragment not in anchors(goal):
                faults.append(f"{place}: {target}: no such heading")
    return faults


def shell_commands(path):
    """(line number, words) of every command in the fenced shell blocks of a file."""
    pending, start = "", 0
    for number, line, language in split_fences(path.read_text(encoding="utf-8")):
        if language not in SHELL_LANGUAGES:
            pending = ""
            continue
        if not pending:
            start = number
        if line.rstrip().endswith("\\"):
            pending += line.rstrip()[:-1] + " "
            continue
        text, pending = pending + line, ""
        lexer = shlex.shlex(re.sub(r"^\s*[$#]\s", "", text), posix=True, punctuation_chars=";&|()")
        lexer.whitespace_split = True
        try:
            words = list(lexer)
        except ValueError:
            words = text.split()
        command = []
        for word in words + [";"]:
            if word and set(word) <= set(";&|()"):
                if command:
                    yield start, command
                command = []
            else:
                command.append(word)


def scenarios(path):
    """(line number, text) of every whole scenario in the fenced toml blocks of a file."""
    block, start = [], 0
    for number, line, language in [*split_fences(path.read_text(encoding="utf-8")), (0, "", None)]:
        if language == "toml":
            start = start or number
            block.append(line)
            continue
        if any(re.match(r"scenario\s*=\s*1\b", line) for line in block):
            yield start, "\n".join(block) + "\n"
        block, start = [], 0


class Program:
    """What the program says of itself in its help texts."""

    def __init__(self, path):
        self.path = path
        self.texts = {}

    def help(self, *words):
        if words not in self.texts:
            run = subprocess.run(
                [self.path, *words, "--help"], capture_output=True, text=True, timeout=60, check=True
            )
            self.texts[words] = run.stdout
        return self.texts[words]

    def subcommands(self):
        """Names at the head of the lines under the headings that speak of (sub)commands."""
        names, inside = set(), False
        for line in self.help().split("\n"):
            if line and not line[0].isspace():
                inside = "command" in line.lower() and line.rstrip().endswith(":")
            elif inside:
                match = re.match(r"^ {1,6}([a-z][a-z0-9_-]*)(\s|$)", line)
                if match:
                    names.add(match.group(1))
        return names

    def twin_fault(self, scenario):
        """What `manoscope twin` has against a scenario, "" if it makes it."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scenario.toml"
            path.write_text(scenario, encoding="utf-8")
            run = subprocess.run(
                [self.path, "twin", path, "-o", Path(folder) / "out", "--size", "64x32"],
                capture_output=True, text=True, timeout=300, check=False,
            )
            return "" if run.returncode == 0 else run.stderr.strip() or f"exit {run.returncode}"

    def options(self, subcommand):
        return set(re.findall(r"--[a-z][a-z0-9-]*", self.help(subcommand) + self.help()))


def command_faults(root, path, program, targets):
    faults = []
    for number, words in shell_commands(path):
        place = f"{path.relative_to(root)}:{number}"
        while words and re.match(r"^(\w+=.*|sudo|time)$", words[0]):
            words = words[1:]
        if not words:
            continue
        arguments = words[1:]
        if Path(words[0]).name == "manoscope":
            if not arguments or arguments[0].startswith("-"):
                continue
            if arguments[0] not in program.subcommands():
                faults.append(f"{place}: manoscope has no command {arguments[0]}")
                continue
            for word in arguments[1:]:
                option = re.match(r"--[a-z][a-z0-9-]*", word)
                if option and option.group() not in program.options(arguments[0]):
                    faults.append(
                        f"{place}: manoscope {arguments[0]} has no option {option.group()}"
                    )
        elif words[0] == "make":
            for before, word in zip(words, arguments):
                value = before in ("-j", "-C", "-f") or word.startswith("-") or "=" in word
                if not value and word not in targets:
                    faults.append(f"{place}: the Makefile has no target {word}")
    return faults


def scenario_faults(root, path, program):
    faults = []
    for number, text in scenarios(path):
        fault = program.twin_fault(text)
        if fault:
            faults.append(f"{path.relative_to(root)}:{number}: the scenario cannot be made: {fault}")
    return faults


def make_targets(root):
    makefile = root / "Makefile"
    if not makefile.is_file():
        return set()
    found = set()
    for line in makefile.read_text(encoding="utf-8").split("\n"):
        match = re.match(r"^([a-z][a-z0-9_ -]*):([^=]|$)", line)
        if match:
            found.update(match.group(1).split())
    return found


def check(root, program):
    """Every fault of the documentation under root, as lines of text."""
    faults = []
    targets = make_targets(root)
    for path in markdown_files(root):
        faults += link_faults(root, path) + command_faults(root, path, program, targets)
        faults += scenario_faults(root, path, program)
    return faults


def main(arguments):
    parser = argparse.ArgumentParser(description="Checks links and commands of the documentation.")
    parser.add_argument("--program", type=Path, help="default: ROOT/build/manoscope")
    parser.add_argument(
        "root", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent
    )
    settings = parser.parse_args(arguments)
    path = settings.program or settings.root / "build" / "manoscope"
    if not path.is_file():
        print(f"check_docs: {path} does not exist; run make first", file=sys.stderr)
        return 2
    try:
        faults = check(settings.root, Program(path.resolve()))
    except (OSError, subprocess.SubprocessError) as error:
        print(f"check_docs: cannot ask {path} for its help: {error}", file=sys.stderr)
        return 2
    for fault in faults:
        print(f"check_docs: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
