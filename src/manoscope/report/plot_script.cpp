#include "manoscope/report/plot_script.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::report {

std::string ordered_colour(Index index, Index n) {
  // viridis at 0, 1/8, ... 1
  constexpr std::array<std::array<int, 3>, 9> kViridis{{{68, 1, 84},
                                                        {71, 45, 123},
                                                        {59, 82, 139},
                                                        {44, 114, 142},
                                                        {33, 145, 140},
                                                        {40, 174, 128},
                                                        {94, 201, 98},
                                                        {173, 220, 48},
                                                        {253, 231, 37}}};
  constexpr double kEnd = 0.72;
  const double place =
      n < 2 ? 0.0 : 8.0 * kEnd * static_cast<double>(index) / static_cast<double>(n - 1);
  const auto low = std::min<std::size_t>(static_cast<std::size_t>(place), 7);
  const double t = place - static_cast<double>(low);
  std::string colour = "#";
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = (1.0 - t) * kViridis[low][c] + t * kViridis[low + 1][c];
    colour += fmt::format("{:02x}", static_cast<int>(std::lround(value)));
  }
  return colour;
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
