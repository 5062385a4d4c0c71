// Keyence VK laser microscopes (.vk3, .vk4; .vk6 and .vk7 hold a .vk4 in a zip archive).
//
// Source: the description in Gwyddion's import module keyence and the VK4 layout of OSTI report
// 1419732. Little-endian. A head of 12 bytes and 17 offsets, to the conditions of the measurement
// and to the images; sizes of pixels and steps of height in pm. An image has its numbers of columns
// and rows, the bits of a pixel, a palette, and the pixels as unsigned numbers. Rows run from the
// top. The format marks no missing heights. Of .vk3 no description is public: one that is
// laid out as a .vk4 is read, one whose table of offsets is shorter is refused.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"
#include "manoscope/io/zip_archive.hpp"

namespace manoscope::io {
namespace {

constexpr std::array<std::string_view, 4> kMagics{"VK3_", "VK4_", "VK6", "VK7"};
constexpr std::uint64_t kOffsets = 12, kPaletteBytes = 768;
constexpr double kPicometre = 1e-12;
constexpr const char* kSaveAgain = "Save it with Keyence's program again, or export it as text";

/// Where the table of offsets has what is wanted here.
enum OffsetPlace { conditions = 0, light = 3, height = 6, n_images_of_a_kind = 3, n_offsets = 18 };
/// Where the conditions have what is wanted here, in steps of 4 bytes.
enum ConditionPlace {
  year = 1,
  lens = 24,
  pitch_x = 42,
  pitch_y = 43,
  step_z = 44,
  n_conditions = 50,
};

bool is_vk(std::string_view head) {
  for (const std::string_view magic : kMagics) {
    if (head.starts_with(magic)) return true;
  }
  return false;
}

std::uint32_t u32_at(ByteCursor& cursor, std::uint64_t offset) {
  cursor.seek(offset);
  return cursor.u32(Endian::little);
}

SampleType sample_type(std::uint32_t bits, const ByteCursor& cursor) {
  switch (bits) {
    case 8:
      return SampleType::u8;
    case 16:
      return SampleType::u16;
    case 32:
      return SampleType::u32;
    default:
      cursor.fail(fmt::format("an image has pixels of {} bits; known are 8, 16 and 32", bits),
                  kSaveAgain);
  }
}

Array2 read_image(ByteCursor& cursor, std::uint64_t offset) {
  cursor.seek(offset);
  const std::uint32_t nx = cursor.u32(Endian::little), ny = cursor.u32(Endian::little);
  const SampleType type = sample_type(cursor.u32(Endian::little), cursor);
  const std::uint32_t compression = cursor.u32(Endian::little);
  if (compression != 0) {
    cursor.fail(fmt::format("an image is compressed by method {}", compression), kSaveAgain);
  }
  cursor.skip(4 + 4 + 4 + kPaletteBytes);  // bytes, range of the palette, palette
  return read_block(cursor, type, Endian::little, nx, ny, "pixels");
}

class Conditions {
 public:
  Conditions(ByteCursor& cursor, std::uint64_t offset) : cursor_(cursor), offset_(offset) {
    cursor.seek(offset);
    cursor.require(n_conditions, 4, "conditions of the measurement");
  }
  std::uint32_t operator[](int place) const {
    return u32_at(cursor_, offset_ + 4 * static_cast<std::uint64_t>(place));
  }

