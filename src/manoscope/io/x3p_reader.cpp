// X3P (.x3p), the XML exchange format of ISO 5436-2 and ISO 25178-72.
//
// Source: "The OpenGPS ISO5436-2 XML library" (open-gps.sourceforge.net) with its schema and sample
// files. A zip archive of main.xml (axes, sizes, metadata; all lengths in m) and, as a rule, a
// binary file of little-endian numbers: x fastest, then y, then the layers. The first row is taken
// as the top one, as other programs show it; heights are positive upwards.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/md5.hpp"
#include "manoscope/io/point_grid.hpp"
#include "manoscope/io/x3p.hpp"

namespace manoscope::io {
namespace {

/// A list of points as XML is the longest main.xml there is.
constexpr std::uint64_t kLargestXml = std::uint64_t{1} << 28;
/// What packs better than this holds nothing but repetitions.
constexpr std::uint64_t kBestXmlPacking = 200;

using Settings = std::vector<std::pair<std::string, std::string>>;

Settings settings_of(const pugi::xml_node& record2) {
  Settings settings;
  const auto add = [&](const char* name, std::string_view text) {
    if (!text.empty()) settings.emplace_back(name, one_line(text.substr(0, 1000)));
  };
  const pugi::xml_node instrument = child_of(record2, "Instrument");
  const pugi::xml_node probe = child_of(record2, "ProbingSystem");
  add("date", text_of(record2, "Date"));
  add("operator", text_of(record2, "Creator"));
  add("manufacturer", text_of(instrument, "Manufacturer"));
  add("model", text_of(instrument, "Model"));
  add("serial number", text_of(instrument, "Serial"));
  add("version", text_of(instrument, "Version"));
  add("calibrated", text_of(record2, "CalibrationDate"));
  add("probe type", text_of(probe, "Type"));
  add("probe", text_of(probe, "Identification"));
  add("comment", text_of(record2, "Comment"));
  return settings;
}

/// The spacing of an axis that every point of a matrix carries: the same along each line of it.
double matrix_spacing(const x3p::Layout& layout, const std::vector<double>& positions,
                      std::size_t axis, const std::string& where) {
  const auto nx = static_cast<std::size_t>(layout.n[0]), ny = static_cast<std::size_t>(layout.n[1]);
  const std::size_t n = axis == 0 ? nx : ny;
  // A missing point lacks its position too: each line takes it from the first point that has one.
  std::vector<double> line(n, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const std::size_t at = axis == 0 ? k % nx : k / nx % ny;
    if (std::isnan(line[at])) line[at] = positions[k];
  }
  const double spacing = even_spacing(line, where);
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const std::size_t at = axis == 0 ? k % nx : k / nx % ny;
    if (std::isfinite(positions[k]) &&
        std::abs(positions[k] - line[at]) > 0.05 * std::abs(spacing)) {
      throw InputError(where,
                       fmt::format("the {} of its points do not form an even grid",
                                   axis == 0 ? "columns" : "rows"),
                       "Resample the map to evenly spaced pixels");
    }
  }
  return spacing;
}

/// 0 where a single line or a zero increment leaves the scale open.
Length pitch(double spacing, Index n, const char* what, const std::string& where) {
  if (spacing == 0.0 || (n == 1 && spacing == 1.0)) return {};
  return Length::from_si(checked_pitch(std::abs(spacing), what, where));
}

std::vector<Channel> matrix_channels(const x3p::Layout& layout, x3p::Points& points,
                                     const std::string& where) {
  Channel common;
  common.grid.nx = layout.n[0];
  common.grid.ny = layout.n[1];
  std::array<double, 2> spacing{};
  for (std::size_t i = 0; i < 2; ++i) {
    spacing[i] = layout.stored[i] ? matrix_spacing(layout, points.position[i], i, where)
                                  : layout.axes[i].increment;
    if (spacing[i] < 0.0) {
      common.warnings.push_back(fmt::format("{} falls along the {}: the map is mirrored as stored",
                                            i == 0 ? "x" : "y", i == 0 ? "row" : "column"));
    }
  }
  common.grid.pitch_x = pitch(spacing[0], layout.n[0], "the increment of CX", where);
  common.grid.pitch_y = pitch(spacing[1], layout.n[1], "the increment of CY", where);
  std::vector<Channel> channels;
  for (Index layer = 0; layer < layout.n[2]; ++layer) {
    Channel channel = common;
    channel.name = layout.n[2] == 1 ? "height" : fmt::format("layer {}", layer + 1);
    if (layout.n[2] == 1) {
      channel.values = std::move(points.height);
    } else {
      channel.values = points.height.middleRows(layer * layout.n[1], layout.n[1]);
    }
    channels.push_back(std::move(channel));
  }
  return channels;
}

std::vector<Channel> list_channels(const x3p::Layout& layout, x3p::Points& points,
                                   const std::string& feature, const std::string& where) {
  Channel channel;
  channel.name = "height";
  if (feature == "PRF") {  // a profile
    channel.grid.nx = layout.n[0];
    channel.grid.ny = 1;
    const double spacing =
        layout.stored[0] ? even_spacing(points.position[0], where) : layout.axes[0].increment;
    channel.grid.pitch_x = pitch(spacing, layout.n[0], "the spacing of x", where);
    channel.values = std::move(points.height);
  } else if (!layout.stored[0] || !layout.stored[1]) {
    throw InputError(where, "its points have no positions", "Export x, y and z of every point");
  } else {
    PointGrid grid = grid_of_points(points.position[0], points.position[1],
                                    {points.height.data(), points.position[0].size(), 1}, where);
    channel.grid.nx = grid.values.cols();
    channel.grid.ny = grid.values.rows();
    channel.grid.pitch_x = pitch(grid.pitch_x, channel.grid.nx, "the spacing of x", where);
    channel.grid.pitch_y = pitch(grid.pitch_y, channel.grid.ny, "the spacing of y", where);
    channel.values = std::move(grid.values);
  }
  std::vector<Channel> channels;
  channels.push_back(std::move(channel));
  return channels;
}

class X3pReader final : public Reader {
 public:
  std::string_view name() const override { return "x3p"; }
  std::string_view description() const override { return "ISO 5436-2 X3P"; }
  std::vector<std::string> extensions() const override { return {".x3p"}; }

