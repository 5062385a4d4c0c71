#!/usr/bin/env python3
"""Prints a regular expression for `ctest -E`: the tests that took long when ctest last ran them.

usage: tools/long_tests.py BUILD SECONDS [KEEP]

BUILD is a folder whose tests were run; ctest keeps the time of each. Tests of more than SECONDS are
told, but for those that the regular expression KEEP finds. Where nothing is known, no test is long:
the expression then finds none.
"""

import pathlib
import re
import sys

NONE = "^$"


def read_costs(build):
    """Mean seconds of every test by its name; empty where ctest has not run."""
    path = pathlib.Path(build, "Testing", "Temporary", "CTestCostData.txt")
    costs = {}
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        return costs
    for line in lines:
        if line == "---":  # below it are the names of those that failed
            break
        name, _, seconds = line.rsplit(" ", 2)
        costs[name] = float(seconds)
    return costs


def expression(costs, seconds, keep):
    """What finds the long tests of a table, and no others."""
    long_ones = sorted(name for name, cost in costs.items()
                       if cost > seconds and not (keep and re.search(keep, name)))
    # A dot for every character that would mean something else in an expression of ctest.
    names = [re.sub(r"[^A-Za-z0-9_-]", ".", name) for name in long_ones]
    return f"^({'|'.join(names)})$" if names else NONE


def main(arguments):
    if len(arguments) not in (2, 3):
        print(__doc__.split("\n\n")[1], file=sys.stderr)
        return 2
    build, seconds = arguments[0], float(arguments[1])
    costs = read_costs(build)
    if not costs:
        print(f"{build}: no times of tests there (make test); none is left out", file=sys.stderr)
    print(expression(costs, seconds, arguments[2] if len(arguments) == 3 else ""))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
