#include "manoscope/io/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/point_grid.hpp"

namespace manoscope::io {
namespace {

bool is_unit(std::string_view text) {
  const std::string unit = unit_from_file(text);
  return !unit.empty() && is_known_unit(unit);
}

/// True for the name of a column that only counts.
bool is_count_label(std::string_view label) {
  const std::string small = lower_case(trimmed(label));
  constexpr std::array<std::string_view, 6> kNames{"", "#", "index", "no", "no.", "point"};
  return std::find(kNames.begin(), kNames.end(), small) != kNames.end();
}

/// 0, 1, 2 ... or 1, 2, 3 ...
bool counts_rows(const Array2& values) {
  for (Index row = 0; row < values.rows(); ++row) {
    if (values(row, 0) != values(0, 0) + static_cast<double>(row)) return false;
  }
  return values(0, 0) == 0.0 || values(0, 0) == 1.0;
}

NumberView column(const Array2& values, Index which) {
  return {values.data() + which, static_cast<std::size_t>(values.rows()),
          static_cast<std::size_t>(values.cols())};
}

/// 0 where nobody knows the unit of the positions.
Length pitch(double spacing, const std::string& unit, const ReadOptions& options,
             const std::string& where) {
  const std::string used = unit.empty() ? options.lateral_unit : unit;
  if (spacing == 0.0 || used.empty()) return {};
  const auto scale = length_scale(used);
  if (!scale) {
    throw InputError(where, fmt::format("its positions are in {}, no length", excerpt(used)),
                     "Give the positions in a unit of length");
  }
  if (!(std::abs(scale->factor) < 1e30 && std::abs(spacing) < 1e30)) {
    throw InputError(where,
                     fmt::format("has an absurd spacing of {:.3g} {}", spacing, excerpt(used)),
                     "Check the lateral scale");
  }
  return Length::from_si(checked_pitch(scale->factor * std::abs(spacing), "its spacing", where));
}

}  // namespace

std::string unit_of_label(std::string_view label) {
  label = trimmed(label);
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}}) {
    const auto begin = label.rfind(open);
    if (begin != std::string_view::npos && label.ends_with(close)) {
      const std::string_view unit = label.substr(begin + 1, label.size() - begin - 2);
      return is_unit(unit) ? std::string(trimmed(unit)) : std::string();
    }
  }
  const auto blank = label.find_last_of(" \t");
  if (blank == std::string_view::npos) return {};
  const std::string_view last = label.substr(blank + 1);
  return is_unit(last) ? std::string(last) : std::string();
}

Channel channel_of_table(const TextMatrix& matrix, const ReadOptions& options,
                         const std::string& where) {
  const Index n_columns = matrix.values.cols();
  const Index first = n_columns > 2 && !matrix.labels.empty() &&
                              is_count_label(matrix.labels.front()) && counts_rows(matrix.values)
                          ? 1
                          : 0;
  const Index n_used = n_columns - first;
  if (n_used != 2 && n_used != 3) {
    throw InputError(
        where,
        fmt::format("has {} columns and no lateral scale: a list of points or a "
                    "profile, not a map",
                    n_columns),
        "Give the heights as a matrix, one row of pixels a line, or as three columns x, "
        "y and height; if it is a matrix, say so by header lines such as \"# pitch x: "
        "1.5 um\"");
  }
  const auto unit_of = [&](Index which) {
    return matrix.labels.empty()
               ? std::string()
               : unit_of_label(matrix.labels[static_cast<std::size_t>(first + which)]);
  };
  Channel channel;
  channel.name = matrix.header.name;
  if (channel.name.empty() && !matrix.labels.empty()) channel.name = one_line(matrix.labels.back());
  channel.file_unit = unit_of(n_used - 1).empty() ? matrix.header.unit : unit_of(n_used - 1);
  const SiUnit unit = si_unit(channel.file_unit, where);
  channel.unit = unit.name;
  const NumberView x = column(matrix.values, first);
  const NumberView last = column(matrix.values, first + n_used - 1);
  if (n_used == 3) {
    PointGrid grid = grid_of_points(x, column(matrix.values, first + 1), last, where);
    channel.grid.pitch_x = pitch(grid.pitch_x, unit_of(0), options, where);
    channel.grid.pitch_y = pitch(grid.pitch_y, unit_of(1), options, where);
    channel.values = std::move(grid.values);
  } else {
    channel.grid.pitch_x = pitch(even_spacing(x, where), unit_of(0), options, where);
    channel.values = matrix.values.col(first + 1).transpose();
  }
  channel.grid.nx = channel.values.cols();
  channel.grid.ny = channel.values.rows();
  scale_values(channel.values, unit.scale, where);
  return channel;
}

}  // namespace manoscope::io
