#!/usr/bin/env python3
"""Prints the modules whose sources the last commits changed, one a line, lowest layer first.

usage: tools/changed_modules.py COMMITS

A module is a folder of src/manoscope that layers.txt names. Where the history is shorter than
COMMITS, or where it cannot be read, every module counts as changed.
"""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ("src", "manoscope")


def modules_of(layers):
    """The names in layers.txt, from its lowest line to its highest."""
    return layers.split()


def changed_files(root, commits):
    """Paths that differ between COMMITS commits ago and now; None if that is not known."""
    done = subprocess.run(["git", "diff", "--name-only", f"HEAD~{commits}", "--"], cwd=root,
                          capture_output=True, text=True, check=False)
    return done.stdout.splitlines() if done.returncode == 0 else None


def changed_modules(modules, files):
    """Those of the modules that own one of the files; all if the files are not known."""
    if files is None:
        return modules
    owners = {path.parts[2] for path in map(pathlib.PurePosixPath, files)
              if path.parts[:2] == FOLDER and len(path.parts) > 3}
    return [module for module in modules if module in owners]


def main(arguments):
    if len(arguments) != 1 or not arguments[0].isdigit():
        print(__doc__.split("\n\n")[1], file=sys.stderr)
        return 2
    modules = modules_of((ROOT / "layers.txt").read_text(encoding="utf-8"))
    for module in changed_modules(modules, changed_files(ROOT, int(arguments[0]))):
        print(module)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
