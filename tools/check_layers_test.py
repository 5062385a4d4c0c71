#!/usr/bin/env python3
"""Tests of check_layers.py on small made-up trees: python3 tools/check_layers_test.py"""

import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
import check_layers
import test_support


class CheckLayers(test_support.Folder):
    def setUp(self):
        super().setUp()
        self.write("layers.txt", "core\nnumerics\nio maps\npipeline\n")
        self.write("src/manoscope/core/units.hpp", "#include <cmath>\n")

    def assert_one_fault(self, *words):
        self.assert_only_fault(check_layers.check(self.root), *words)

    def test_includes_that_point_down_pass(self):
        self.write("src/manoscope/maps/level.hpp", '#include "manoscope/core/units.hpp"\n')
        self.write(
            "src/manoscope/maps/level.cpp",
            '#include "manoscope/maps/level.hpp"\n#  include <manoscope/core/units.hpp>\n',
        )
        self.write("src/cli/main.cpp", '#include "manoscope/maps/level.hpp"\n#include "cli/a.hpp"\n')
        self.write("bench/reduce.cpp", '#include "manoscope/maps/level.hpp"\n')
        self.assertEqual(check_layers.check(self.root), [])

    def test_an_include_that_points_up_is_found_with_its_line(self):
        self.write("src/manoscope/core/grid.hpp", '\n#include "manoscope/maps/level.hpp"\n')
        self.assert_one_fault("src/manoscope/core/grid.hpp:2:", "maps lies above it")

    def test_modules_of_one_layer_do_not_see_each_other(self):
        self.write("src/manoscope/io/gsf.cpp", '#include "manoscope/maps/level.hpp"\n')
        self.assert_one_fault("src/manoscope/io/gsf.cpp:1:", "maps lies beside it")

    def test_test_files_of_a_module_keep_the_rule_too(self):
        self.write("src/manoscope/io/gsf_test.cpp", '#include "manoscope/pipeline/run.hpp"\n')
        self.assert_one_fault("gsf_test.cpp:1:", "pipeline lies above it")

    def test_an_include_in_angle_brackets_counts(self):
        self.write("src/manoscope/core/grid.hpp", "#include <manoscope/io/gsf.hpp>\n")
        self.assert_one_fault("io lies above it")

    def test_the_library_does_not_include_the_command_line(self):
        self.write("src/manoscope/pipeline/run.cpp", '#include "cli/main.hpp"\n')
        self.assert_one_fault("must not include cli/main.hpp")

    def test_a_path_that_climbs_out_of_its_folder_is_refused(self):
        self.write("src/manoscope/core/grid.hpp", '#include "../maps/level.hpp"\n')
        self.assert_one_fault("must not include ../maps/level.hpp")

    def test_a_neighbour_by_its_bare_name_is_refused(self):
        self.write("src/manoscope/core/grid.hpp", '#include "units.hpp"\n')
        self.assert_one_fault('"manoscope/core/..."')

    def test_a_folder_without_a_layer_is_named(self):
        self.write("src/manoscope/optics/lens.hpp", "")
        self.assert_one_fault("src/manoscope/optics", "layers.txt")

    def test_an_include_of_an_unknown_module_is_named(self):
        self.write("src/manoscope/core/grid.hpp", '#include "manoscope/optics/lens.hpp"\n')
        self.write("bench/a.cpp", '#include "manoscope/optics/lens.hpp"\n')
        faults = check_layers.check(self.root)
        self.assertEqual(len(faults), 2, faults)
        for fault in faults:
            self.assertIn("manoscope/optics/lens.hpp", fault)

    def test_a_cycle_of_three_files_is_told_once(self):
        for name, other in (("a", "b"), ("b", "c"), ("c", "a")):
            self.write(
                f"src/manoscope/core/{name}.hpp", f'#include "manoscope/core/{other}.hpp"\n'
            )
        self.assert_one_fault("include cycle", "core/a.hpp", "core/b.hpp", "core/c.hpp")

    def test_two_files_on_one_header_are_no_cycle(self):
        for name in ("a", "b"):
            self.write(
                f"src/manoscope/core/{name}.hpp", '#include "manoscope/core/units.hpp"\n'
            )
        self.assertEqual(check_layers.check(self.root), [])

    def test_includes_inside_comments_do_not_count(self):
        self.write(
            "src/manoscope/core/grid.hpp",
            '// #include "manoscope/io/gsf.hpp"\n/*\n#include "manoscope/io/gsf.hpp"\n*/\n',
        )
        self.assertEqual(check_layers.check(self.root), [])

    def test_a_module_named_twice_is_an_error(self):
        self.write("layers.txt", "core\nio core\n")
        with self.assertRaises(ValueError):
            check_layers.check(self.root)

    def test_the_exit_code_tells_held_broken_and_nothing_to_check(self):
        self.assertEqual(check_layers.main([str(self.root)]), 0)
        self.assertEqual(check_layers.main([str(self.root / "src")]), 2)
        self.write("src/manoscope/core/grid.hpp", '#include "manoscope/io/gsf.hpp"\n')
        self.assertEqual(check_layers.main([str(self.root)]), 1)


if __name__ == "__main__":
    unittest.main()
