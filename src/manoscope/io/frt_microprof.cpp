// FRT MicroProf (.frt).
//
// Source: the descriptions of the format in Gwyddion's import module microprof and in
// SurfaceTopography's reader FRT. Little-endian. "FRTM_GLIDERV" and a version, a number of blocks,
// and the blocks: a kind of 16 bits, a size of 32 bits (version 1.00) or 64, and so many bytes.
//
//   0x66 numbers of columns, rows and bits of a pixel      0x6c scale of the heights in m
//   0x67 sizes in m                                        0x70 first and last number that is valid
//   0x0b heights, 16-bit unsigned or 32-bit signed         0x7d further images
//
//   height = scale * number
//
// The first row is the bottom one. The number 1 marks a missing height, and so does whatever lies
// outside the valid numbers: a scan that was broken off leaves zeros.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"

namespace manoscope::io {
namespace {

constexpr std::string_view kMagic = "FRTM_GLIDERV";
constexpr std::uint16_t kHeights = 0x0b, kComment = 0x65, kCounts = 0x66, kSizes = 0x67,
                        kScale = 0x6c, kValid = 0x70, kImages = 0x7d;
constexpr std::array kUsed{kHeights, kComment, kCounts, kSizes, kScale, kValid, kImages};
constexpr std::uint32_t kIntensity = 0x2;
constexpr double kMissing = 1.0;
constexpr const char* kSaveAgain = "Save the map in FRT's program again";

struct Block {
  std::uint64_t offset = 0, size = 0;
};

class Blocks {
 public:
  explicit Blocks(ByteCursor& cursor) : where_(cursor.where()) {
    cursor.seek(kMagic.size());
    const std::string version(cursor.bytes(4));
    if (version != "1.00" && version != "1.01") {
      cursor.fail("is of a version other than 1.00 and 1.01", kSaveAgain);
    }
    const std::uint16_t n_blocks = cursor.u16(Endian::little);
    for (std::uint16_t i = 0; i < n_blocks && cursor.remaining() > 0; ++i) {
      const std::uint16_t kind = cursor.u16(Endian::little);
      const std::uint64_t size =
          version == "1.00" ? cursor.u32(Endian::little) : cursor.u64(Endian::little);
      if (std::find(kUsed.begin(), kUsed.end(), kind) != kUsed.end()) {
        blocks_[kind] = {cursor.offset(), size};
      }
      cursor.skip(size);
    }
  }

  const Block* find(std::uint16_t kind, std::uint64_t least_size) const {
    const auto found = blocks_.find(kind);
    return found == blocks_.end() || found->second.size < least_size ? nullptr : &found->second;
  }

  const Block& need(std::uint16_t kind, std::uint64_t least_size, std::string_view what) const {
    const Block* block = find(kind, least_size);
    if (block == nullptr) {
      throw InputError(where_, fmt::format("has no block 0x{:02x} with its {}", kind, what),
                       kSaveAgain);
    }
    return *block;
  }

