// Maps in NetCDF: the program's own (NetCDF-4, CF attributes), and others of the same layout.
//
// A map is a numeric variable over two dimensions. The dimension named x counts along the rows and
// the one named y down the columns; under other names the first counts down. A dimension before
// these two counts the frames of a series. The scale comes from the coordinate variables, which
// hold pixel centres in any unit of length.
#include <netcdf.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <utility>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/even_axis.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/hdf5_formats.hpp"
#include "manoscope/io/hdf5_worker.hpp"
#include "manoscope/io/netcdf_classic.hpp"
#include "manoscope/io/netcdf_handle.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {
namespace {

using Variable = NetcdfFile::Variable;

/// "units" as CF has it; some writers say "unit".
std::string unit_of(const NetcdfFile& file, const Variable& variable) {
  for (const char* name : {"units", "unit"}) {
    if (const auto text = file.text_attribute(variable.id, name)) return *text;
  }
  return {};
}

/// The value that marks a missing sample, as stored.
double fill_value(const NetcdfFile& file, const Variable& variable) {
  for (const char* name : {"_FillValue", "missing_value"}) {
    if (const auto value = file.number_attribute(variable.id, name)) return *value;
  }
  nc_type type = NC_NAT;
  file.check(nc_inq_vartype(file.id(), variable.id, &type), variable.name);
  switch (type) {
    case NC_SHORT:
      return NC_FILL_SHORT;
    case NC_INT:
      return NC_FILL_INT;
    case NC_FLOAT:
      return NC_FILL_FLOAT;
    case NC_USHORT:
      return NC_FILL_USHORT;
    case NC_UINT:
      return NC_FILL_UINT;
    default:
      return NC_FILL_DOUBLE;
  }
}

class MapFile {
 public:
  explicit MapFile(const std::filesystem::path& path)
      : where_(path.string()), file_(NetcdfFile::open(path)) {}

  std::vector<Channel> channels(const ReadOptions& options) const {
    std::vector<Variable> maps;
    for (const Variable& variable : file_.variables()) {
      if (is_map(variable)) maps.push_back(variable);
    }
    if (maps.empty()) {
      throw InputError(where_, "holds no map: no variable of numbers over two length coordinates",
                       "Store the heights as height(y, x) with coordinate variables y and x");
    }
    // Numbered before one is chosen: as `inspect` numbers them.
    const bool any_series = std::any_of(maps.begin(), maps.end(), is_series);
    std::vector<int> numbers(maps.size());
    std::iota(numbers.begin(), numbers.end(), 1);
    for (std::size_t i = 0; i < maps.size(); ++i) {
      if (maps[i].name != options.channel) continue;
      maps = {maps[i]};
      numbers = {numbers[i]};
    }
    check_together(maps, options);
    std::vector<Channel> found;
    for (std::size_t i = 0; i < maps.size(); ++i) {
      const std::size_t n_frames = is_series(maps[i]) ? maps[i].shape[0] : 1;
      for (std::size_t frame = 0; frame < n_frames; ++frame) {
        if (options.page != 0 && any_series) frame = static_cast<std::size_t>(options.page) - 1;
        if (frame >= n_frames) break;
        const int page = any_series ? static_cast<int>(frame) + 1 : numbers[i];
        if (options.page == 0 || options.page == page) {
          found.push_back(channel(maps[i], frame));
          found.back().page = page;
        }
        if (options.page != 0) break;
      }
    }
    if (found.empty()) {
      throw InputError(where_, fmt::format("has no page {}; it has {}", options.page, told(maps)),
                       "Name a page that is there");
    }
    return found;
  }

 private:
  std::string place(const Variable& variable) const {
    return fmt::format("{}: variable \"{}\"", where_, excerpt(variable.name));
  }

  std::optional<Variable> coordinate(const std::string& dimension) const {
    auto variable = file_.variable(dimension);
    if (variable && variable->dimensions != std::vector<std::string>{dimension})
      return std::nullopt;
    return variable;
  }

  /// Maps one after another, over time, say: the dimension before y and x counts them.
  static bool is_series(const Variable& variable) { return variable.shape.size() == 3; }

