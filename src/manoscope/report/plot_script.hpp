#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"

namespace manoscope::report {

/// Colours that stay apart for colour-blind eyes (Okabe and Ito 2008), and greys.
inline constexpr const char* kBlack = "#000000";
inline constexpr const char* kBlue = "#0072b2";
inline constexpr const char* kRed = "#c8321e";
inline constexpr const char* kGreen = "#009e73";
inline constexpr const char* kPurple = "#a0508c";
inline constexpr const char* kOrange = "#e69f00";
inline constexpr const char* kSky = "#56b4e9";
inline constexpr const char* kGrey = "#6e6e6e";
inline constexpr const char* kPale = "#b4b4b4";

/// Colour of entry `index` of `n` in the viridis order, from dark violet to green; the palest
/// yellow end, hard to see on white, is left out.
std::string ordered_colour(Index index, Index n);

/// `set palette ...` with the whole of viridis.
std::string viridis_palette();

/// One gnuplot script in the making: settings, data blocks and one `plot` command.
///
/// It holds numbers and our own words only, never a text of the user.
class PlotScript {
 public:
  /// One line of settings.
  PlotScript& set(const std::string& line);
  /// Adds columns of equal length as a data block; a row with a NaN breaks the line there.
  /// @return its name, or "" if no row is whole.
  std::string add_data(std::initializer_list<Array1> columns);
  /// Adds a grid of values as a data block of x, y, value; NaN stays.
  /// @param values  (y.size(), x.size())
  /// @return its name.
  std::string add_grid(const Array1& x, const Array1& y, const Array2& values);
  /// Adds an element to the next plot command, e.g. draw(name, "using 1:2 with lines"); an empty
  /// name draws nothing.
  PlotScript& draw(const std::string& data, const std::string& how);
  /// Ends a panel: writes the plot command with what was drawn so far. Nothing drawn, nothing
  /// written.
  PlotScript& plot();
  /// True if any panel holds something.
  bool has_content() const { return n_panels_ > 0; }
  /// The script without a terminal.
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::vector<std::string> elements_;
  int n_data_ = 0, n_panels_ = 0;
};

/// Every k-th entry, so that at most about 500 are left: more cannot be told apart in a figure.
Array1 thinned(const Array1& values);

/// Settings of a logarithmic axis ("x" or "y") from low to high, 0 < low < high: range, and ticks
/// at 1, 2 and 5 of each decade where there are few decades.
std::string logarithmic_axis(const std::string& axis, double low, double high);

/// A number as gnuplot reads it.
std::string plain(double value);

/// `title '...'` with our own words; quotes are doubled.
std::string title(const std::string& words);

}  // namespace manoscope::report
