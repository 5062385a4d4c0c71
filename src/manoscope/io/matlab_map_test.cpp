// MATLAB files of level 5, as scipy writes them and built by hand.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>

#include "manoscope/core/random.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_matlab.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::io {
namespace {

using testing::big;
using testing::complaint;
using testing::contains;
using testing::little;
using testing::matlab_file;
using testing::TestFolder;

ReadOptions nanometres() {
  ReadOptions options;
  options.height_unit = "nm";
  options.pitch_x = options.pitch_y = 1.0 * um;
  return options;
}

TEST(MatlabMap, BothByteOrdersAndSmallerTypesGiveTheSameMatrix) {
  const TestFolder folder;
  for (const bool order : {false, true}) {
    for (const std::uint32_t type : {9U, 3U}) {  // doubles; doubles stored as 16-bit integers
      const auto path = folder.write("a.mat", matlab_file(order, type));
      EXPECT_EQ(find_reader(path).name(), "matlab");
      const HeightMap map = read_height_map(path, nanometres());
      ASSERT_EQ(map.grid().nx, 3);
      ASSERT_EQ(map.grid().ny, 2);
      EXPECT_NEAR(map.height()(1, 0), 2e-9, 1e-23);
      EXPECT_NEAR(map.height()(0, 1), 3e-9, 1e-23);
      EXPECT_NEAR(map.height()(1, 2), 6e-9, 1e-23);
    }
  }
}

TEST(MatlabMap, WhatDoesNotAddUpIsRefused) {
  const TestFolder folder;
  const auto fault = [&](const std::string& bytes) {
    return complaint([&] { read_channels(folder.write("a.mat", bytes)); });
  };
  EXPECT_TRUE(
      contains(fault(matlab_file(false, 9, 6, 3)), "announces 3 x 3 values of 8 bytes, 48"));
  EXPECT_TRUE(contains(fault(matlab_file(false, 9, 6, 0xffffffffU)), "negative size"));
  EXPECT_TRUE(contains(fault(matlab_file(false, 99)), "unknown type 99"));
  EXPECT_TRUE(contains(fault(matlab_file(false, 9, 4)), "holds no array of numbers"));  // text
  const std::string whole = matlab_file(false);
  for (std::size_t length = 30; length < whole.size(); ++length) {
    EXPECT_NE(fault(whole.substr(0, length)), "") << length;
  }
}

TEST(MatlabMap, FilesOfScipyAreReadWithStructsSeriesAndCompression) {
  const TestFolder folder;
  const std::string python = test_paths::python;
  if (std::system((python + " -c 'import scipy.io' 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "python3-scipy is not installed";
  }
  for (const char* packed : {"True", "False"}) {
    const auto script = folder.write("make.py", std::string(R"(
import sys, numpy as np, scipy.io
z = np.arange(35.).reshape(5, 7)
scipy.io.savemat(sys.argv[1], {
    "name": "a text", "note": 3.0, "cells": np.array([1, "a"], dtype=object),
    "scan": {"height": z.astype("f4"), "x": 0.5 * np.arange(7), "y": 2.0 * np.arange(5)},
    "stack": np.stack([z, z + 100, z + 200], axis=2), "mask": z > 3,
    "wave": z * 1j}, do_compression=)") + packed + ")\n");
    const auto path = folder / "a.mat";
    ASSERT_EQ(std::system((python + " " + script.string() + " " + path.string()).c_str()), 0);
    ReadOptions options;
    options.height_unit = "nm";
    options.lateral_unit = "um";
    options.channel = "height";
    const HeightMap map = read_height_map(path, options);
    EXPECT_EQ(map.grid().nx, 7);
    EXPECT_EQ(map.grid().ny, 5);
    EXPECT_NEAR(map.grid().pitch_x.si(), 0.5e-6, 1e-20);
    EXPECT_NEAR(map.grid().pitch_y.si(), 2e-6, 1e-20);
    EXPECT_NEAR(map.height()(2, 3), 17e-9, 1e-22);
    options = nanometres();
    options.channel = "stack";
    EXPECT_NEAR(read_height_map(path.string() + "#3", options).height()(1, 2), 209e-9, 1e-21);
    options.channel.clear();
    EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }),
                         "#1 \"scan/height\" 7 x 5 [m], #1 \"stack\" 7 x 5 [m]"));
  }
}

/// The elements of a file as one zlib stream each, as save() writes them since version 7.
std::string compressed(const std::string& file) {
  const std::string element = file.substr(128);
  std::string zipped(element.size() + 200, '\0');
  auto n = static_cast<uLongf>(zipped.size());
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(zipped.data()), &n,
                     reinterpret_cast<const Bytef*>(element.data()), element.size()),
            Z_OK);
  zipped.resize(n);
  return file.substr(0, 128) + little(15, 4) + little(n, 4) + zipped;
}

TEST(MatlabMap, ACompressedMatrixIsUnpackedToTheLengthItNames) {
  const TestFolder folder;
  const std::string file = matlab_file(false);
  EXPECT_NEAR(read_height_map(folder.write("a.mat", compressed(file)), nanometres()).height()(1, 2),
              6e-9, 1e-23);
  std::string longer = file, absurd = file;
  longer.replace(132, 4, little(4096, 4));
  absurd.replace(132, 4, little(0xfffffff0U, 4));
  for (const std::string& bytes : {longer, absurd}) {
    EXPECT_TRUE(contains(
        complaint([&] { read_channels(folder.write("b.mat", compressed(bytes))); }), "compressed"));
  }
}

TEST(MatlabMap, DamagedFilesAreReadOrRefused) {
  const TestFolder folder;
  const std::vector<std::string> originals{matlab_file(false), matlab_file(true, 3),
                                           compressed(matlab_file(false))};
  RandomStream random(20261122, "matlab");
  int n_read = 0, n_refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string bytes = originals[static_cast<std::size_t>(i) % originals.size()];
    const Index n_wounds = 1 + random.below(3);
    for (Index wound = 0; wound < n_wounds; ++wound) {
      // Behind the text of the header, which nothing reads.
      const auto at =
          static_cast<std::size_t>(124 + random.below(static_cast<Index>(bytes.size()) - 124));
      bytes[at] = static_cast<char>(random.below(3) == 0 ? 0xff : random.below(256));
    }
    const auto path = folder.write("a.mat", bytes);
    try {
      for (const Channel& channel : read_channels(path)) {
        ASSERT_EQ(channel.values.rows(), channel.grid.ny);
        ASSERT_EQ(channel.values.cols(), channel.grid.nx);
      }
      ++n_read;
    } catch (const InputError&) {
      ++n_refused;
    }
  }
  EXPECT_GT(n_read, 100);
  EXPECT_GT(n_refused, 1000);
}

}  // namespace
}  // namespace manoscope::io
