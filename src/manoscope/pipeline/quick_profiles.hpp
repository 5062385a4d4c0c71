#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "manoscope/core/frame.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/io/float_rows.hpp"
#include "manoscope/maps/linear_reduction.hpp"

namespace manoscope::pipeline {

struct QuickProfilesOptions {
  maps::LinearReductionOptions reduction;
  /// The files are raw floats of this layout; else maps of any known format.
  std::optional<io::RawFloats> raw;
};

/// zeta(x) of many maps of one camera by LinearPass, for frames by the thousand and for a quick
/// look: a map of 32-bit floats (.gsf, raw) is read and summed piece by piece and never held as a
/// whole; any other, or a channel that lies askew in the map, is read and turned first, its heights
/// rounded to 32-bit floats (by up to 6e-8 of themselves).
///
/// Results are in the order of the files and have the same bytes on any number of threads.
/// @param n_threads  0 = all the machine has
/// @throws InputError naming the file at fault, or whose grid is not that of the first.
std::vector<maps::LinearReduction> quick_profiles(const std::vector<std::filesystem::path>& files,
                                                  const ChannelFrame& frame,
                                                  const QuickProfilesOptions& options = {},
                                                  int n_threads = 0, const Monitor& monitor = {});

}  // namespace manoscope::pipeline
