#include "manoscope/report/page_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "manoscope/core/flags.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/flow_verdict.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;
using Json = nlohmann::ordered_json;

constexpr int kDigits = 6, kDigitsOfBars = 4, kDigitsOfPlaces = 9, kDigitsOfVariances = 3;

/// A number to so many digits; null where there is none.
Json number(double value, int digits = kDigits) {
  if (!std::isfinite(value)) return nullptr;
  const std::string text = fmt::format("{:.{}g}", value, digits);
  double rounded = value;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return rounded;
}

Json list(const Array1& values, int digits = kDigits) {
  Json result = Json::array();
  for (const double value : values) result.push_back(number(value, digits));
  return result;
}

Json row(const Array2& values, Index index, int digits = kDigits) {
  if (index >= values.rows()) return nullptr;
  return list(values.row(index).transpose(), digits);
}

double at(const Array1& values, Index index) {
  return index < values.size() ? values[index] : std::nan("");
}

double at(const Array2& values, Index line, Index column) {
  return line < values.rows() && column < values.cols() ? values(line, column) : std::nan("");
}

Json unit(const DisplayUnit& unit) { return {{"name", unit.name}, {"si", unit.si}}; }

Json units(const Measurement& m) {
  const ReportUnits shown = report_units(m);
  return {{"x", unit(shown.x)},
          {"deflection", unit(shown.deflection)},
          {"pressure", unit(shown.pressure)},
          {"drop", unit(shown.drop)},
          {"flow_rate", unit(shown.flow_rate)}};
}

Json flags() {
  Json list = Json::array();
  for (const FlagName& flag : kReadingFlags) {
    list.push_back({{"bit", flag.bit},
                    {"meaning", flag.meaning},
                    {"answer", (flag.bit & ReadingFlag::no_answer) == 0}});
  }
  return list;
}

Json levels(const Measurement& m) {
  Json deflection = Json::array();
  for (Index k = 0; k < m.static_deflection.rows(); ++k) {
    deflection.push_back(row(m.static_deflection, k));
  }
  return {{"pressure", list(m.level_pressure)},
          {"pressure_uncertainty", list(m.level_pressure_uncertainty)},
          {"deflection", deflection}};
}

Json crossings(const Measurement& m, Index run) {
  Json list = Json::array();
  for (std::size_t i = 0; i < m.crossing_run.size(); ++i) {
    if (m.crossing_run[i] != run) continue;
    const auto c = static_cast<Index>(i);
    list.push_back({number(m.crossing_x[c]), number(m.crossing_pressure[c]),
                    number(m.crossing_x_uncertainty[c])});
  }
  return list;
}

/// Pressure by each flow model that has one, by name.
Json model_pressures(const Measurement& m, Index run) {
  Json models = Json::object();
  for (std::size_t f = 0; f < m.flow_model.size() && f < m.model_pressure.size(); ++f) {
    if (!m.model_pressure[f].row(run).isFinite().any()) continue;
    models[m.flow_model[f]] = row(m.model_pressure[f], run);
  }
  if (!models.contains("paper") && m.resistance_pressure.row(run).isFinite().any()) {
    models["paper"] = row(m.resistance_pressure, run);
  }
  return models;
}

Json budget(const Measurement& m, Index run) {
  Json sources = Json::array();
  for (const Array2& variance : m.pressure_variance) {
    sources.push_back(row(variance, run, kDigitsOfVariances));
  }
  return sources;
}

Json flags_of(const Measurement& m, Index run) {
  Json list = Json::array();
  for (Index ix = 0; ix < m.pressure_flags.cols(); ++ix) {
    list.push_back(static_cast<int>(m.pressure_flags(run, ix)));
  }
  return list;
}

/// A drop and its standard uncertainty.
Json estimate(double value, double uncertainty) {
  return {{"value", number(value)}, {"u", number(uncertainty)}};
}

/// Drops of the section by name: the reading and every model; of the whole channel: the others.
Json drops(const Measurement& m, Index run) {
  Json models = Json::object();
  models["paper"] = estimate(at(m.resistance_drop, run), at(m.resistance_drop_uncertainty, run));
  for (std::size_t f = 0; f < m.flow_model.size(); ++f) {
    const auto model = static_cast<Index>(f);
    if (m.flow_model[f] == "paper") continue;
    models[m.flow_model[f]] =
        estimate(at(m.model_drop, model, run), at(m.model_drop_uncertainty, model, run));
  }
  return {
      {"extracted", estimate(at(m.extracted_drop, run), at(m.extracted_drop_uncertainty, run))},
      {"models", models},
      {"channel_resistance", estimate(at(m.channel_resistance_drop, run), std::nan(""))},
      {"transducer", estimate(at(m.transducer_drop, run), at(m.transducer_drop_uncertainty, run))},
      {"compliant", estimate(at(m.compliant_drop, run), at(m.compliant_drop_uncertainty, run))},
      {"predicted", estimate(at(m.predicted_drop, run), at(m.predicted_drop_uncertainty, run))}};
}

