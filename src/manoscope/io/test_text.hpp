#pragma once

// For the tests of this folder only: text files of instruments, laid out by hand.

#include <string>

namespace manoscope::io::testing {

/// Zygo's XYZ format 1: a window of 3 x 2 pixels at column 10, row 20 of the camera.
inline std::string zygo_text() {
  return "Zygo XYZ Data File - Format 1\n"
         "0 3 0 0 \"Tue Aug 25 16:59:23 2026\"\n"
         "0 0 3 2 1 255\n"
         "10 20 3 2\n"
         "\"a comment\"\n"
         "\"7\"\n"
         "\"membrane\"\n"
         "0 0.5 6.328e-07 0.5 1 0 5.067e-5 1787677163\n"
         "3 2 0 0 0 666666 0 \"\"\n"
         "0 0 1 33 0 0 0.1 60.4318 2 50\n"
         "0 1 100 0 0 0 0 0 0 0\n"
         "0 \"\"\n"
         "1 5 0\n"
         "#\n"
         "10 20 No Data\n"
         "11\t20\t2.0\n"
         "12   20   3.0\n"
         "10 21 4.0\n"
         "11 21 No Data\n"
         "12 21 -6.5\n"
         "#\n";
}

/// Wyko's ASCII format: 4 columns of 3 rows, 2 um x 2.5 um.
inline std::string wyko_text(int in_nm) {
  return "Wyko ASCII Data File Format 0\t" + std::to_string(in_nm) +
         "\t1\n"
         "X Size\t4\n"
         "Y Size\t3\n"
         "Block Name\tType\tLength\tValue\n"
         "Pixel_size\t7\t4\t0.002\n"
         "Wavelength\t7\t4\t632.8\n"
         "Aspect\t7\t4\t1.25\n"
         "Mult\t7\t4\t2\n"
         "Title\t5\t20\tMy map\n"
         "RAW_DATA\t3\t48\t\n"
         "1\t2\t3\n"
         "4\tBad\t6\n"
         "7\t8\t9\n"
         "10\t11\t12\n";
}

}  // namespace manoscope::io::testing
