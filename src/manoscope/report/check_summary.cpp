#include "manoscope/report/check_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace manoscope::report {
namespace {

using results::Measurement;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<Index>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of p(x) at all stations of all runs, without runs of the labels; NaN where nobody knows.
double usual_uncertainty(const Measurement& m) {
  std::vector<double> known;
  const auto add = [&](double u) {
    if (std::isgreater(u, 0.0)) known.push_back(u);
  };
  for (Index i = 0; i < m.pressure_uncertainty.size(); ++i) add(m.pressure_uncertainty.data()[i]);
  if (known.empty())
    std::for_each(m.level_pressure_uncertainty.begin(), m.level_pressure_uncertainty.end(), add);
  return known.empty() ? std::nan("") : median(std::move(known));
}

std::string count(Index n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::string left_out_line(const Measurement& m) {
  const LeftOutSummary all = summarise_left_out(m);
  if (all.n == 0) return {};
  std::string text = fmt::format("Leaving one level out: rms {:.2g} Pa over {}", all.rms,
                                 count(all.n, "level", "levels"));
  if (std::isfinite(all.pull)) {
    text += fmt::format(", pulls {:.2g} (1 where bars are true)", all.pull);
  }
  constexpr double kWide = 3.0;
  const double label = m.level_pressure[all.worst];
  if (std::isgreater(std::abs(all.worst_pull), kWide)) {
    text += fmt::format(
        "; most of all {:.4g} Pa, by {:+.2g} Pa, {:.1f} of its bars: a wrong label, or a wall that "
        "turns between its neighbours",
        label, all.worst_error, std::abs(all.worst_pull));
  }
  return text + ".";
}

std::string shape_line(const Measurement& m) {
  const ShapeSummary all = summarise_shapes(m);
  if (all.n == 0) return {};
  std::string text = fmt::format(
      "Cross-sections of the wall against the calibrated ones: chi-square {:.2f} per degree of "
      "freedom in the median of {}; ",
      all.median, count(all.n, "map", "maps"));
  if (all.unlike.empty()) return text + "none stands out.";
  const Index worst = all.unlike.front();
  text += count(static_cast<Index>(all.unlike.size()), "stands", "stand") + " out, ";
  const double shift = m.shape_reading_shift[worst];
  if (all.n_matter == 0) {
    return text + fmt::format("none by as much as the bars of p(x) ({:.2g} Pa).", shift);
  }
  return text + fmt::format(
                    "{} by more than the bars of p(x), most of all {} ({:.1f}): up to "
                    "{:.2g} Pa at x = {:.2f} to {:.2f} mm.",
                    all.n_matter, m.map[static_cast<std::size_t>(worst)],
                    m.shape_reduced_chi_square[worst], shift, m.shape_worst(worst, 0) * 1e3,
                    m.shape_worst(worst, 1) * 1e3);
}

std::string repeat_line(const Measurement& m) {
  const RepeatSummary all = summarise_repeats(m);
  if (all.n == 0) return {};
  Index n_apart = 0;
  for (const double chance : m.repeat_p_value) n_apart += std::isless(chance, 1e-3) ? 1 : 0;
  std::string text =
      fmt::format("Repeats: {} of {}, chi-square {:.2g} per degree of freedom ({:.0f}): ",
                  count(all.n_maps, "map", "maps"), count(all.n, "state", "states"),
                  all.chi_square / all.dof, all.dof);
  if (n_apart == 0) return text + "they agree within their bars.";
  return text + fmt::format("{} by more than the bars.",
                            count(n_apart, "state scatters", "states scatter"));
}

std::string sweep_line(const Measurement& m) {
  if (!std::isfinite(m.sweep_difference)) return {};
  return fmt::format(
      "Up and down: {:.0f} maps on the way down differ from the way up by {:+.1f} ± {:.1f} Pa, "
      "{:.1f} of its bar.",
      m.sweep_down_maps, m.sweep_difference, m.sweep_difference_uncertainty,
      std::abs(m.sweep_difference) / m.sweep_difference_uncertainty);
}

}  // namespace

LeftOutSummary summarise_left_out(const Measurement& m) {
  LeftOutSummary all;
  double squares = 0.0, pulls = 0.0, n_pulls = 0.0;
  for (Index k = 0; k < m.left_out_mean_error.size(); ++k) {
    const double error = m.left_out_mean_error[k], u = m.left_out_mean_uncertainty[k];
    if (!std::isfinite(error)) continue;
    const double pull = u > 0.0 ? error / u : std::nan("");
    const bool worse = all.worst < 0 || std::isgreater(std::abs(pull), std::abs(all.worst_pull)) ||
                       (!(u > 0.0) && std::abs(error) > std::abs(all.worst_error));
    if (worse) {
      all.worst = k;
      all.worst_error = error;
      all.worst_pull = pull;
    }
    squares += error * error;
    all.n += 1;
    if (!(u > 0.0)) continue;
    pulls += pull * pull;
    n_pulls += 1.0;
  }
  all.rms = all.n > 0 ? std::sqrt(squares / static_cast<double>(all.n)) : std::nan("");
  all.pull = n_pulls > 0.0 ? std::sqrt(pulls / n_pulls) : std::nan("");
  return all;
}

ShapeSummary summarise_shapes(const Measurement& m) {
  constexpr double kChance = 1e-4;
  ShapeSummary all;
  std::vector<double> ratios;
  for (Index i = 0; i < m.shape_p_value.size(); ++i) {
    if (!std::isfinite(m.shape_p_value[i])) continue;
    ratios.push_back(m.shape_reduced_chi_square[i]);
    if (m.shape_p_value[i] < kChance) all.unlike.push_back(i);
  }
  all.n = static_cast<Index>(ratios.size());
  if (ratios.empty()) return all;
  all.median = median(std::move(ratios));
  std::stable_sort(all.unlike.begin(), all.unlike.end(), [&](Index a, Index b) {
    return std::isgreater(m.shape_reading_shift[a], m.shape_reading_shift[b]);
  });
  const double usual = usual_uncertainty(m);
  all.n_matter = std::count_if(all.unlike.begin(), all.unlike.end(), [&](Index map) {
    return m.shape_reading_shift[map] > 0.0 && !std::islessequal(m.shape_reading_shift[map], usual);
  });
  return all;
}

RepeatSummary summarise_repeats(const Measurement& m) {
  RepeatSummary all;
  all.n = static_cast<Index>(m.repeat.size());
  for (Index i = 0; i < all.n; ++i) {
    all.n_maps += m.repeat_maps[static_cast<std::size_t>(i)];
    all.chi_square += m.repeat_chi_square[i];
    all.dof += m.repeat_dof[i];
  }
  return all;
}

std::vector<std::string> check_lines(const Measurement& m) {
  std::vector<std::string> lines;
  for (std::string line : {left_out_line(m), shape_line(m), repeat_line(m), sweep_line(m)}) {
    if (!line.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace manoscope::report