  /// A variable of numbers over two lengths, or a series of such. A dimension without coordinates
  /// leaves the scale to the user; one that counts runs, pressures or seconds is no axis of a map.
  bool is_map(const Variable& variable) const {
    // One byte a pixel is a picture or a mask.
    if (!variable.numeric || variable.bytes_per_value < 2) return false;
    if (variable.shape.size() != 2 && !is_series(variable)) return false;
    const std::size_t down = variable.shape.size() - 2;
    if (variable.dimensions[down] == variable.dimensions[down + 1]) return false;
    for (std::size_t d = down; d < down + 2; ++d) {
      const auto axis = coordinate(variable.dimensions[d]);
      if (!axis) continue;
      const std::string unit = unit_of(file_, *axis);
      if (!axis->numeric || (!unit.empty() && !length_scale(unit))) return false;
    }
    if (!is_series(variable)) return true;
    // What counts labelled things (a matrix for each run) is no series of maps.
    const auto counter = coordinate(variable.dimensions[0]);
    return variable.shape[0] > 0 && (!counter || counter->numeric);
  }

  static std::string told(const std::vector<Variable>& maps) {
    constexpr std::size_t kMost = 20;
    std::vector<std::string> words;
    for (const Variable& map : maps) {
      if (words.size() == kMost) {
        words.push_back(fmt::format("and {} more", maps.size() - kMost));
        break;
      }
      const std::size_t down = map.shape.size() - 2;
      words.push_back(fmt::format("\"{}\" {} x {}{}", excerpt(map.name), map.shape[down + 1],
                                  map.shape[down],
                                  is_series(map) ? fmt::format(", {} frames", map.shape[0]) : ""));
    }
    return fmt::format("{}", fmt::join(words, ", "));
  }

  /// Beyond 100 million pixels (800 MB), maps are read one by one.
  void check_together(const std::vector<Variable>& maps, const ReadOptions& options) const {
    constexpr double kMostPixelsAtOnce = 1e8, kMostMapsAtOnce = 4096.0;
    double n_pixels = 0.0, n_maps = 0.0;
    for (const Variable& map : maps) {
      file_.check_room(map);
      n_pixels += static_cast<double>(map.size());
      n_maps += is_series(map) ? static_cast<double>(map.shape[0]) : 1.0;
    }
    if (options.page != 0 || n_maps <= 1.0) return;
    if (n_pixels <= kMostPixelsAtOnce && n_maps <= kMostMapsAtOnce) return;
    throw InputError(
        where_, fmt::format("holds more than is read at once: {}", told(maps)),
        "Name one with --channel, or instrument.channel in the experiment file; of a series, one "
        "frame as FILE#2 or with --page");
  }

  /// Spacing of a coordinate in m, 0 where the file gives none.
  Length pitch(const std::string& dimension) const {
    const auto axis = coordinate(dimension);
    if (!axis || axis->shape[0] < 2) return {};
    const auto scale = length_scale(unit_of(file_, *axis));
    if (!scale) return {};
    const std::vector<double> x = file_.read_doubles(*axis);
    const std::string where = place(*axis);
    const double step = even_step(x, where);
    if (!(scale->factor > 0.0 && scale->factor < 1e30 && step < 1e30)) {
      throw InputError(
          where,
          fmt::format("has an absurd spacing of {:.3g} {}", step, excerpt(unit_of(file_, *axis))),
          "Check the lateral scale");
    }
    return Length::from_si(checked_pitch(scale->factor * step, "its spacing", where));
  }

  Channel channel(const Variable& variable, std::size_t frame) const {
    const std::string where = place(variable);
    const std::size_t first = variable.shape.size() - 2;  // of the dimensions of the map
    const bool transposed = lower_case(variable.dimensions[first]) == "x" &&
                            lower_case(variable.dimensions[first + 1]) == "y";
    const std::size_t along_x = first + (transposed ? 0 : 1), down_y = first + (transposed ? 1 : 0);
    check_pixel_counts(static_cast<double>(variable.shape[along_x]),
                       static_cast<double>(variable.shape[down_y]), where);
    Channel channel;
    channel.name = variable.name;
    channel.grid.nx = static_cast<Index>(variable.shape[along_x]);
    channel.grid.ny = static_cast<Index>(variable.shape[down_y]);
    channel.grid.pitch_x = pitch(variable.dimensions[along_x]);
    channel.grid.pitch_y = pitch(variable.dimensions[down_y]);

    channel.file_unit = unit_of(file_, variable);
    const SiUnit unit = si_unit(channel.file_unit, where);
    channel.unit = unit.name;
    const double factor = file_.number_attribute(variable.id, "scale_factor").value_or(1.0);
    const double offset = file_.number_attribute(variable.id, "add_offset").value_or(0.0);
    if (!std::isfinite(factor) || factor == 0.0 || std::abs(factor) > 1e30 ||
        !std::isfinite(offset) || std::abs(offset) > 1e30) {
      throw InputError(where, fmt::format("has scale_factor {} and add_offset {}", factor, offset),
                       "Both must be finite numbers, the first not 0");
    }
    file_.check_room(variable);
    channel.values.resize(static_cast<Index>(variable.shape[first]),
                          static_cast<Index>(variable.shape[first + 1]));
    if (is_series(variable)) {
      file_.read_slice(variable, frame, channel.values.data());
    } else {
      file_.read(variable, channel.values.data());
    }
    const double fill = fill_value(file_, variable);
    for (Index i = 0; i < channel.values.size(); ++i) {
      double& value = channel.values.data()[i];
      if (value == fill || !std::isfinite(value)) {
        value = std::numeric_limits<double>::quiet_NaN();
      } else {
        value = std::abs(value) < kLargestValue ? factor * value + offset
                                                : std::numeric_limits<double>::quiet_NaN();
      }
    }
    scale_values(channel.values, unit.scale, where);
    if (transposed) channel.values.transposeInPlace();
    return channel;
  }

