// Profiles of stylus instruments as lists of points: Dektak (.csv) and HFM (.hfm).
//
// Source: files of both kinds and SurfaceTopography's description of their heads. HFM: the lines
// "X;Y;valid" and "[mm];[mm];[1/0]", then one point a line; a point that is not valid is missing.
// Dektak: settings as "name,value", a line "Scan Data", a line that names the columns and ends each
// name with its unit ("Lateral um,Raw Micrometer,"), then one point a line.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"

namespace manoscope::io {
namespace {

constexpr std::string_view kHfm = "X;Y;valid", kDektak = "Scan Parameters", kData = "Scan Data";
constexpr const char* kExportAgain = "Export the profile again";

/// The lines of a text, one at a time, with their numbers for messages.
class Lines {
 public:
  Lines(std::string_view text, std::string where) : rest_(text), where_(std::move(where)) {}
  bool next() {
    if (rest_.empty()) return false;
    const auto end = rest_.find('\n');
    line_ = trimmed(rest_.substr(0, end));
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    return true;
  }
  std::string_view line() const { return line_; }
  /// How many points may still come: one a line, of four bytes at least.
  std::size_t n_points_left() const {
    const auto n_lines = static_cast<std::size_t>(std::count(rest_.begin(), rest_.end(), '\n'));
    return std::min(n_lines, rest_.size() / 4) + 1;
  }
  std::string place() const { return fmt::format("{}:{}", where_, number_); }
  const std::string& where() const { return where_; }

 private:
  std::string_view rest_, line_;
  std::string where_;
  int number_ = 0;
};

/// Cuts the text before the separator off a line.
std::string_view next_cell(std::string_view& line, char separator) {
  const auto end = line.find(separator);
  const std::string_view cell = trimmed(line.substr(0, end));
  line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
  return cell;
}

struct Columns {
  char separator = ';';
  bool has_validity = false;
  std::string x_unit, z_unit;
};

Columns read_hfm_head(Lines& lines) {
  lines.next();
  if (!lines.next()) throw InputError(lines.where(), "ends after its first line", kExportAgain);
  std::string_view line = lines.line();
  Columns columns{';', true, {}, {}};
  for (std::string* unit : {&columns.x_unit, &columns.z_unit}) {
    std::string_view cell = next_cell(line, ';');
    if (cell.starts_with('[') && cell.ends_with(']')) cell = cell.substr(1, cell.size() - 2);
    *unit = std::string(cell);
  }
  return columns;
}

Columns read_dektak_head(Lines& lines, Channel& channel) {
  while (lines.next() && lines.line() != kData) {
    std::string_view line = lines.line();
    const std::string_view name = next_cell(line, ',');
    if (channel.settings.size() < 200) add_setting(channel, name, line);
  }
  while (lines.next() && lines.line().empty()) {
  }
  std::string_view line = lines.line();
  Columns columns{',', false, {}, {}};
  for (std::string* unit : {&columns.x_unit, &columns.z_unit}) {
    const std::string_view cell = next_cell(line, ',');
    const auto blank = cell.rfind(' ');
    *unit = std::string(blank == std::string_view::npos ? cell : cell.substr(blank + 1));
  }
  return columns;
}

double metres(const std::string& unit, const Lines& lines) {
  const auto scale = length_scale(unit);
  if (!scale) {
    throw InputError(lines.place(), fmt::format("\"{}\" is no unit of length", excerpt(unit)),
                     kExportAgain);
  }
  return scale->factor;
}

struct Points {
  std::vector<double> x, z;
  double step_of_x = 1.0;  ///< the last digit that positions are written with
};

double last_digit(std::string_view number) {
  const auto point = number.find('.');
  if (point == std::string_view::npos) return 1.0;
  return std::pow(10.0, -static_cast<double>(std::min<std::size_t>(number.size() - point - 1, 20)));
}

Points read_points(Lines& lines, const Columns& columns) {
  Points points;
  points.x.reserve(lines.n_points_left());
  points.z.reserve(lines.n_points_left());
  while (lines.next()) {
    std::string_view line = lines.line();
    if (line.empty()) continue;
    const std::string_view x_text = next_cell(line, columns.separator);
    const auto x = parse_number(x_text);
    const auto z = parse_number(next_cell(line, columns.separator));
    if (!x || !z || !std::isfinite(*x) || std::abs(*x) > 1e15) {
      throw InputError(lines.place(),
                       fmt::format("\"{}\" is not a position and a height", excerpt(lines.line())),
                       kExportAgain);
    }
    const bool valid = !columns.has_validity || next_cell(line, columns.separator) != "0";
    points.step_of_x = std::min(points.step_of_x, last_digit(x_text));
    points.x.push_back(*x);
    points.z.push_back(valid ? *z : std::numeric_limits<double>::quiet_NaN());
  }
  return points;
}

/// The distance of the points, which must be even but for the digits they are written with.
double even_pitch(const Points& points, const std::string& where) {
  const std::size_t n = points.x.size();
  if (n < 2) throw InputError(where, fmt::format("holds {} points", n), kExportAgain);
  const double first = points.x.front();
  const double pitch = (points.x.back() - first) / static_cast<double>(n - 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double due = first + static_cast<double>(i) * pitch;
    if (std::abs(points.x[i] - due) > 1.01 * points.step_of_x) {
      throw InputError(where,
                       fmt::format("its points are not evenly spaced: number {} lies at {} instead "
                                   "of {:.7g}",
                                   i + 1, points.x[i], due),
                       "Resample the profile evenly");
    }
  }
  return pitch;
}

class StylusProfileReader final : public Reader {
 public:
  std::string_view name() const override { return "stylus-profile"; }
  std::string_view description() const override { return "Dektak and HFM profiles"; }
  std::vector<std::string> extensions() const override { return {".csv", ".hfm"}; }
  int score(const Probe& probe) const override {
    if (probe.head.starts_with(kHfm)) return 95;
    return probe.head.starts_with(kDektak) ? 90 : 0;
  }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    const std::string bytes = read_file(path);
    Lines lines(bytes, path.string());
    Channel head;
    const bool is_hfm = bytes.starts_with(kHfm);
    if (!is_hfm && !bytes.starts_with(kDektak)) {
      throw InputError(path.string(), "begins as neither a Dektak nor an HFM profile",
                       kExportAgain);
    }
    const Columns columns = is_hfm ? read_hfm_head(lines) : read_dektak_head(lines, head);
    const double x_scale = metres(columns.x_unit, lines), z_scale = metres(columns.z_unit, lines);
    const Points points = read_points(lines, columns);
    const double pitch = even_pitch(points, path.string());
    Array2 heights(1, static_cast<Index>(points.z.size()));
    std::copy(points.z.begin(), points.z.end(), heights.data());
    std::vector<Channel> channels;
    channels.push_back(make_channel("height", "m", std::move(heights), z_scale, path.string()));
    channels.back().file_unit = columns.z_unit;
    channels.back().settings = std::move(head.settings);
    set_pitch(channels.back(), std::abs(pitch) * x_scale, 0.0, path.string());
    return channels;
  }
};

}  // namespace

const Reader& stylus_profile_reader() {
  static const StylusProfileReader reader;
  return reader;
}

}  // namespace manoscope::io
