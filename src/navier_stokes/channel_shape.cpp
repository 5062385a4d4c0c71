#include "channel_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/csv_table.hpp"

namespace manoscope::navier_stokes {
namespace {

double cell_value(const io::CsvTable& table, const io::CsvRow& row, std::size_t column) {
  const std::string where = fmt::format("{}:{}", table.path.string(), row.line);
  const auto number = table.cell_number(row, column);
  if (!number || !std::isfinite(*number)) {
    throw InputError(where, fmt::format("\"{}\" is no number", row.cells[column]),
                     "Give a finite number, or leave the whole row out");
  }
  return *number;
}

/// Different values in order; those nearer to each other than round-off of their text count as one.
Array1 distinct(const Array1& values) {
  constexpr double kRoundOff = 1e-9;  // of the largest
  const double same = kRoundOff * values.abs().maxCoeff();
  std::vector<double> sorted(values.begin(), values.end()), kept;
  std::sort(sorted.begin(), sorted.end());
  for (const double value : sorted) {
    if (kept.empty() || value - kept.back() > same) kept.push_back(value);
  }
  return Eigen::Map<const Array1>(kept.data(), static_cast<Index>(kept.size()));
}

/// Index of the entry of ascending `kept` that is nearest to a value.
Index place_of(const Array1& kept, double value) {
  const Index above = std::lower_bound(kept.begin(), kept.end(), value) - kept.begin();
  if (above == 0) return 0;
  if (above == kept.size()) return above - 1;
  return value - kept[above - 1] < kept[above] - value ? above - 1 : above;
}

/// Rows (x, z, zeta) in any order as a grid.
ShapeTable on_grid(const std::filesystem::path& path, const Array1& x, const Array1& z,
                   const Array1& zeta) {
  if (zeta.size() == 0) throw InputError(path.string(), "there is no row", "Give the map's rows");
  ShapeTable map{distinct(x), distinct(z), {}};
  const Index n_x = map.x.size(), n_z = map.z.size();
  const auto at = [&](Index i, Index k) {
    return fmt::format("at x = {:.6g} mm, z = {:.6g} mm", map.x[i] * 1e3, map.z[k] * 1e3);
  };
  const char* const mend = "Give one row for every x at every z: a whole grid without holes";
  // A table of scattered points would make a grid of their square.
  if (n_x * n_z > 4 * zeta.size()) {
    throw InputError(path.string(),
                     fmt::format("{} rows are no grid of {} different x by {} different z",
                                 zeta.size(), n_x, n_z),
                     mend);
  }
  map.zeta = Array2::Zero(n_x, n_z);
  Flags2 seen = Flags2::Zero(n_x, n_z);
  for (Index row = 0; row < zeta.size(); ++row) {
    const Index i = place_of(map.x, x[row]), k = place_of(map.z, z[row]);
    if (seen(i, k) != 0) throw InputError(path.string(), "there are two rows " + at(i, k), mend);
    seen(i, k) = 1;
    map.zeta(i, k) = zeta[row];
  }
  for (Index i = 0; i < n_x; ++i) {
    for (Index k = 0; k < n_z; ++k) {
      if (seen(i, k) == 0) throw InputError(path.string(), "there is no row " + at(i, k), mend);
    }
  }
  return map;
}

}  // namespace

ChannelShape::ChannelShape(Array1 x, Array1 zeta) : x_(std::move(x)), zeta_(std::move(zeta)) {
  const Index n = x_.size();
  if (n < 2 || zeta_.size() != n) {
    throw InputError("channel shape", fmt::format("{} stations, {} deflections", n, zeta_.size()),
                     "Give a deflection at each of two stations or more");
  }
  for (Index i = 0; i < n; ++i) {
    if (std::isfinite(x_[i]) && std::isfinite(zeta_[i]) && (i == 0 || x_[i] > x_[i - 1])) continue;
    throw InputError(
        "channel shape",
        fmt::format("station {} at x = {:.6g} m, zeta = {:.6g} m", i + 1, x_[i], zeta_[i]),
        "Stations must be finite and ascend along x");
  }
}

ShapeTable read_shape_table(const std::filesystem::path& path) {
  const io::CsvTable table = io::read_csv_table(path);
  const std::string where = fmt::format("{}:{}", path.string(), table.header_line);
  const char* const mend =
      "Head the columns \"x [mm],zeta [um]\", of a map \"x [mm],z [mm],zeta [um]\", with any unit "
      "of length";
  const auto column = [&](std::size_t found) {
    const io::CsvColumn& head = table.columns[found];
    const auto scale = unit_scale(head.unit, "m");
    if (head.unit.empty() || !scale) {
      throw InputError(
          where, fmt::format("column \"{}\" has the unit \"{}\"", head.name, head.unit), mend);
    }
    Array1 values(static_cast<Index>(table.rows.size()));
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      values[static_cast<Index>(i)] = scale->to_si(cell_value(table, table.rows[i], found));
    }
    return values;
  };
  const auto required = [&](const char* name) {
    const auto found = table.column(name);
    if (!found) throw InputError(where, fmt::format("there is no column \"{}\"", name), mend);
    return column(*found);
  };
  Array1 x = required("x"), zeta = required("zeta");
  if (const auto across = table.column("z")) return on_grid(path, x, column(*across), zeta);
  ShapeTable profile{std::move(x), {}, Array2(zeta.size(), 1)};
  profile.zeta.col(0) = zeta;
  return profile;
}

}  // namespace manoscope::navier_stokes
