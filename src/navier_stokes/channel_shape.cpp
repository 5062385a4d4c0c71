#include "channel_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/csv_table.hpp"

namespace manoscope::navier_stokes {
namespace {

/// Derivative at station `at` of the polynomial through stations first .. last.
double slope_of_polynomial(const Array1& x, const Array1& y, Index at, Index first, Index last) {
  double slope = 0.0;
  for (Index j = first; j <= last; ++j) {
    if (j == at) continue;
    double ratio = 1.0;  // of the products in Lagrange's basis polynomial j
    for (Index k = first; k <= last; ++k) {
      if (k != j && k != at) ratio *= (x[at] - x[k]) / (x[j] - x[k]);
    }
    slope += ratio * (y[j] - y[at]) / (x[j] - x[at]);
  }
  return slope;
}

double cell_value(const io::CsvTable& table, const io::CsvRow& row, std::size_t column) {
  const std::string where = fmt::format("{}:{}", table.path.string(), row.line);
  const auto number = table.cell_number(row, column);
  if (!number || !std::isfinite(*number)) {
    throw InputError(where, fmt::format("\"{}\" is no number", row.cells[column]),
                     "Give a finite number, or leave the whole row out");
  }
  return *number;
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
  slope_.resize(n);
  constexpr Index kNeighbours = 5;
  for (Index i = 0; i < n; ++i) {
    const Index count = std::min(kNeighbours, n);
    const Index first = std::clamp<Index>(i - count / 2, 0, n - count);
    slope_[i] = slope_of_polynomial(x_, zeta_, i, first, first + count - 1);
  }
}

double ChannelShape::value(double x) const {
  const double* begin = x_.data();
  const Index above = std::upper_bound(begin, begin + x_.size(), x) - begin;
  const Index i = std::clamp<Index>(above - 1, 0, x_.size() - 2);
  const double step = x_[i + 1] - x_[i];
  const double s = std::clamp((x - x_[i]) / step, 0.0, 1.0);
  const double rest = 1.0 - s;
  return rest * rest * ((1.0 + 2.0 * s) * zeta_[i] + s * step * slope_[i]) +
         s * s * ((3.0 - 2.0 * s) * zeta_[i + 1] - rest * step * slope_[i + 1]);
}

ChannelShape read_channel_shape(const std::filesystem::path& path) {
  const io::CsvTable table = io::read_csv_table(path);
  const auto column = [&](const std::string& name) {
    const auto found = table.column(name);
    const std::string where = fmt::format("{}:{}", path.string(), table.header_line);
    const std::string mend = "Head the columns \"x [mm],zeta [um]\", with any unit of length";
    if (!found) throw InputError(where, fmt::format("there is no column \"{}\"", name), mend);
    const std::string& unit = table.columns[*found].unit;
    const auto scale = unit_scale(unit, "m");
    if (unit.empty() || !scale) {
      throw InputError(where, fmt::format("column \"{}\" has the unit \"{}\"", name, unit), mend);
    }
    Array1 values(static_cast<Index>(table.rows.size()));
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      values[static_cast<Index>(i)] = scale->to_si(cell_value(table, table.rows[i], *found));
    }
    return values;
  };
  return {column("x"), column("zeta")};
}

}  // namespace manoscope::navier_stokes
