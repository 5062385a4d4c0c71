#include "manoscope/report/html_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "manoscope/core/flags.hpp"
#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/html_elements.hpp"
#include "manoscope/report/html_text.hpp"
#include "manoscope/report/number_text.hpp"
#include "manoscope/report/wording.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

std::string with_unit(double value, int digits, DisplayUnit (*unit_for)(double)) {
  const DisplayUnit unit = unit_for(value);
  return number_text(value / unit.si, digits) + " " + unit.name;
}

/// A length as the user gave it.
std::string given(double length) {
  const DisplayUnit unit = length_unit(length);
  return short_number_text(length / unit.si) + " " + unit.name;
}

/// The viscosity, with its standard uncertainty where one is stated.
std::string viscosity_text(const Measurement& m) {
  std::string text = short_number_text(m.viscosity * 1e3) + " mPa s";
  if (!std::isgreater(m.viscosity_uncertainty, 0.0)) return text;
  return text + fmt::format(" (standard uncertainty {} mPa s)",
                            number_text(m.viscosity_uncertainty * 1e3, 2));
}

std::string fact(const std::string& name, const std::string& value) {
  return fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, value);
}

std::string range_text(const Array1& values, DisplayUnit (*unit_for)(double)) {
  double low = 0.0, high = 0.0;
  Index n = 0;
  for (Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values(i))) continue;
    low = n == 0 ? values(i) : std::min(low, values(i));
    high = n == 0 ? values(i) : std::max(high, values(i));
    ++n;
  }
  if (n == 0) return "–";
  const DisplayUnit unit = unit_for(std::max(std::abs(low), std::abs(high)));
  return fmt::format("{} to {} {}", short_number_text(low / unit.si),
                     short_number_text(high / unit.si), unit.name);
}

std::string count(Index n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::string verdict(double en_number) {
  const char* const style = !std::isfinite(en_number) ? "none" : en_number <= 1.0 ? "good" : "bad";
  return fmt::format("<span class=\"{}\">{}</span>", style, resistance_word(en_number));
}

/// Fraction of the stations of the test section that have a pressure; NaN without stations.
double read_fraction(const Measurement& m, Index run) {
  Index n = 0, n_read = 0;
  for (Index ix = 0; ix < m.x.size(); ++ix) {
    const bool inside = std::isgreaterequal(m.x(ix), m.test_section(run, 0)) &&
                        std::islessequal(m.x(ix), m.test_section(run, 1));
    if (!inside) continue;
    ++n;
    n_read += std::isfinite(m.pressure(run, ix)) ? 1 : 0;
  }
  return n == 0 ? std::nan("") : static_cast<double>(n_read) / static_cast<double>(n);
}

/// The station with a pressure that lies nearest the middle of the test section; -1 if none.
Index middle_station(const Measurement& m, Index run) {
  const double middle = 0.5 * (m.test_section(run, 0) + m.test_section(run, 1));
  Index best = -1;
  for (Index ix = 0; std::isfinite(middle) && ix < m.x.size(); ++ix) {
    if (!std::isfinite(m.pressure(run, ix))) continue;
    if (best < 0 || std::abs(m.x(ix) - middle) < std::abs(m.x(best) - middle)) best = ix;
  }
  return best;
}

}  // namespace

std::string facts_list(const Measurement& m) {
  const DisplayUnit gap = length_unit(m.channel_height);
  std::string list = "<dl class=\"facts short\">\n";
  list += fact("Channel",
               fmt::format("{} long, {} wide", given(m.channel_length), given(m.channel_width)));
  list += fact(
      "Gap 2h<sub>0</sub>",
      fmt::format("{} {} (standard uncertainty {} {})", number_text(m.channel_height / gap.si, 5),
                  gap.name, number_text(m.channel_height_uncertainty / gap.si, 2), gap.name));
  list += fact("Fluid", fmt::format("viscosity {}, density {} kg/m³", viscosity_text(m),
                                    short_number_text(m.density)));
  list += fact("Calibration",
               fmt::format("{}, {}", count(m.level_pressure.size(), "pressure", "pressures"),
                           range_text(m.level_pressure, pressure_unit)));
  list += fact("Flow",
               m.run.empty()
                   ? std::string("no runs: calibration only")
                   : fmt::format("{}, {}", count(static_cast<Index>(m.run.size()), "run", "runs"),
                                 range_text(m.flow_rate, flow_rate_unit)));
  if (m.x.size() > 1) {
    const double spacing = (m.x(m.x.size() - 1) - m.x(0)) / static_cast<double>(m.x.size() - 1);
    list += fact("Stations",
                 fmt::format("{}, {} apart", m.x.size(), with_unit(spacing, 3, length_unit)));
  }
  list += fact("Maps", fmt::format("{}", m.map.size()));
  return list + "</dl>\n";
}

