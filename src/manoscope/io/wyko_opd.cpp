// Wyko and Veeco Vision (.opd).
//
// Source: "Wyko Vision32 software manual", appendix on the OPD format, and the description of
// Gwyddion's import module opdfile. Little-endian. Two bytes, then a directory of 24-byte entries
// (name, type, length, flags), the first of them the directory itself; the blocks follow in the
// order of their entries. An array block has its counts of columns and rows, the bytes of an
// element, and the elements column by column, each from the bottom row to the top one.
//
//   height = element * Wavelength [nm] / Mult
//
// `Pixel_size` [mm] is the distance of columns; times `Aspect`, that of rows.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"

namespace manoscope::io {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic =
    "\x01\x00"
    "Directory"sv;
constexpr std::uint64_t kEntryBytes = 24, kNameBytes = 16;
constexpr std::size_t kMostSettings = 200;
constexpr const char* kSaveAgain = "Save the map in Vision again";

enum BlockType { array_block = 3, text_block = 5, i16_block, f32_block, f64_block, i32_block = 12 };

struct Block {
  std::string name;
  int type = 0;
  std::uint64_t offset = 0, size = 0;
};

std::vector<Block> read_directory(ByteCursor& cursor) {
  cursor.seek(2);
  std::vector<Block> blocks;
  std::uint64_t n_entries = 1, offset = 2;
  for (std::uint64_t i = 0; i < n_entries; ++i) {
    Block block;
    block.name = cursor.text(kNameBytes);
    block.type = cursor.u16(Endian::little);
    block.size = cursor.u32(Endian::little);
    cursor.skip(2);
    block.offset = offset;
    if (i == 0) {
      n_entries = block.size / kEntryBytes;
      cursor.seek(2);
      cursor.require(n_entries, kEntryBytes, "directory entries");
      blocks.reserve(n_entries);
      cursor.seek(2 + kEntryBytes);
    }
    offset += block.size;
    if (offset > cursor.size()) {
      throw InputError(cursor.where(),
                       fmt::format("its block \"{}\" would end at byte {}, but the file ends at "
                                   "byte {}",
                                   excerpt(block.name), offset, cursor.size()),
                       "The file is incomplete or damaged; copy or export it again");
    }
    if (i > 0 && block.size > 0) blocks.push_back(std::move(block));
  }
  return blocks;
}

/// The number of a block of one number, absent if there is no such block.
std::optional<double> number(ByteCursor& cursor, const Block& block) {
  const auto holds = [&](std::uint64_t n_bytes) { return block.size >= n_bytes; };
  cursor.seek(block.offset);
  switch (block.type) {
    case i16_block:
      return holds(2) ? std::optional(double(cursor.i16(Endian::little))) : std::nullopt;
    case f32_block:
      return holds(4) ? std::optional(cursor.f32(Endian::little)) : std::nullopt;
    case f64_block:
      return holds(8) ? std::optional(cursor.f64(Endian::little)) : std::nullopt;
    case i32_block:
      return holds(4) ? std::optional(double(cursor.i32(Endian::little))) : std::nullopt;
    default:
      return std::nullopt;
  }
}

std::optional<double> number(ByteCursor& cursor, const std::vector<Block>& blocks,
                             std::string_view name) {
  for (const Block& block : blocks) {
    if (block.name == name) return number(cursor, block);
  }
  return std::nullopt;
}

/// A scale of the file; `otherwise` where it has none of that name.
double scale(ByteCursor& cursor, const std::vector<Block>& blocks, std::string_view name,
             std::optional<double> otherwise = std::nullopt) {
  const auto value = number(cursor, blocks, name);
  if (!value && otherwise) return *otherwise;
  if (!value) {
    throw InputError(cursor.where(), fmt::format("has no number named {}", name), kSaveAgain);
  }
  if (!std::isfinite(*value) || std::abs(*value) > 1e30 || std::abs(*value) < 1e-30) {
    const std::string words =
        std::isfinite(*value) ? fmt::format("{:.3g}", *value) : std::string("not a finite number");
    throw InputError(cursor.where(), fmt::format("its {} is {}", name, words), kSaveAgain);
  }
  return *value;
}

bool holds_heights(std::string_view name) {
  constexpr std::array kNames{"Raw"sv, "RAW_DATA"sv, "RAW DATA"sv, "OPD"sv, "SAMPLE_DATA"sv};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

bool is_array(const Block& block) { return block.type == array_block && block.size >= 6; }

Array2 read_array(ByteCursor& cursor, const Block& block) {
  cursor.seek(block.offset);
  const std::uint16_t nx = cursor.u16(Endian::little), ny = cursor.u16(Endian::little);
  const std::uint16_t n_bytes = cursor.u16(Endian::little);
  const std::uint64_t needs = 6 + std::uint64_t{nx} * ny * n_bytes;
  if (needs > block.size) {
    throw InputError(cursor.where(),
                     fmt::format("its block \"{}\" has {} bytes, but {} x {} elements of {} bytes "
                                 "need {}",
                                 excerpt(block.name), block.size, nx, ny, n_bytes, needs),
                     kSaveAgain);
  }
  const auto read = [&](SampleType type, double first_missing) {
    Array2 values = read_columns_from_below(cursor, type, Endian::little, nx, ny, "elements");
    mark_missing(values, [&](double value) { return value >= first_missing; });
    return values;
  };
  switch (n_bytes) {
    case 1:
      return read(SampleType::u8, 256.0);
    case 2:
      return read(SampleType::i16, 32766.0);
    case 4:
      return read(SampleType::f32, 9.9e37);  // 1e38, as a float, is a little less
    default:
      throw InputError(cursor.where(),
                       fmt::format("its block \"{}\" has elements of {} bytes; known are 1, 2 and "
                                   "4",
                                   excerpt(block.name), n_bytes),
                       kSaveAgain);
  }
}

void describe(Channel& channel, ByteCursor& cursor, const std::vector<Block>& blocks) {
  for (const Block& block : blocks) {
    if (channel.settings.size() >= kMostSettings) return;
    if (block.type == text_block) {
      cursor.seek(block.offset);
      add_setting(channel, block.name, cursor.text(std::min<std::uint64_t>(block.size, 1000)));
    } else if (const auto value = number(cursor, block)) {
      add_setting(channel, block.name, *value);
    }
  }
}

class WykoOpdReader final : public Reader {
 public:
  std::string_view name() const override { return "wyko-opd"; }
  std::string_view description() const override { return "Wyko and Veeco Vision"; }
  std::vector<std::string> extensions() const override { return {".opd"}; }
  int score(const Probe& probe) const override { return probe.head.starts_with(kMagic) ? 100 : 0; }

  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    ByteCursor cursor(path);
    if (!cursor.file_begins_with(kMagic)) {
      throw InputError(path.string(), "does not begin with the directory of a Vision file",
                       kSaveAgain);
    }
    const std::vector<Block> blocks = read_directory(cursor);
    const double pixel_size = scale(cursor, blocks, "Pixel_size") * 1e-3;
    const double aspect = scale(cursor, blocks, "Aspect", 1.0);
    const bool any_heights = std::any_of(blocks.begin(), blocks.end(), [](const Block& block) {
      return is_array(block) && holds_heights(block.name);
    });
    std::vector<Channel> channels;
    for (const Block& block : blocks) {
      const bool heights = holds_heights(block.name);
      if (!is_array(block) || !is_wanted(options, heights, any_heights)) continue;
      check_channel_count(channels.size() + 1, path.string());
      const double step = heights ? height_per_count(cursor, blocks) : 1.0;
      channels.push_back(make_channel(block.name, heights ? "m" : "1", read_array(cursor, block),
                                      step, path.string()));
      set_pitch(channels.back(), pixel_size, pixel_size * aspect, path.string());
      describe(channels.back(), cursor, blocks);
    }
    if (channels.empty()) {
      throw InputError(path.string(), "holds no array of heights or intensities", kSaveAgain);
    }
    return channels;
  }

 private:
  static double height_per_count(ByteCursor& cursor, const std::vector<Block>& blocks) {
    return scale(cursor, blocks, "Wavelength") * 1e-9 / scale(cursor, blocks, "Mult", 1.0);
  }
};

}  // namespace

const Reader& wyko_opd_reader() {
  static const WykoOpdReader reader;
  return reader;
}

}  // namespace manoscope::io
