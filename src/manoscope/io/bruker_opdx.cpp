// Bruker Vision64 and Dektak (.opdx).
//
// Source: the descriptions of the format in Gwyddion's import module dektakvca and in
// SurfaceTopography's reader OPDx. A mark of 12 bytes, then little-endian items of a name, a type
// and a value; containers nest. Maps lie in 2D_Data, profiles in 1D_Data, each with its scales.
//
//   height = sample * DataScale
//
// An extent runs from the centre of the first sample to that of the last one: it is n - 1 pitches.
// So it does for the positions that profiles write out, and the two extents of a map with square
// pixels agree only so.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"
#include "manoscope/io/vca_items.hpp"

namespace manoscope::io {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic = "VCA DATA\x01\x00\x00\x55"sv;
constexpr std::uint64_t kArrayHead = 5;  // type and size of an element
constexpr const char* kSaveAgain = "Save it again in Vision64 or export it as text";
constexpr std::size_t kMostSettings = 200;

/// SI per step of a quantity that the container names; 0 and "" where it has none.
struct Step {
  double in_si = 0.0;
  std::string unit, file_unit;
};

Step find_step(ByteCursor& cursor, const VcaItem& container, std::string_view name) {
  const auto item = find_vca_item(cursor, container, name);
  const auto quantity = item ? vca_quantity(cursor, *item) : std::nullopt;
  if (!quantity) return {};
  if (!std::isfinite(quantity->value) || std::abs(quantity->value) > 1e30) {
    throw InputError(
        cursor.where(),
        fmt::format("its {} is {}", name,
                    std::isfinite(quantity->value) ? fmt::format("{:.3g}", quantity->value)
                                                   : std::string("not a number")),
        kSaveAgain);
  }
  Step step;
  step.file_unit = quantity->unit;
  const SiUnit unit = si_unit(quantity->unit, cursor.where());
  step.unit = unit.name;
  step.in_si = quantity->value * unit.scale.factor;
  return step;
}

double pitch(const Step& extent, std::uint64_t n) {
  if (extent.unit != "m" || n < 2) return 0.0;
  return std::abs(extent.in_si) / static_cast<double>(n - 1);
}

Array2 read_matrix(ByteCursor& cursor, const VcaItem& matrix) {
  cursor.seek(matrix.offset);
  const std::uint64_t ny = cursor.u32(Endian::little), nx = cursor.u32(Endian::little);
  check_pixel_counts(static_cast<double>(nx), static_cast<double>(ny), cursor.where());
  const std::uint64_t n_bytes = matrix.size < 8 ? 0 : matrix.size - 8;
  const bool is_f64 = n_bytes == 8 * nx * ny;
  if (!is_f64 && n_bytes != 4 * nx * ny) {
    cursor.fail(fmt::format("a matrix of {} x {} samples has {} bytes", nx, ny, n_bytes),
                kSaveAgain);
  }
  return read_block(cursor, is_f64 ? SampleType::f64 : SampleType::f32, Endian::little, nx, ny,
                    "samples");
}

Array2 read_array(ByteCursor& cursor, const VcaItem& array) {
  cursor.seek(array.offset);
  const std::uint8_t element = cursor.u8();
  if (array.size < kArrayHead || element != static_cast<std::uint8_t>(VcaType::f64) ||
      (array.size - kArrayHead) % 8 != 0) {
    cursor.fail(fmt::format("an array of {} bytes is not one of 64-bit floats", array.size),
                kSaveAgain);
  }
  cursor.seek(array.offset + kArrayHead);
  return read_block(cursor, SampleType::f64, Endian::little, (array.size - kArrayHead) / 8, 1,
                    "samples");
}

std::string channel_name(ByteCursor& cursor, const VcaItem& data) {
  const auto kind = find_vca_item(cursor, data, "DataKind");
  const std::string words = kind ? vca_text(cursor, *kind) : std::string();
  const std::string name(trimmed(data.name));
  return words.empty() ? one_line(name) : one_line(fmt::format("{} {}", name, words));
}

void describe(Channel& channel, ByteCursor& cursor, const VcaItem& meta, int depth) {
  for_each_vca_item(cursor, meta, [&](const VcaItem& item) {
    if (channel.settings.size() >= kMostSettings) return;
    if (item.holds_items()) {
      if (depth < 4) describe(channel, cursor, item, depth + 1);
    } else {
      add_setting(channel, item.name.substr(0, 80), vca_text(cursor, item).substr(0, 1000));
    }
  });
}

class BrukerOpdxReader final : public Reader {
 public:
  std::string_view name() const override { return "bruker-opdx"; }
  std::string_view description() const override { return "Bruker Vision64 and Dektak"; }
  std::vector<std::string> extensions() const override { return {".opdx"}; }
  int score(const Probe& probe) const override { return probe.head.starts_with(kMagic) ? 100 : 0; }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    const std::string bytes = read_file(path);
    ByteCursor cursor(bytes, path.string());
    if (!bytes.starts_with(kMagic)) {
      throw InputError(path.string(), "does not begin with the mark of a Bruker data set",
                       kSaveAgain);
    }
    const VcaItem file{"", VcaType::container, kMagic.size(), bytes.size() - kMagic.size()};
    std::vector<Channel> channels;
    for (const std::string_view kind : {"2D_Data"sv, "1D_Data"sv}) {
      const auto group = find_vca_item(cursor, file, kind);
      if (!group || !group->holds_items()) continue;
      for_each_vca_item(cursor, *group, [&](const VcaItem& data) {
        if (data.holds_items()) add_channel(channels, cursor, data, kind == "2D_Data");
      });
    }
    if (channels.empty()) {
      throw InputError(path.string(), "holds neither a map nor a profile", kSaveAgain);
    }
    if (const auto meta = find_vca_item(cursor, file, "MetaData"); meta && meta->holds_items()) {
      for (Channel& channel : channels) describe(channel, cursor, *meta, 0);
    }
    return channels;
  }

 private:
  static void add_channel(std::vector<Channel>& channels, ByteCursor& cursor, const VcaItem& data,
                          bool is_map) {
    const auto samples = find_vca_item(cursor, data, is_map ? "Matrix" : "Array");
    const bool known = samples && (is_map ? samples->type == VcaType::named_matrix ||
                                                samples->type == VcaType::matrix
                                          : samples->type == VcaType::f64_array);
    if (!known) return;
    check_channel_count(channels.size() + 1, cursor.where());
    const Step step = find_step(cursor, data, "DataScale");
    Array2 values = is_map ? read_matrix(cursor, *samples) : read_array(cursor, *samples);
    const auto nx = static_cast<std::uint64_t>(values.cols());
    const auto ny = static_cast<std::uint64_t>(values.rows());
    Channel channel = make_channel(channel_name(cursor, data), step.unit, std::move(values),
                                   step.file_unit.empty() && step.in_si == 0.0 ? 1.0 : step.in_si,
                                   cursor.where());
    channel.file_unit = step.file_unit;
    const Step along = find_step(cursor, data, is_map ? "Dimension2Extent" : "Extent");
    const Step across = is_map ? find_step(cursor, data, "Dimension1Extent") : Step{};
    set_pitch(channel, pitch(along, nx), pitch(across, ny), cursor.where());
    channels.push_back(std::move(channel));
  }
};

}  // namespace

const Reader& bruker_opdx_reader() {
  static const BrukerOpdxReader reader;
  return reader;
}

}  // namespace manoscope::io