Json runs(const Measurement& m) {
  Json list = Json::array();
  for (std::size_t i = 0; i < m.run.size(); ++i) {
    const auto run = static_cast<Index>(i);
    list.push_back({{"name", m.run[i]},
                    {"flow_rate", number(m.flow_rate(run))},
                    {"flow_rate_uncertainty", number(at(m.flow_rate_uncertainty, run))},
                    {"test_section", row(m.test_section, run)},
                    {"deflection", row(m.deflection, run)},
                    {"pressure", row(m.pressure, run)},
                    {"u", row(m.pressure_uncertainty, run, kDigitsOfBars)},
                    {"lower", row(m.pressure_lower, run)},
                    {"upper", row(m.pressure_upper, run)},
                    {"flags", flags_of(m, run)},
                    {"crossings", crossings(m, run)},
                    {"models", model_pressures(m, run)},
                    {"budget", budget(m, run)},
                    {"drops", drops(m, run)}});
  }
  return list;
}

/// Names, words and the one of the verdict, in the order of the result.
Json models(const Measurement& m) {
  Json list = Json::array();
  const auto add = [&](const std::string& name) {
    list.push_back(
        {{"name", name}, {"words", model_style(name).words}, {"verdict", name == m.verdict_model}});
  };
  if (flow_model_row(m, "paper") < 0) add("paper");
  for (const std::string& name : m.flow_model) add(name);
  return list;
}

/// Counts that all but one cell in a thousand exceed, and that all but one stay below.
std::pair<int, int> usual_range(const Counts2& counts) {
  std::vector<std::int16_t> known;
  for (const std::int16_t count : counts.reshaped()) {
    if (count != MapPicture::kMissing) known.push_back(count);
  }
  if (known.empty()) return {0, 0};
  const auto rank = static_cast<std::ptrdiff_t>(known.size() / 1000);
  const auto low = known.begin() + rank, high = known.end() - 1 - rank;
  std::nth_element(known.begin(), low, known.end());
  const int lowest = *low;
  std::nth_element(known.begin(), high, known.end());
  return {lowest, *high};
}

Json maps(const Measurement& m) {
  if (m.map_picture.empty()) return nullptr;
  const MapPicture& first = m.map_picture.front();
  Json list = Json::array();
  for (std::size_t i = 0; i < m.map_picture.size(); ++i) {
    const int run = i < m.map_run.size() ? m.map_run[i] : -1;
    const auto [low, high] = usual_range(m.map_picture[i].counts);
    list.push_back({{"name", m.map[i]},
                    {"run", run},
                    {"pressure", number(at(m.map_pressure, static_cast<Index>(i)))},
                    {"step", number(m.map_picture[i].step, kDigitsOfPlaces)},
                    {"low", low},
                    {"high", high}});
  }
  const auto axis = [](const Array1& centres) {
    const Index last = centres.size() - 1;
    return Json{{"n", centres.size()},
                {"first", number(centres[0], kDigitsOfPlaces)},
                {"last", number(centres[last], kDigitsOfPlaces)}};
  };
  return {{"x", axis(first.x)}, {"z", axis(first.z)}, {"list", list}};
}

}  // namespace

std::string page_data(const Measurement& m) {
  const Json data = {
      {"title", m.title},
      {"coverage", m.coverage},
      {"expansion", kExpansion},
      {"channel", {{"length", number(m.channel_length)}, {"width", number(m.channel_width)}}},
      {"units", units(m)},
      {"flags", flags()},
      {"x", list(m.x, kDigitsOfPlaces)},
      {"levels", levels(m)},
      {"models", models(m)},
      {"budget_sources", m.budget_source},
      {"runs", runs(m)},
      {"drop_fit",
       {{"linear", number(m.drop_fit_linear)}, {"quadratic", number(m.drop_fit_quadratic)}}},
      {"maps", maps(m)}};
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace manoscope::report
