#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// A figure as it is to be drawn.
struct Figure {
  std::string name;               ///< file name without extension: "fig1d_static_profiles"
  std::string title;              ///< in a few words
  std::string caption;            ///< what is seen, in sentences; plain text
  int width = 640, height = 440;  ///< px at 96 per inch
  std::string script;             ///< gnuplot commands without a terminal
};

// Each returns nullopt where the measurement holds nothing to show.

/// The channel's rectangle over what the wall did between the lowest and the highest pressure.
std::optional<Figure> channel_place(const results::Measurement& measurement);
/// Fig. 1(d) of Ozsun et al. (2013): static profiles zeta(x) at each pressure.
std::optional<Figure> static_profiles(const results::Measurement& measurement);
/// Fig. 1(e), (f): crest deflection against pressure.
std::optional<Figure> crest_deflection(const results::Measurement& measurement);
/// Fig. 2(a): pressure drop against flow rate.
std::optional<Figure> pressure_drop(const results::Measurement& measurement);
/// Fig. 2(b): deflection under flow.
std::optional<Figure> flow_profiles(const results::Measurement& measurement);
/// Fig. 3(a): flow profiles over static profiles, with their crossings.
std::optional<Figure> profiles_overlaid(const results::Measurement& measurement);
/// Fig. 3(b) or (c): pressure along the channel at the lowest or highest flow rate, and flow models
/// against it.
std::optional<Figure> pressure_at_lowest_flow(const results::Measurement& measurement);
std::optional<Figure> pressure_at_highest_flow(const results::Measurement& measurement);
/// Pressure along the channel, all runs.
std::optional<Figure> pressure_of_all_runs(const results::Measurement& measurement);
/// Fig. 4: Q R and the drop by the verdict's model against the extracted drop, and the difference
/// in percent.
std::optional<Figure> drop_agreement(const results::Measurement& measurement);

/// What each physical effect adds to the drop by eq. (4), and what the reading asks for.
std::optional<Figure> flow_corrections(const results::Measurement& measurement);
/// Wall shear and local Reynolds number along the channel.
std::optional<Figure> wall_shear(const results::Measurement& measurement);

/// Levels read on the curves of the others: error against pressure, and along the channel.
std::optional<Figure> levels_left_out(const results::Measurement& measurement);
/// Cross-sections of every map against the calibrated shapes.
std::optional<Figure> cross_sections(const results::Measurement& measurement);
/// The map whose cross-sections stand out most, if one does.
std::optional<Figure> worst_cross_section(const results::Measurement& measurement);

/// All that the measurement has data for, in the order of the report.
std::vector<Figure> figures(const results::Measurement& measurement);

/// A figure drawn.
struct DrawnFigure {
  std::string svg;  ///< a whole SVG document; the title is that of the figure
  std::string pdf;  ///< empty unless asked for, or where gnuplot has no PDF terminal
};

/// Draws a figure.
/// @return nullopt where gnuplot is not installed.
/// @throws InternalError if gnuplot does not accept the script.
std::optional<DrawnFigure> draw(const Figure& figure, bool pdf);

/// The SVG document as an element to stand in an HTML page: no prolog, identifiers of its own.
std::string inline_svg(const std::string& svg, const std::string& name);

}  // namespace manoscope::report
