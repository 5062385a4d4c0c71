// Sensofar .plux: a zip archive of index.xml and one file of heights a layer.
//
// Source: the layout as the Gwyddion project describes it, and index.xml of a real file.
// IMAGE_SIZE_X by IMAGE_SIZE_Y little-endian 32-bit floats in um, row by row from the top; FOV_X
// and FOV_Y are the size of one pixel in um. Missing: NaN, or 1000001 as in the older .plu.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/io/byte_cursor.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"
#include "manoscope/io/xml_file.hpp"
#include "manoscope/io/zip_archive.hpp"

namespace manoscope::io {
namespace {

constexpr std::uint64_t kLargestXml = std::uint64_t{1} << 20;
constexpr double kNotMeasured = 1000001.0;
constexpr const char* kExportAgain = "Export the map to .plux again";

using Settings = std::vector<std::pair<std::string, std::string>>;

double required(const pugi::xml_node& general, const char* name, const std::string& where) {
  const auto value = number_of(general, name, where);
  if (!value) throw InputError(where, fmt::format("does not give {}", name), kExportAgain);
  return *value;
}

Settings settings_of(const pugi::xml_node& root, const pugi::xml_node& layer) {
  Settings settings;
  const auto add = [&](std::string_view name, std::string_view value, const char* unit = "") {
    if (name.empty() || value.empty()) return;
    settings.emplace_back(one_line(name.substr(0, 100)), one_line(value.substr(0, 1000)) + unit);
  };
  const pugi::xml_node general = child_of(root, "GENERAL");
  add("date", text_of(general, "DATE"));
  add("operator", text_of(general, "AUTHOR"));
  for (const pugi::xml_node& item : child_of(root, "INFO").children()) {
    add(text_of(item, "NAME"), text_of(item, "VALUE"));
  }
  add("position x", text_of(layer, "POSITION_X"), " um");
  add("position y", text_of(layer, "POSITION_Y"), " um");
  add("position z", text_of(layer, "POSITION_Z"), " um");
  return settings;
}

class PluxReader final : public Reader {
 public:
  std::string_view name() const override { return "plux"; }
  std::string_view description() const override { return "Sensofar PLUX"; }
  std::vector<std::string> extensions() const override { return {".plux"}; }

  int score(const Probe& probe) const override {
    if (!looks_like_zip(probe.head)) return 0;
    if (lower_case(probe.path.extension().string()) == ".plux") return 90;
    return zip_head_names(probe.head, "LAYER_0.") ? 60 : 0;
  }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    const std::string where = path.string();
    ZipArchive archive(path);
    if (!archive.enter_folder_of("index.xml")) {
      throw InputError(where, "holds no index.xml: it is no PLUX archive", kExportAgain);
    }
    const auto entry = archive.find("index.xml").value();
    std::string text = archive.read(entry, kLargestXml);
    const std::string place = archive.place(entry);
    pugi::xml_document document;
    parse_xml(text, document, place);
    const pugi::xml_node root = document.document_element();
    const pugi::xml_node general = child_of(root, "GENERAL");
    Channel common;
    const double nx = required(general, "IMAGE_SIZE_X", place);
    const double ny = required(general, "IMAGE_SIZE_Y", place);
    if (nx != std::floor(nx) || ny != std::floor(ny)) {
      throw InputError(place, fmt::format("announces {} x {} pixels", nx, ny), kExportAgain);
    }
    check_pixel_counts(nx, ny, place);
    common.grid.nx = static_cast<Index>(nx);
    common.grid.ny = static_cast<Index>(ny);
    common.grid.pitch_x = pitch(general, "FOV_X", place);
    common.grid.pitch_y = pitch(general, "FOV_Y", place);
    common.file_unit = "um";
    common.unit = "m";

    std::vector<Channel> channels;
    for (const pugi::xml_node& layer : root.children()) {
      const std::string_view file = text_of(layer, "FILENAME_Z");
      if (!local_name(layer).starts_with("LAYER_") || file.empty()) continue;
      check_channel_count(channels.size() + 1, place);
      Channel channel = common;
      channel.name = one_line(local_name(layer));
      channel.settings = settings_of(root, layer);
      read_heights(archive, file, channel, where);
      channels.push_back(std::move(channel));
    }
    if (channels.empty()) throw InputError(place, "names no layer of heights", kExportAgain);
    if (channels.size() == 1) channels.front().name = "height";
    return channels;
  }

 private:
  static Length pitch(const pugi::xml_node& general, const char* name, const std::string& where) {
    const double um_per_pixel = std::abs(number_of(general, name, where).value_or(0.0));
    if (um_per_pixel == 0.0) return {};
    return Length::from_si(checked_pitch(std::min(um_per_pixel, 1e30) * 1e-6, name, where));
  }

  static void read_heights(const ZipArchive& archive, std::string_view file, Channel& channel,
                           const std::string& where) {
    const auto entry = archive.find(file);
    if (!entry) {
      throw InputError(where,
                       fmt::format("its index names {} as the heights, which is not in the archive",
                                   excerpt(file)),
                       "Export the map with its heights");
    }
    const auto n_pixels = static_cast<std::uint64_t>(channel.grid.nx * channel.grid.ny);
    if (entry->size != 4 * n_pixels) {
      throw InputError(archive.place(*entry),
                       fmt::format("has {} bytes where {} x {} pixels need {}", entry->size,
                                   channel.grid.nx, channel.grid.ny, 4 * n_pixels),
                       "The archive is incomplete or of another layout; export the map again");
    }
    const std::string data = archive.read(*entry, 4 * n_pixels);
    ByteCursor cursor(data, archive.place(*entry));
    channel.values.resize(channel.grid.ny, channel.grid.nx);
    cursor.f32_array(Endian::little, {channel.values.data(), n_pixels});
    for (Index i = 0; i < channel.values.size(); ++i) {
      double& value = channel.values.data()[i];
      if (value == kNotMeasured) value = std::numeric_limits<double>::quiet_NaN();
    }
    scale_values(channel.values, UnitScale{1e-6, 0.0}, where);
  }
};

}  // namespace

const Reader& plux_reader() {
  static const PluxReader reader;
  return reader;
}

}  // namespace manoscope::io
