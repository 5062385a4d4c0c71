// Maps as plain text: a matrix of numbers, one row a line, with or without a header; or a table of
// points. In UTF-8, Latin-1 or UTF-16.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/text_cells.hpp"
#include "manoscope/io/text_matrix.hpp"
#include "manoscope/io/text_table.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {
namespace {

/// The pitch of one axis from what the header says; 0 if it says nothing.
Length pitch_of(const std::optional<Length>& pitch, const std::optional<Length>& size, Index n,
                std::string_view axis, const std::string& where) {
  const auto count = static_cast<double>(n);
  if (!pitch && !size) return {};
  if (pitch && size && std::abs(*pitch * count / *size - 1.0) > 1e-3) {
    throw InputError(where,
                     fmt::format("{} pixels of {:.6g} um along {} do not make a map of {:.6g} um",
                                 n, pitch->in(um), axis, size->in(um)),
                     "Correct the pitch or the size in the header");
  }
  const Length found = pitch ? *pitch : *size / count;
  return Length::from_si(
      checked_pitch(found.si(), fmt::format("its header along {}", axis), where));
}

class TextReader final : public Reader {
 public:
  std::string_view name() const override { return "text"; }
  std::string_view description() const override { return "text matrix or table of points"; }
  std::vector<std::string> extensions() const override {
    return {".txt", ".csv", ".tsv", ".asc", ".dat"};
  }

  std::string_view orientation() const override {
    return "first row of a matrix, smallest y of a table on top; heights positive upwards, as the "
           "file has them";
  }
  int score(const Probe& probe) const override {
    const std::string head = utf8_text(std::string(probe.head));
    if (!looks_like_text_matrix(head)) return 0;
    const std::string extension = lower_case(probe.path.extension().string());
    const auto ours = extensions();
    return std::find(ours.begin(), ours.end(), extension) != ours.end() ? 40 : 20;
  }

  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    const std::string where = path.string();
    TextMatrix matrix = parse_text_matrix(utf8_text(read_file(path)), where);
    const TextHeader& header = matrix.header;
    const bool scaled = header.pitch_x || header.pitch_y || header.size_x || header.size_y;
    const bool narrow = matrix.values.cols() <= 3 && matrix.values.rows() > matrix.values.cols();
    std::vector<Channel> channels;
    if (!matrix.labels.empty() || (narrow && !scaled)) {
      channels.push_back(channel_of_table(matrix, options, where));
      return channels;
    }
    Channel channel;
    channel.name = header.name;
    channel.grid.nx = matrix.values.cols();
    channel.grid.ny = matrix.values.rows();
    channel.grid.pitch_x = pitch_of(header.pitch_x, header.size_x, channel.grid.nx, "x", where);
    channel.grid.pitch_y = pitch_of(header.pitch_y, header.size_y, channel.grid.ny, "y", where);
    channel.file_unit = header.unit;
    const SiUnit unit = si_unit(header.unit, where);
    channel.unit = unit.name;
    channel.values = std::move(matrix.values);
    scale_values(channel.values, unit.scale, where);
    channels.push_back(std::move(channel));
    return channels;
  }
};

}  // namespace

const Reader& text_reader() {
  static const TextReader reader;
  return reader;
}

void write_text_map(const std::filesystem::path& path, const HeightMap& map,
                    const std::string& title) {
  const CameraGrid& grid = map.grid();
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "# Channel: {}\n# Width: {} m\n# Height: {} m\n", one_line(title),
                 grid.size_x().si(), grid.size_y().si());
  fmt::format_to(out, "# pitch x: {} m\n# pitch y: {} m\n# Value units: m\n", grid.pitch_x.si(),
                 grid.pitch_y.si());
  for (Index iy = 0; iy < grid.ny; ++iy) {
    for (Index ix = 0; ix < grid.nx; ++ix) {
      if (ix > 0) text.push_back(',');
      // The shortest text that reads back as the same number.
      if (map.flags()(iy, ix) == 0) {
        fmt::format_to(out, "{}", map.height()(iy, ix));
      } else {
        text.append(std::string_view("nan"));
      }
    }
    text.push_back('\n');
  }
  write_file_atomically(path, {text.data(), text.size()});
}

}  // namespace manoscope::io