 private:
  std::string where_;
  std::map<std::uint16_t, Block> blocks_;
};

SampleType sample_type(std::uint32_t bits, const std::string& where) {
  if (bits == 16) return SampleType::u16;
  if (bits == 32) return SampleType::i32;
  throw InputError(where, fmt::format("has pixels of {} bits; known are 16 and 32", bits),
                   kSaveAgain);
}

class FrtReader final : public Reader {
 public:
  std::string_view name() const override { return "frt"; }
  std::string_view description() const override { return "FRT MicroProf"; }
  std::vector<std::string> extensions() const override { return {".frt"}; }
  int score(const Probe& probe) const override { return probe.head.starts_with(kMagic) ? 100 : 0; }

  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    const std::string where = path.string();
    ByteCursor cursor(path);
    if (!cursor.file_begins_with(kMagic)) {
      throw InputError(where, "does not begin with \"FRTM_GLIDERV\"", kSaveAgain);
    }
    const Blocks blocks(cursor);
    cursor.seek(blocks.need(kCounts, 12, "numbers of pixels").offset);
    const std::uint32_t nx = cursor.u32(Endian::little), ny = cursor.u32(Endian::little);
    const SampleType type = sample_type(cursor.u32(Endian::little), where);
    cursor.seek(blocks.need(kScale, 12, "scale of heights").offset + 4);
    const double scale = cursor.f64(Endian::little);
    const Block& block =
        blocks.need(kHeights, std::uint64_t{nx} * ny * sample_bytes(type), "heights");
    cursor.seek(block.offset);
    Array2 heights = read_block(cursor, type, Endian::little, nx, ny, "heights");
    drop_invalid(heights, cursor, blocks);
    turn_rows_over(heights);
    std::vector<Channel> channels;
    channels.push_back(make_channel("height", "m", std::move(heights), scale, where));
    if (is_wanted(options, false, true)) read_intensities(channels, cursor, blocks);
    for (Channel& channel : channels) finish(channel, cursor, blocks);
    return channels;
  }

 private:
  static void drop_invalid(Array2& heights, ByteCursor& cursor, const Blocks& blocks) {
    mark_missing(heights, [](double number) { return number == kMissing; });
    const Block* valid = blocks.find(kValid, 8);
    if (valid == nullptr) return;
    cursor.seek(valid->offset);
    const double first = cursor.u32(Endian::little), last = cursor.u32(Endian::little);
    if (first >= last) return;
    mark_missing(heights, [&](double number) { return number < first || number > last; });
  }

  /// Block 0x7d repeats the heights and adds the intensities, each image with its own head.
  static void read_intensities(std::vector<Channel>& channels, ByteCursor& cursor,
                               const Blocks& blocks) {
    const Block* images = blocks.find(kImages, 24);
    if (images == nullptr) return;
    const std::uint64_t end = images->offset + images->size;
    cursor.seek(images->offset + 8);
    while (cursor.offset() + 16 <= end) {
      const std::uint32_t kind = cursor.u32(Endian::little);
      const std::uint64_t nx = cursor.u32(Endian::little), ny = cursor.u32(Endian::little);
      const std::uint32_t bits = cursor.u32(Endian::little);
      check_pixel_counts(static_cast<double>(nx), static_cast<double>(ny), cursor.where());
      const SampleType type = sample_type(bits, cursor.where());
      if (nx * ny * sample_bytes(type) > end - cursor.offset()) {
        cursor.fail(fmt::format("an image of {} x {} pixels reaches beyond its block", nx, ny),
                    kSaveAgain);
      }
      if (kind != kIntensity) {
        cursor.skip(nx * ny * sample_bytes(type));
        continue;
      }
      Array2 image = read_block(cursor, type, Endian::little, nx, ny, "intensities");
      turn_rows_over(image);
      check_channel_count(channels.size() + 1, cursor.where());
      channels.push_back(make_channel("intensity", "1", std::move(image), 1.0, cursor.where()));
    }
  }

  static void finish(Channel& channel, ByteCursor& cursor, const Blocks& blocks) {
    cursor.seek(blocks.need(kSizes, 16, "sizes").offset);
    const double size_x = cursor.f64(Endian::little), size_y = cursor.f64(Endian::little);
    const auto pitch = [&](double size, Index n) {
      return std::isfinite(size) ? std::abs(size) / static_cast<double>(n) : 0.0;
    };
    set_pitch(channel, pitch(size_x, channel.grid.nx), pitch(size_y, channel.grid.ny),
              cursor.where());
    if (const Block* comment = blocks.find(kComment, 1)) {
      cursor.seek(comment->offset);
      add_setting(channel, "comment", cursor.text(std::min<std::uint64_t>(comment->size, 1000)));
    }
  }
};

}  // namespace

const Reader& frt_microprof_reader() {
  static const FrtReader reader;
  return reader;
}

}  // namespace manoscope::io