 private:
  ByteCursor& cursor_;
  std::uint64_t offset_;
};

std::vector<Channel> read_vk4(ByteCursor& cursor, const ReadOptions& options) {
  const std::string& where = cursor.where();
  const auto offset_at = [&](int place) {
    return std::uint64_t{u32_at(cursor, kOffsets + 4 * static_cast<std::uint64_t>(place))};
  };
  const std::uint64_t table_end = kOffsets + 4 * n_offsets;
  if (offset_at(conditions) < table_end) {
    throw InputError(where,
                     fmt::format("its conditions of the measurement begin at byte {}, inside what "
                                 "is the table of offsets of a .vk4",
                                 offset_at(conditions)),
                     kSaveAgain);
  }
  const Conditions measured(cursor, offset_at(conditions));
  std::vector<Channel> channels;
  const auto add = [&](const char* name, int first_place, double scale, const char* unit) {
    for (int i = 0; i < n_images_of_a_kind; ++i) {
      const std::uint64_t offset = offset_at(first_place + i);
      if (offset == 0) continue;
      channels.push_back(
          make_channel(i == 0 ? std::string(name) : fmt::format("{} {}", name, i + 1), unit,
                       read_image(cursor, offset), scale, where));
    }
  };
  add("height", height, measured[step_z] * kPicometre, "m");
  if (is_wanted(options, false, !channels.empty())) add("light", light, 1.0, "1");
  if (channels.empty()) throw InputError(where, "holds no image of heights or light", kSaveAgain);
  for (Channel& channel : channels) {
    set_pitch(channel, measured[pitch_x] * kPicometre, measured[pitch_y] * kPicometre, where);
    add_setting(channel, "date",
                fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", measured[year],
                            measured[year + 1], measured[year + 2], measured[year + 3],
                            measured[year + 4], measured[year + 5]));
    add_setting(channel, "lens magnification", measured[lens] / 10.0);
  }
  return channels;
}

class KeyenceReader final : public Reader {
 public:
  std::string_view name() const override { return "keyence-vk"; }
  std::string_view description() const override { return "Keyence VK"; }
  std::vector<std::string> extensions() const override { return {".vk3", ".vk4", ".vk6", ".vk7"}; }
  int score(const Probe& probe) const override { return is_vk(probe.head) ? 95 : 0; }

  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    ByteCursor cursor(path);
    const std::string head(cursor.bytes(std::min<std::uint64_t>(cursor.size(), 4)));
    if (!is_vk(head)) {
      throw InputError(path.string(), "does not begin with VK3_, VK4_, VK6 or VK7", kSaveAgain);
    }
    if (is_bare(head)) return read_vk4(cursor, options);
    // What lies before the archive is the instrument's own; the archive begins at its first file.
    const auto archive_begin = find_archive(cursor);
    if (!archive_begin) throw InputError(path.string(), "holds no zip archive", kSaveAgain);
    try {
      return read_archive(ZipArchive(path, *archive_begin), options);
    } catch (const InputError&) {
      // Perhaps the archive's own offsets count from the beginning of the file.
      try {
        return read_archive(ZipArchive(path), options);
      } catch (const InputError&) {
      }
      throw;
    }
  }

 private:
  static bool is_bare(std::string_view head) {
    return head.starts_with("VK3_") || head.starts_with("VK4_");
  }

  static std::optional<std::uint64_t> find_archive(ByteCursor& cursor) {
    constexpr std::string_view kFirstFile = "PK\x03\x04";
    constexpr std::uint64_t kAtOnce = 60000;
    for (std::uint64_t begin = 0; begin < cursor.size(); begin += kAtOnce) {
      cursor.seek(begin);
      const auto found =
          cursor.bytes(std::min(cursor.remaining(), kAtOnce + kFirstFile.size())).find(kFirstFile);
      if (found != std::string_view::npos) return begin + found;
    }
    return std::nullopt;
  }

  static std::vector<Channel> read_archive(const ZipArchive& archive, const ReadOptions& options) {
    const auto entry = archive.find("Vk4File");
    if (!entry) throw InputError(archive.where(), "its archive has no file Vk4File", kSaveAgain);
    const std::string inner = archive.read(*entry, kMostInnerBytes);
    if (!is_bare(inner)) {
      throw InputError(archive.place(*entry), "does not begin with VK4_", kSaveAgain);
    }
    ByteCursor cursor(inner, archive.place(*entry));
    return read_vk4(cursor, options);
  }

  static constexpr std::uint64_t kMostInnerBytes = std::uint64_t{4} << 30;
};

}  // namespace

const Reader& keyence_vk_reader() {
  static const KeyenceReader reader;
  return reader;
}

}  // namespace manoscope::io
