#!/usr/bin/env python3
"""Holds the include rule of layers.txt.

Each line of layers.txt is a layer, the lowest first; the modules of one line do not see each other.
A file of src/manoscope/<module>/ may include its own module and the modules of lower lines, nothing
else of the project. What sits on top of the library (src/cli, src/navier_stokes, python, bench, fuzz,
examples, tests) may include all of it. No file may include itself by way of others.

usage: tools/check_layers.py [ROOT]     exit code 0: held, 1: broken, 2: nothing to check
"""

import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]', re.MULTILINE)
BLOCK_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
SOURCES = {".hpp", ".cpp", ".h", ".inc"}
ON_TOP = ("src/cli", "src/navier_stokes", "python", "bench", "fuzz", "examples", "tests")


def read_layers(path):
    """Module name -> number of its line; raises ValueError if one is named twice."""
    levels = {}
    for level, line in enumerate(path.read_text().split("\n")):
        for module in line.split("#")[0].split():
            if module in levels:
                raise ValueError(f"{path.name} names {module} twice")
            levels[module] = level
    return levels


def includes(path):
    """(line number, included name, whether in quotes) of every include of a file."""
    text = path.read_text(encoding="utf-8", errors="replace")
    text = BLOCK_COMMENT.sub(lambda match: "\n" * match.group().count("\n"), text)
    for match in INCLUDE.finditer(text):
        yield text.count("\n", 0, match.start()) + 1, match.group(2), match.group(1) == '"'


def source_files(folder):
    if not folder.is_dir():
        return []
    return sorted(path for path in folder.rglob("*") if path.is_file() and path.suffix in SOURCES)


def module_faults(root, levels):
    """What is wrong inside src/manoscope."""
    library = root / "src" / "manoscope"
    folders = sorted(path for path in library.iterdir() if path.is_dir())
    faults = [
        f"src/manoscope/{folder.name}: no such module in layers.txt; give it a place there"
        for folder in folders
        if folder.name not in levels
    ]
    for folder in folders:
        own = folder.name
        if own not in levels:
            continue
        for path in source_files(folder):
            for line, name, quoted in includes(path):
                place = f"{path.relative_to(root)}:{line}"
                parts = name.split("/")
                if parts[0] == "cli" or ".." in parts or name.startswith("src/"):
                    faults.append(f"{place}: the library must not include {name}")
                elif parts[0] != "manoscope":
                    # A bare name that is a neighbour would slip past the rule.
                    if quoted and (path.parent / name).is_file():
                        faults.append(
                            f'{place}: write "manoscope/{own}/..." in full instead of "{name}"'
                        )
                elif len(parts) < 3:
                    faults.append(f"{place}: {name} belongs to no module")
                elif parts[1] not in levels:
                    faults.append(f"{place}: {name} is of a module that layers.txt does not name")
                elif parts[1] != own and levels[parts[1]] >= levels[own]:
                    where = "beside" if levels[parts[1]] == levels[own] else "above"
                    faults.append(
                        f"{place}: {own} must not include {name}: {parts[1]} lies {where} it"
                    )
    return faults


def unknown_module_faults(root, levels):
    """Includes of modules that do not exist, from what sits on top."""
    faults = []
    for folder in ON_TOP:
        for path in source_files(root / folder):
            for line, name, _ in includes(path):
                parts = name.split("/")
                if parts[0] == "manoscope" and len(parts) > 2 and parts[1] not in levels:
                    faults.append(
                        f"{path.relative_to(root)}:{line}: "
                        f"{name} is of a module that layers.txt does not name"
                    )
    return faults


def include_cycles(root):
    """Every ring of files that include each other, each told once."""
    source = root / "src"
    graph = {}
    for path in source_files(source):
        targets = []
        for _, name, quoted in includes(path):
            for base in (source, path.parent) if quoted else (source,):
                target = base / name
                if target.is_file():
                    targets.append(target.resolve())
                    break
        graph[path.resolve()] = targets

    faults = []
    finished = set()
    for start in graph:
        if start in finished:
            continue
        trail, on_trail = [start], {start}
        stack = [iter(graph[start])]
        while stack:
            target = next(stack[-1], None)
            if target is None:
                stack.pop()
                finished.add(trail[-1])
                on_trail.remove(trail.pop())
            elif target in on_trail:
                ring = trail[trail.index(target) :] + [target]
                names = " -> ".join(str(path.relative_to(root.resolve())) for path in ring)
                faults.append(f"include cycle: {names}")
            elif target not in finished and target in graph:
                trail.append(target)
                on_trail.add(target)
                stack.append(iter(graph[target]))
    return faults


def check(root):
    """Every fault of the tree under root, as lines of text."""
    levels = read_layers(root / "layers.txt")
    return module_faults(root, levels) + unknown_module_faults(root, levels) + include_cycles(root)


def main(arguments):
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    if not (root / "layers.txt").is_file() or not (root / "src" / "manoscope").is_dir():
        print(f"check_layers: {root} has no layers.txt or no src/manoscope", file=sys.stderr)
        return 2
    try:
        faults = check(root)
    except ValueError as error:
        faults = [str(error)]
    for fault in faults:
        print(f"check_layers: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
