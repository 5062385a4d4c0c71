#include "manoscope/twin/truth.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <optional>

#include "manoscope/core/error.hpp"
#include "manoscope/io/csv_table.hpp"
#include "manoscope/twin/truth_netcdf.hpp"

namespace manoscope::twin {
namespace {

constexpr std::string_view kPressurePrefix = "p_Pa_", kDeflectionPrefix = "zeta_um_";

/// One column of numbers, times `scale`.
Array1 read_column(const io::CsvTable& table, std::size_t column, double scale) {
  Array1 values(static_cast<Index>(table.rows.size()));
  for (Index i = 0; i < values.size(); ++i) {
    const io::CsvRow& row = table.rows[static_cast<std::size_t>(i)];
    const std::optional<double> number = table.cell_number(row, column);
    if (!number || !std::isfinite(*number)) {
      throw InputError(
          fmt::format("{}:{}", table.path.string(), row.line),
          fmt::format("column \"{}\" holds \"{}\"", table.columns[column].name, row.cells[column]),
          "Every cell of a truth table is a finite number");
    }
    values(i) = scale * *number;
  }
  return values;
}

std::filesystem::path find_truth(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return path;
  for (const char* name : {"truth/truth.nc", "truth.nc", "truth/truth.csv"}) {
    if (std::filesystem::exists(path / name, ignored)) return path / name;
  }
  return path / "truth.csv";
}

Truth read_table(const std::filesystem::path& path) {
  const io::CsvTable table = io::read_csv_table(path);
  const auto x_column = table.column("x_mm");
  if (!x_column || table.rows.size() < 2) {
    throw InputError(table.path.string(),
                     x_column ? fmt::format("{} row(s) of numbers", table.rows.size())
                              : std::string("no column \"x_mm\""),
                     "A truth table has x_mm, p_Pa_<run> and zeta_um_<run> columns and two rows "
                     "or more");
  }
  Truth truth;
  truth.x = 1e-3 * read_column(table, *x_column, 1.0);
  for (Index i = 1; i < truth.x.size(); ++i) {
    if (truth.x(i) > truth.x(i - 1)) continue;
    throw InputError(
        fmt::format("{}:{}", table.path.string(), table.rows[static_cast<std::size_t>(i)].line),
        "x_mm does not grow", "Sort the rows along the channel and drop duplicates");
  }
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    const std::string& name = table.columns[column].name;
    if (name.rfind(kPressurePrefix, 0) != 0) continue;
    const std::string run = name.substr(kPressurePrefix.size());
    const std::string partner = std::string(kDeflectionPrefix) + run;
    const auto deflection = table.column(partner);
    if (!deflection) {
      throw InputError(table.path.string(),
                       fmt::format("column \"{}\" without \"{}\"", name, partner),
                       "Give both columns for every run");
    }
    truth.runs.push_back(
        {run, read_column(table, column, 1.0), read_column(table, *deflection, 1e-6)});
  }
  if (truth.runs.empty()) {
    throw InputError(table.path.string(), "no column that begins with \"p_Pa_\"",
                     "Give p_Pa_<run> and zeta_um_<run> for at least one run");
  }
  return truth;
}

}  // namespace

std::string truth_csv(const Truth& truth) {
  std::string text = "x_mm";
  for (const RunTruth& run : truth.runs) {
    text += fmt::format(",{}{},{}{}", kPressurePrefix, run.run, kDeflectionPrefix, run.run);
  }
  text += '\n';
  for (Index i = 0; i < truth.x.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{:.5f}", truth.x(i) * 1e3);
    for (const RunTruth& run : truth.runs) {
      fmt::format_to(std::back_inserter(text), ",{:.3f},{:.6f}", run.pressure(i),
                     run.deflection(i) * 1e6);
    }
    text += '\n';
  }
  return text;
}

std::string truth_scalars_csv(const std::vector<RunScalars>& runs, Length height) {
  std::string text =
      "Q_ml_min,p_in_Pa,p_out_Pa,p_max_Pa,dp_compliant_Pa,parasitic_Pa,total_Pa,"
      "transducer_reading_Pa,zeta_max_um,Re_mean,height_um\n";
  for (const RunScalars& run : runs) {
    text += fmt::format(
        "{:.6g},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.1f},{:.4f},{:.1f},{:.4f}\n",
        run.flow_rate.in(mL_per_min), run.inlet.si(), run.outlet.si(), run.maximum.si(),
        run.compliant_drop().si(), run.parasitic.si(), run.total_drop().si(),
        run.transducer_reading.si(), run.largest_deflection.in(um), run.reynolds, height.in(um));
  }
  return text;
}

std::string truth_levels_csv(const std::vector<LevelTruth>& levels) {
  std::string text = "map,true_pressure_Pa,label_Pa\n";
  for (const LevelTruth& level : levels) {
    text += fmt::format("{},{:.6f},{:.1f}\n", level.map, level.pressure.si(), level.label.si());
  }
  return text;
}

std::string truth_static_csv(const Array1& x, const std::vector<LevelTruth>& levels) {
  std::string text = "x_mm";
  for (const LevelTruth& level : levels) {
    text +=
        fmt::format(",{}{}", kDeflectionPrefix, std::filesystem::path(level.map).stem().string());
  }
  text += '\n';
  for (Index i = 0; i < x.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{:.5f}", x(i) * 1e3);
    for (const LevelTruth& level : levels) {
      fmt::format_to(std::back_inserter(text), ",{:.6f}", level.deflection(i) * 1e6);
    }
    text += '\n';
  }
  return text;
}

Truth read_truth(const std::filesystem::path& path) {
  const auto file = find_truth(path);
  return file.extension() == ".nc" ? read_truth_netcdf(file) : read_table(file);
}

}  // namespace manoscope::twin
