#include "manoscope/report/plot_script.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/colour_map.hpp"
#include "manoscope/core/error.hpp"

namespace manoscope::report {
namespace {

std::string hexadecimal(const Rgb& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

}  // namespace

std::string viridis_palette() {
  constexpr int kSteps = 16;  // as many as its table has
  std::string colours;
  for (int i = 0; i <= kSteps; ++i) {
    colours += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i,
                           hexadecimal(viridis(static_cast<double>(i) / kSteps)));
  }
  return "set palette defined (" + colours + ")";
}

std::string ordered_colour(Index index, Index n) {
  constexpr double kEnd = 0.72;  // the palest colours do not show on white
  const double place = n < 2 ? 0.0 : kEnd * static_cast<double>(index) / static_cast<double>(n - 1);
  return hexadecimal(viridis(place));
}

PlotScript& PlotScript::set(const std::string& line) {
  text_ += line + '\n';
  return *this;
}

std::string PlotScript::add_data(std::initializer_list<Array1> columns) {
  std::string rows;
  bool gap = false;
  const Index n = columns.begin()->size();
  for (Index i = 0; i < n; ++i) {
    std::string row;
    bool whole = true;
    for (const Array1& column : columns) {
      MANO_ASSERT(column.size() == n);
      whole = whole && std::isfinite(column(i));
      if (whole) row += (row.empty() ? "" : " ") + plain(column(i));
    }
    if (whole) {
      // One blank line breaks a line; two would begin another data set.
      if (gap && !rows.empty()) rows += '\n';
      rows += row + '\n';
    }
    gap = !whole;
  }
  if (rows.empty()) return {};
  std::string name = fmt::format("$data{}", n_data_++);
  text_ += name + " << END\n" + rows + "END\n";
  return name;
}

std::string PlotScript::add_grid(const Array1& x, const Array1& y, const Array2& values) {
  MANO_ASSERT(values.rows() == y.size() && values.cols() == x.size());
  std::string name = fmt::format("$data{}", n_data_++);
  text_ += name + " << END\n";
  for (Index iy = 0; iy < y.size(); ++iy) {
    for (Index ix = 0; ix < x.size(); ++ix) {
      const double value = values(iy, ix);
      text_ += plain(x[ix]) + ' ' + plain(y[iy]) + ' ' +
               (std::isfinite(value) ? plain(value) : std::string("NaN")) + '\n';
    }
    text_ += '\n';
  }
  text_ += "END\n";
  return name;
}

PlotScript& PlotScript::draw(const std::string& data, const std::string& how) {
  if (!data.empty()) elements_.push_back(data + " " + how);
  return *this;
}

PlotScript& PlotScript::plot() {
  if (elements_.empty()) return *this;
  text_ += fmt::format("plot {}\n", fmt::join(elements_, ", \\\n  "));
  elements_.clear();
  ++n_panels_;
  return *this;
}

Array1 thinned(const Array1& values) {
  constexpr Index kMost = 500;
  const Index step = std::max<Index>((values.size() + kMost - 1) / kMost, 1);
  const Index n = (values.size() + step - 1) / step;
  return Array1::NullaryExpr(n, [&](Index i) { return values(i * step); });
}

std::string logarithmic_axis(const std::string& axis, double low, double high) {
  MANO_ASSERT(low > 0.0 && high > low);
  std::string settings =
      fmt::format("set logscale {0}\nset {0}range [{1}:{2}]\n", axis, plain(low), plain(high));
  const double decades = std::log10(high / low);
  if (decades > 5.0) return settings;
  std::vector<std::string> ticks;
  for (int power = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, power) <= high;
       ++power) {
    for (int mantissa = 1; mantissa < 10; ++mantissa) {
      const double value = mantissa * std::pow(10.0, power);
      const bool labelled = mantissa == 1 || (decades < 2.5 && (mantissa == 2 || mantissa == 5));
      ticks.push_back(labelled ? plain(value) : fmt::format("'' {} 1", plain(value)));
    }
  }
  return settings + fmt::format("set {}tics ({})\n", axis, fmt::join(ticks, ", "));
}

std::string plain(double value) { return fmt::format("{:.6g}", value); }

std::string title(const std::string& words) {
  std::string quoted;
  for (const char letter : words)
    quoted += letter == '\'' ? std::string("''") : std::string(1, letter);
  return "title '" + quoted + "'";
}

}  // namespace manoscope::report