std::string reading_list(const Measurement& m) {
  std::string list;
  if (!m.reading.empty() && !m.run.empty()) list += fact("p(x) read", escape_html(m.reading));
  if (!m.tube_law.empty()) list += fact("Tube law", escape_html(m.tube_law));
  return list.empty() ? list : "<dl class=\"facts\">\n" + list + "</dl>\n";
}

std::string runs_table(const Measurement& m) {
  if (m.run.empty()) return {};
  const ReportUnits units = report_units(m);
  const auto drop = [&](double value, double uncertainty) {
    return number_text_with_uncertainty(value / units.drop.si,
                                        kExpansion * uncertainty / units.drop.si);
  };
  std::string body;
  for (std::size_t i = 0; i < m.run.size(); ++i) {
    const auto run = static_cast<Index>(i);
    body += "<tr>" + row_head(m.run[i]) +
            cell(short_number_text(m.flow_rate(run) / units.flow_rate.si)) +
            cell(number_text(m.reynolds(run), 3)) +
            cell(drop(m.extracted_drop(run), m.extracted_drop_uncertainty(run))) +
            cell(drop(m.resistance_drop(run), m.resistance_drop_uncertainty(run))) +
            cell(std::isfinite(m.en_number(run)) ? fmt::format("{:.2f}", m.en_number(run))
                                                 : number_text(m.en_number(run), 2)) +
            cell(verdict(m.en_number(run))) +
            cell(number_text(m.transducer_drop(run) / units.drop.si, 4)) +
            cell(number_text((m.transducer_drop(run) - m.parasitic_drop(run)) / units.drop.si, 4)) +
            cell(number_text(m.channel_resistance_drop(run) / units.drop.si, 4)) +
            cell(fmt::format("{} to {}", short_number_text(m.test_section(run, 0) / units.x.si),
                             short_number_text(m.test_section(run, 1) / units.x.si))) +
            cell(percent_text(read_fraction(m, run))) + "</tr>\n";
  }
  const std::string head =
      column_head("Run") + column_head(fmt::format("<i>Q</i> ({})", units.flow_rate.name)) +
      column_head("Re") + column_head(fmt::format("Δ<i>p</i><sub>e</sub> ({})", units.drop.name)) +
      column_head(fmt::format("<i>QR</i> ({})", units.drop.name)) +
      column_head("<i>E</i><sub>n</sub>") +
      column_head("<i>QR</i> and Δ<i>p</i><sub>e</sub>, eq. (4) as exact") +
      column_head(fmt::format("Transducer ({})", units.drop.name)) +
      column_head(fmt::format("Transducer − parasitic ({})", units.drop.name)) +
      column_head(fmt::format("<i>QR</i>, whole channel ({})", units.drop.name)) +
      column_head(fmt::format("Test section ({})", units.x.name)) + column_head("Read");
  return table(
      fmt::format(
          "Pressure drops over the test section ± expanded uncertainty (k = {:.0f}, about 95 %). "
          "Δp<sub>e</sub>: read off the wall. QR: flow rate times hydraulic resistance of the "
          "measured gap by the paper's eq. (4). {} E<sub>n</sub>: their difference over its "
          "expanded "
          "uncertainty, in which the formula counts as exact and its inlet as known: it leaves out "
          "inertia and developing flow, and “beyond U” (E<sub>n</sub> > 1) may be the formula's. "
          "The "
          "verdict on eq. (4), with its stated error and what is not known of the inlet, is that "
          "of "
          "the table of flow models. "
          "Read: share of the test section's stations where the wall gives an answer.",
          kExpansion, resistance_uncertainty_text(m)),
      head, body);
}