  std::string where_;
  NetcdfFile file_;
};

class NetcdfReader final : public Reader {
 public:
  std::string_view name() const override { return "netcdf"; }
  std::string_view description() const override { return "NetCDF map"; }
  std::vector<std::string> extensions() const override { return {".nc", ".nc4", ".cdf"}; }

  int score(const Probe& probe) const override {
    if (is_classic_netcdf(probe.head)) return 100;
    // NetCDF-4 is one of many kinds of HDF5 file: a reader that knows its kind goes first.
    if (!probe.head.starts_with("\x89HDF\r\n\x1a\n")) return 0;
    // What the NetCDF library says of itself in every file it makes, near its beginning.
    if (probe.head.find("_NCProperties") != std::string_view::npos) return 70;
    const std::string extension = lower_case(probe.path.extension().string());
    const auto ours = extensions();
    return std::find(ours.begin(), ours.end(), extension) != ours.end() ? 70 : 20;
  }

  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    // What is built on HDF5 is parsed apart; a classic file is checked byte by byte before the
    // library sees it.
    if (is_classic_netcdf(first_bytes(path))) return parse_netcdf(path, options);
    return read_in_worker("netcdf", path, options);
  }

 private:
  static std::string first_bytes(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string bytes(4, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return bytes;
  }
};

}  // namespace

std::vector<Channel> parse_netcdf(const std::filesystem::path& path, const ReadOptions& options) {
  return MapFile(path).channels(options);
}

const Reader& netcdf_reader() {
  static const NetcdfReader reader;
  return reader;
}

void write_netcdf_map(const std::filesystem::path& path, const HeightMap& map,
                      const std::string& title) {
  const CameraGrid& grid = map.grid();
  AtomicFile target(path);
  NetcdfFile file = NetcdfFile::create(target.temporary(), target.target());
  file.put_attribute(NetcdfFile::kGlobal, "Conventions", "CF-1.10");
  file.put_attribute(NetcdfFile::kGlobal, "title", title);
  const int y = file.define_dimension("y", static_cast<std::size_t>(grid.ny));
  const int x = file.define_dimension("x", static_cast<std::size_t>(grid.nx));

  const auto axis = [&file](const std::string& name, int dimension, Index n, Length pitch) {
    const int variable = file.define_double(name, {dimension});
    file.put_attribute(variable, "units", std::string("m"));
    file.put_attribute(variable, "long_name",
                       fmt::format("{} of the pixel's centre from the map's outer corner", name));
    std::vector<double> centres(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < centres.size(); ++i) {
      centres[i] = (static_cast<double>(i) + 0.5) * pitch.si();
    }
    file.write(variable, centres.data());
  };
  axis("y", y, grid.ny, grid.pitch_y);
  axis("x", x, grid.nx, grid.pitch_x);

  const int height = file.define_double("height", {y, x});
  file.fill_with_nan(height);
  file.put_attribute(height, "units", std::string("m"));
  file.put_attribute(height, "long_name", std::string("height of the surface"));
  Array2 values = map.height();
  for (Index i = 0; i < values.size(); ++i) {
    if (map.flags().data()[i] != 0) values.data()[i] = std::numeric_limits<double>::quiet_NaN();
  }
  file.write(height, values.data());
  file.close();
  target.commit();
}

}  // namespace manoscope::io
