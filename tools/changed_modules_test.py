#!/usr/bin/env python3
"""Tests of tools/changed_modules.py."""

import pathlib
import subprocess
import tempfile
import unittest

import changed_modules

MODULES = changed_modules.modules_of("core\nnumerics io\npipeline\n")


class ChangedModules(unittest.TestCase):
    def test_names_the_owners_of_the_files_in_the_order_of_the_layers(self):
        files = ["src/manoscope/pipeline/measure.cpp", "src/manoscope/core/units.hpp",
                 "src/manoscope/core/error.cpp", "src/cli/measure.cpp", "docs/io/page.md",
                 "src/manoscope/README.md"]
        self.assertEqual(changed_modules.changed_modules(MODULES, files), ["core", "pipeline"])
        self.assertEqual(changed_modules.changed_modules(MODULES, []), [])

    def test_names_all_where_nothing_is_known(self):
        self.assertEqual(changed_modules.changed_modules(MODULES, None), MODULES)
        with tempfile.TemporaryDirectory() as folder:
            self.assertIsNone(changed_modules.changed_files(folder, 1))

    def test_asks_the_history(self):
        with tempfile.TemporaryDirectory() as folder:
            def git(*words):
                subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *words],
                               cwd=folder, check=True, capture_output=True)
            git("init")
            for name in ("one", "two", "three"):
                pathlib.Path(folder, name).write_text(name, encoding="utf-8")
                git("add", name)
                git("commit", "-m", name)
            self.assertEqual(changed_modules.changed_files(folder, 1), ["three"])
            self.assertEqual(changed_modules.changed_files(folder, 2), ["three", "two"])
            self.assertIsNone(changed_modules.changed_files(folder, 3))


if __name__ == "__main__":
    unittest.main()