std::string budget_table(const Measurement& m) {
  if (m.run.empty() || m.budget_source.empty()) return {};
  const ReportUnits units = report_units(m);
  std::string head = column_head("Run") + column_head(fmt::format("<i>x</i> ({})", units.x.name)) +
                     column_head("<i>p</i>") + column_head("<i>u</i>(<i>p</i>)");
  for (const std::string& source : m.budget_source) head += column_head(escape_html(source));
  std::string body;
  for (std::size_t i = 0; i < m.run.size(); ++i) {
    const auto run = static_cast<Index>(i);
    const Index ix = middle_station(m, run);
    body += "<tr>" + row_head(m.run[i]);
    if (ix < 0) {
      body += fmt::format("<td colspan=\"{}\">no station of the test section was read</td></tr>\n",
                          m.budget_source.size() + 3);
      continue;
    }
    const double variance = std::pow(m.pressure_uncertainty(run, ix), 2);
    body += cell(number_text(m.x(ix) / units.x.si, 3)) +
            cell(with_unit(m.pressure(run, ix), 4, pressure_unit)) +
            cell(with_unit(m.pressure_uncertainty(run, ix), 2, pressure_unit));
    for (const Array2& source : m.pressure_variance) {
      const double share = variance > 0.0 ? source(run, ix) / variance : std::nan("");
      const double width = std::isfinite(share) ? 100.0 * std::min(std::max(share, 0.0), 1.0) : 0.0;
      body += fmt::format("<td class=\"share\" style=\"--share:{:.1f}%\">{}</td>", width,
                          escape_html(percent_text(share)));
    }
    body += "</tr>\n";
  }
  return table(
      "Standard uncertainty u(p) of the pressure near the middle of the test section, and the "
      "share of each source in its square.",
      head, body);
}

std::string tube_law_table(const Measurement& m) {
  const auto row = [](const std::string& label, double zeta, double a, double b, double u_b,
                      double misfit) {
    const double length = std::isless(b, 0.0) ? std::sqrt(-b / a) : std::nan("");
    return "<tr>" + row_head(label) + cell(number_text(1e6 * zeta, 3)) +
           cell(number_text(1e-6 * a, 3)) +
           cell(number_text_with_uncertainty(b, kExpansion * u_b)) + cell(number_text(misfit, 2)) +
           cell(number_text(std::abs(b) / u_b, 2)) + cell(number_text(1e3 * length, 2)) + "</tr>\n";
  };
  std::string body;
  for (Index r = 0; r < m.tube_law_b.size(); ++r) {
    if (!std::isfinite(m.tube_law_b[r])) continue;
    body += row(m.run[static_cast<std::size_t>(r)], m.tube_law_deflection[r], m.tube_law_a[r],
                m.tube_law_b[r], m.tube_law_b_uncertainty[r], m.tube_law_misfit[r]);
  }
  for (Index k = 0; k < m.tube_law_at_rest_b.size(); ++k) {
    if (!std::isfinite(m.tube_law_at_rest_b[k])) continue;
    body += row(fmt::format("at rest, {}", with_unit(m.level_pressure[k], 4, pressure_unit)),
                m.tube_law_at_rest_deflection[k], m.tube_law_at_rest_a[k], m.tube_law_at_rest_b[k],
                m.tube_law_at_rest_b_uncertainty[k], m.tube_law_at_rest_misfit[k]);
  }
  if (body.empty()) return {};
  return table(
      fmt::format(
          "The tube law <i>p</i> = <i>f</i>(<i>ζ</i>) + <i>b</i> <i>ζ</i>″, <i>a</i> = "
          "<i>f</i>′, about the deflection ζ: does the deflection depend on the pressure there "
          "alone (<i>b</i> = 0)? <i>b</i> ± expanded uncertainty (k = {:.0f}), misfit included: by "
          "how much <i>b</i> differs from place to place. From flow runs: what station-by-station "
          "readings leave near the ends against the momentum balance of the measured gap. At rest: "
          "from the wall's ends at uniform pressure, if the wall is the same along x; of a "
          "stretched "
          "wall that is not the axial tension but nearer to the tension across.",
          kExpansion),
      column_head("State") + column_head("<i>ζ</i> (µm)") + column_head("<i>a</i> (Pa/µm)") +
          column_head("<i>b</i> (N/m)") + column_head("Misfit (N/m)") +
          column_head("|<i>b</i>|/<i>u</i>(<i>b</i>)") + column_head("√(−<i>b</i>/<i>a</i>) (mm)"),
      body, true);
}