  int score(const Probe& probe) const override {
    if (!looks_like_zip(probe.head)) return 0;
    if (lower_case(probe.path.extension().string()) == ".x3p") return 90;
    return zip_head_names(probe.head, "main.xml") || zip_head_names(probe.head, "bindata/") ? 60
                                                                                            : 0;
  }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    const std::string where = path.string();
    ZipArchive archive(path);
    if (!archive.enter_folder_of("main.xml")) {
      throw InputError(where, "holds no main.xml: it is no X3P archive",
                       "Export the map to .x3p again");
    }
    const auto entry = archive.find("main.xml");
    const std::uint64_t largest =
        std::min(kLargestXml, (std::uint64_t{1} << 20) + kBestXmlPacking * archive.n_bytes());
    std::string text = archive.read(entry.value(), largest);
    std::vector<std::string> warnings;
    check_main(archive, text, warnings);
    pugi::xml_document document;
    const std::string place = archive.place(*entry);
    parse_xml(text, document, place);
    const pugi::xml_node root = document.document_element();
    if (local_name(root) != "ISO5436_2") {
      throw InputError(place,
                       fmt::format("begins with <{}>, not with <ISO5436_2>", excerpt(root.name())),
                       "Export the map to .x3p again");
    }
    return channels(root, archive, std::move(warnings), place);
  }

 private:
  static void check_main(const ZipArchive& archive, const std::string& text,
                         std::vector<std::string>& warnings) {
    const auto entry = archive.find("md5checksum.hex");
    if (!entry || entry->size > 4096) return;
    const std::string line = archive.read(*entry, 4096);
    const std::string_view digits =
        std::string_view(line).substr(0, line.find_first_of(" \t\r\n*"));
    const std::string found = md5(text);
    if (lower_case(digits) != found) {
      warnings.push_back(fmt::format(
          "the MD5 checksum of main.xml is {}, but the file says {}: it was changed or damaged",
          found, excerpt(digits)));
    }
  }

  static std::vector<Channel> channels(const pugi::xml_node& root, const ZipArchive& archive,
                                       std::vector<std::string> warnings,
                                       const std::string& place) {
    x3p::Layout layout = x3p::read_layout(root, place);
    const pugi::xml_node record3 = child_of(root, "Record3");
    const pugi::xml_node link = child_of(record3, "DataLink"), list = child_of(record3, "DataList");
    if (!link && !list) {
      throw InputError(place, "has neither a DataLink nor a DataList: no points",
                       "Export the map to .x3p again");
    }
    x3p::Points points =
        list ? x3p::read_list(layout, list, place) : x3p::read_binary(layout, link, archive, place);
    const std::string feature(text_of(child_of(root, "Record1"), "FeatureType"));
    std::vector<Channel> found = layout.matrix ? matrix_channels(layout, points, place)
                                               : list_channels(layout, points, feature, place);
    warnings.insert(warnings.end(), points.warnings.begin(), points.warnings.end());
    const x3p::Axis& z = layout.axes[2];
    if (!z.incremental && z.increment != 1.0 && z.increment != 0.0) {
      warnings.push_back(fmt::format(
          "the absolute axis CZ names an increment of {:.6g}, which is not applied", z.increment));
    }
    const Settings settings = settings_of(child_of(root, "Record2"));
    for (Channel& channel : found) {
      channel.unit = channel.file_unit = "m";
      channel.settings = settings;
      channel.warnings.insert(channel.warnings.end(), warnings.begin(), warnings.end());
      scale_values(channel.values, {}, place);
    }
    return found;
  }
};

}  // namespace

const Reader& x3p_reader() {
  static const X3pReader reader;
  return reader;
}

}  // namespace manoscope::io
