#include "summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "manoscope/core/uncertainty.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

/// "12287 ± 21 Pa" with an expanded uncertainty of two digits, or a dash.
std::string drop_text(double value, double standard_uncertainty) {
  if (!std::isfinite(value)) return "-";
  if (!(standard_uncertainty > 0.0)) return fmt::format("{:.0f}", value);
  const double expanded = kExpansion * standard_uncertainty;
  const int digits = std::max(0, 1 - static_cast<int>(std::floor(std::log10(expanded))));
  return fmt::format("{:.{}f} ± {:.{}f}", value, digits, expanded, digits);
}

/// Pads to a width counted in characters on the screen, not bytes.
std::string pad(const std::string& text, std::size_t width) {
  std::size_t shown = 0;
  for (const char byte : text) shown += (static_cast<unsigned char>(byte) & 0xC0) != 0x80;
  return (shown < width ? std::string(width - shown, ' ') : std::string()) + text;
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      std::size_t shown = 0;
      for (const char byte : row[c]) shown += (static_cast<unsigned char>(byte) & 0xC0) != 0x80;
      widths[c] = std::max(widths[c], shown);
    }
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) text += pad(row[c], widths[c] + (c > 0 ? 2 : 0));
    text += '\n';
  }
  return text;
}

}  // namespace

std::string summary_text(const results::Measurement& m) {
  constexpr double kMlPerMin = 60e6;
  std::vector<std::vector<std::string>> rows{
      {"run", "Q [mL/min]", "Re", "section [mm]", "dp_e ± U [Pa]", "QR ± U [Pa]", "E_n"}};
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const double start = m.test_section(r, 0), end = m.test_section(r, 1);
    rows.push_back(
        {m.run[static_cast<std::size_t>(r)], fmt::format("{:.4g}", m.flow_rate[r] * kMlPerMin),
         fmt::format("{:.0f}", m.reynolds[r]),
         std::isfinite(start) ? fmt::format("{:.2f}-{:.2f}", start * 1e3, end * 1e3)
                              : std::string("none"),
         drop_text(m.extracted_drop[r], m.extracted_drop_uncertainty[r]),
         drop_text(m.resistance_drop[r], m.resistance_drop_uncertainty[r]),
         std::isfinite(m.en_number[r]) ? fmt::format("{:.2f}", m.en_number[r]) : std::string("-")});
  }
  std::string text;
  if (m.flow_rate.size() > 0) {
    text += table(rows);
    text +=
        "U: expanded uncertainty, k = 2. dp_e: drop read off the wall over the section. QR: the "
        "paper's eq. (4),\nno inertia or entry flow; its U takes flow rate and viscosity as "
        "exact.\n";
  } else {
    text +=
        fmt::format("calibration only: {} levels, no map under flow\n", m.level_pressure.size());
  }
  return text;
}

std::string pressure_text(const results::Measurement& m) {
  constexpr int kRows = 13;
  std::vector<std::vector<std::string>> rows{{"x [mm]"}};
  for (const std::string& run : m.run) rows.front().push_back("p(x) " + run + " [Pa]");
  for (int i = 0; i < kRows; ++i) {
    const double x = m.channel_length * (i + 0.5) / kRows;
    Index nearest = 0;
    (m.x - x).abs().minCoeff(&nearest);
    std::vector<std::string> row{fmt::format("{:.2f}", m.x[nearest] * 1e3)};
    for (Index r = 0; r < m.flow_rate.size(); ++r) {
      row.push_back(drop_text(m.pressure(r, nearest), m.pressure_uncertainty(r, nearest)));
    }
    rows.push_back(std::move(row));
  }
  return table(rows);
}

std::string summary_json(const results::Measurement& m, const std::filesystem::path& folder) {
  json runs = json::array();
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    runs.push_back({{"run", m.run[static_cast<std::size_t>(r)]},
                    {"flow_rate_m3_s", m.flow_rate[r]},
                    {"reynolds", number(m.reynolds[r])},
                    {"x_start_m", number(m.test_section(r, 0))},
                    {"x_end_m", number(m.test_section(r, 1))},
                    {"extracted_drop_Pa", number(m.extracted_drop[r])},
                    {"extracted_drop_uncertainty_Pa", number(m.extracted_drop_uncertainty[r])},
                    {"resistance_drop_Pa", number(m.resistance_drop[r])},
                    {"resistance_drop_uncertainty_Pa", number(m.resistance_drop_uncertainty[r])},
                    {"transducer_drop_Pa", number(m.transducer_drop[r])},
                    {"parasitic_drop_Pa", number(m.parasitic_drop[r])},
                    {"en_number", number(m.en_number[r])}});
  }
  return json{{"output", folder.string()}, {"runs", runs}, {"warnings", m.warnings}}.dump(2) + "\n";
}

std::string judgement_text(const std::vector<pipeline::RunJudgement>& judgements) {
  std::vector<std::vector<std::string>> rows{
      {"run", "section [mm]", "rms error [Pa]", "largest [Pa]", "no answer", "in 95 % bars",
       "pull mean", "pull width", "true drop [Pa]", "drop error [Pa]"}};
  for (const pipeline::RunJudgement& j : judgements) {
    const auto total = j.reading.n_answered + j.reading.n_silent;
    rows.push_back({j.run, fmt::format("{:.2f}-{:.2f}", j.x_start * 1e3, j.x_end * 1e3),
                    fmt::format("{:.1f}", j.reading.rms), fmt::format("{:.1f}", j.reading.largest),
                    fmt::format("{}/{}", j.reading.n_silent, total),
                    fmt::format("{:.0f} %", 100.0 * j.reading.coverage),
                    fmt::format("{:+.2f}", j.reading.pull_mean),
                    fmt::format("{:.2f}", j.reading.pull_width), fmt::format("{:.0f}", j.true_drop),
                    fmt::format("{:+.1f}", j.drop_error)});
  }
  return table(rows);
}

std::string judgement_json(const std::vector<pipeline::RunJudgement>& judgements) {
  json runs = json::array();
  for (const pipeline::RunJudgement& j : judgements) {
    runs.push_back({{"run", j.run},
                    {"x_start_m", number(j.x_start)},
                    {"x_end_m", number(j.x_end)},
                    {"answered", j.reading.n_answered},
                    {"silent", j.reading.n_silent},
                    {"rms_error_Pa", j.reading.rms},
                    {"largest_error_Pa", j.reading.largest},
                    {"mean_error_Pa", j.reading.mean},
                    {"coverage", j.reading.coverage},
                    {"pull_mean", j.reading.pull_mean},
                    {"pull_width", j.reading.pull_width},
                    {"true_drop_Pa", j.true_drop},
                    {"drop_error_Pa", j.drop_error},
                    {"drop_pull", j.drop_pull}});
  }
  return json{{"runs", runs}}.dump(2) + "\n";
}

}  // namespace manoscope::cli