std::string maps_table(const Measurement& m) {
  if (m.map.empty()) return {};
  const DisplayUnit noise = length_unit(largest_magnitude(m.map_noise));
  std::string body;
  for (std::size_t i = 0; i < m.map.size(); ++i) {
    const auto map = static_cast<Index>(i);
    body += "<tr>" + row_head(m.map[i]) + cell(number_text(1e3 * m.map_tilt_x(map), 3)) +
            cell(number_text(1e3 * m.map_tilt_z(map), 3)) +
            cell(number_text(m.map_noise(map) / noise.si, 3)) +
            cell(escape_html(percent_text(m.map_missing(map)))) +
            cell(escape_html(percent_text(m.map_spikes(map)))) +
            cell(escape_html(percent_text(m.map_mended(map)))) +
            cell(escape_html(percent_text(m.map_unmended(map)))) +
            cell(number_text(1e6 * m.map_shift(map), 2)) +
            cell(number_text(1e6 * m.map_shift_uncertainty(map), 2)) +
            cell(number_text(1e6 * m.map_shift_across(map), 2)) +
            cell(number_text(1e6 * m.map_shift_across_uncertainty(map), 2)) +
            cell(number_text(m.map_rotation(map) * 180.0 / std::numbers::pi, 2)) +
            cell(number_text(m.map_rotation_uncertainty(map) * 180.0 / std::numbers::pi, 2)) +
            cell(number_text(1e9 * m.map_rim_bend(map), 2)) +
            cell(number_text(1e9 * m.map_rim_bend_uncertainty(map), 1)) + "</tr>\n";
  }
  return table(
      "What each map was like, seen on the rigid rim: slope of its plane along and across the "
      "flow, standard deviation of one pixel; pixels left out, and pixels of a false fringe order, "
      "mended or, where that failed, left out. The shift along the flow that was found at the ends "
      "of the wall and taken back, with its standard uncertainty; shift across and rotation found "
      "at its sides and taken back where they count, with theirs; bend of the rim beyond its "
      "plane, at mid-channel, with its standard "
      "uncertainty.",
      column_head("Map") + column_head("Tilt along (µm/mm)") + column_head("Tilt across (µm/mm)") +
          column_head(fmt::format("Noise ({})", noise.name)) + column_head("Missing") +
          column_head("Spikes") + column_head("Mended") + column_head("Not mended") +
          column_head("Shift (µm)") + column_head("u(shift) (µm)") +
          column_head("Shift across (µm)") + column_head("u(across) (µm)") +
          column_head("Rotation (°)") + column_head("u(rotation) (°)") +
          column_head("Bend of the rim (nm)") + column_head("u(bend) (nm)"),
      body, m.map.size() > 14);
}

std::string flags_table(const Measurement& m) {
  std::string body;
  for (const FlagName& flag : kReadingFlags) {
    Index n = 0;
    for (Index i = 0; i < m.pressure_flags.size(); ++i) {
      n += (m.pressure_flags.data()[i] & flag.bit) != 0 ? 1 : 0;
    }
    const double fraction =
        m.pressure_flags.size() == 0
            ? std::nan("")
            : static_cast<double>(n) / static_cast<double>(m.pressure_flags.size());
    body += "<tr>" + row_head(flag.name) + cell(fmt::format("{}", flag.bit)) +
            fmt::format("<td class=\"words\">{}</td>", flag.meaning) +
            cell((flag.bit & ReadingFlag::no_answer) != 0 ? "none" : "given") +
            cell(fmt::format("{}", n)) + cell(escape_html(percent_text(fraction))) + "</tr>\n";
  }
  return table(
      "Flags of the reading (bits of <code>pressure_flags</code>), counted over all stations of "
      "all runs. A missing pressure is NaN; it is never filled in.",
      column_head("Flag") + column_head("Bit") + "<th scope=\"col\" class=\"words\">Meaning</th>" +
          column_head("Pressure") + column_head("Stations") + column_head("Share"),
      body);
}

}  // namespace manoscope::report
