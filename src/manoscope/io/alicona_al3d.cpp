// Alicona Imaging (.al3d).
//
// Source: "AL3D format", Alicona Imaging, and the description in Gwyddion's import module alicona.
// A mark of 17 bytes; tags of 52 bytes: a key of 20, a value of 30 as text, CR LF; a comment. The
// tags name where the depth image (32-bit floats in m, little-endian) and the planes of textures
// (bytes) lie. Rows run from the top and are padded to a multiple of 8 bytes.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"

namespace manoscope::io {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic = "AliconaImaging\0\r\n"sv;
constexpr std::uint64_t kKeyBytes = 20, kValueBytes = 30, kMostTags = 200;
constexpr const char* kSaveAgain = "Export the map to .al3d again";

class Tags {
 public:
  explicit Tags(ByteCursor& cursor) : where_(cursor.where()) {
    cursor.seek(kMagic.size());
    read_tag(cursor);  // Version
    read_tag(cursor);  // TagCount
    const std::uint64_t n_tags = count("TagCount");
    cursor.require(n_tags, kKeyBytes + kValueBytes + 2, "tags");
    if (n_tags > kMostTags) {
      cursor.fail(fmt::format("announces {} tags, where at most {} are known", n_tags, kMostTags),
                  kSaveAgain);
    }
    for (std::uint64_t i = 0; i < n_tags; ++i) read_tag(cursor);
  }

  const std::map<std::string, std::string>& all() const { return values_; }

  std::string text(const std::string& key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? std::string() : found->second;
  }

  double number(const std::string& key) const {
    const auto value = parse_number(text(key));
    if (!value) {
      throw InputError(where_,
                       fmt::format("its {} is \"{}\", not a number", key, excerpt(text(key))),
                       kSaveAgain);
    }
    return *value;
  }

  /// 0 where the file has no such tag.
  std::uint64_t count(const std::string& key) const {
    if (text(key).empty()) return 0;
    const double value = number(key);
    if (!std::isfinite(value) || value < 0.0 || value > 9e15 || value != std::floor(value)) {
      throw InputError(where_, fmt::format("its {} is {}", key, excerpt(text(key))), kSaveAgain);
    }
    return static_cast<std::uint64_t>(value);
  }

 private:
  void read_tag(ByteCursor& cursor) {
    const std::string key = cursor.text(kKeyBytes);
    const std::string value = cursor.text(kValueBytes);
    if (cursor.bytes(2) != "\r\n") cursor.fail("a tag does not end with a new line", kSaveAgain);
    values_.emplace(key, value);
  }

  std::string where_;
  std::map<std::string, std::string> values_;
};

/// A block whose rows are padded to a multiple of 8 bytes.
Array2 read_padded_rows(ByteCursor& cursor, std::uint64_t offset, SampleType type, std::uint64_t nx,
                        std::uint64_t ny, std::string_view what) {
  const std::uint64_t row_bytes = (nx * sample_bytes(type) + 7) / 8 * 8;
  cursor.seek(offset);
  cursor.require(ny, row_bytes, what);
  Array2 values(static_cast<Index>(ny), static_cast<Index>(nx));
  for (std::uint64_t iy = 0; iy < ny; ++iy) {
    cursor.seek(offset + iy * row_bytes);
    read_samples(cursor, type, Endian::little, {values.data() + iy * nx, nx});
  }
  return values;
}

/// Names of the texture planes, by the tags that point to them: "TexturePtr" = "0;1;2".
std::map<std::uint64_t, std::string> plane_names(const Tags& tags) {
  std::map<std::uint64_t, std::string> names;
  for (const auto& [key, value] : tags.all()) {
    if (!key.ends_with("Ptr")) continue;
    std::string_view rest = value;
    for (int part = 1; !rest.empty(); ++part) {
      const auto end = rest.find(';');
      const auto plane = parse_number(rest.substr(0, end));
      const bool several = value.find(';') != std::string::npos;
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
      if (!plane || !(std::isfinite(*plane) && *plane >= 0.0 && *plane < 64.0)) continue;
      const std::string name = key.substr(0, key.size() - 3);
      names.emplace(static_cast<std::uint64_t>(*plane),
                    several ? fmt::format("{} {}", name, part) : name);
    }
  }
  return names;
}

class AliconaReader final : public Reader {
 public:
  std::string_view name() const override { return "alicona-al3d"; }
  std::string_view description() const override { return "Alicona Imaging"; }
  std::vector<std::string> extensions() const override { return {".al3d"}; }
  int score(const Probe& probe) const override { return probe.head.starts_with(kMagic) ? 100 : 0; }

  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    ByteCursor cursor(path);
    if (!cursor.file_begins_with(kMagic)) {
      throw InputError(path.string(), "does not begin with \"AliconaImaging\"", kSaveAgain);
    }
    const Tags tags(cursor);
    const std::uint64_t nx = tags.count("Cols"), ny = tags.count("Rows");
    check_pixel_counts(static_cast<double>(nx), static_cast<double>(ny), path.string());

    std::vector<Channel> channels;
    if (const std::uint64_t offset = tags.count("DepthImageOffset"); offset > 0) {
      Array2 depth = read_padded_rows(cursor, offset, SampleType::f32, nx, ny, "rows of depth");
      drop_invalid(depth, tags);
      channels.push_back(make_channel("depth", "m", std::move(depth), 1.0, path.string()));
    }
    const std::uint64_t n_planes = tags.count("NumberOfPlanes");
    const std::uint64_t textures = tags.count("TextureImageOffset");
    if (textures > 0 && is_wanted(options, false, !channels.empty())) {
      check_channel_count(n_planes, path.string());
      const auto names = plane_names(tags);
      const std::uint64_t plane_bytes = (nx + 7) / 8 * 8 * ny;
      for (std::uint64_t i = 0; i < n_planes; ++i) {
        const auto found = names.find(i);
        Array2 plane = read_padded_rows(cursor, textures + i * plane_bytes, SampleType::u8, nx, ny,
                                        "rows of a texture");
        channels.push_back(
            make_channel(found == names.end() ? fmt::format("plane {}", i) : found->second, "1",
                         std::move(plane), 1.0, path.string()));
      }
    }
    if (channels.empty()) {
      throw InputError(path.string(), "holds neither a depth image nor a texture", kSaveAgain);
    }
    for (Channel& channel : channels) finish(channel, tags, path.string());
    return channels;
  }

 private:
  static void drop_invalid(Array2& depth, const Tags& tags) {
    if (tags.text("InvalidPixelValue").empty()) return;
    const auto invalid = parse_number(tags.text("InvalidPixelValue"));
    if (!invalid || !std::isfinite(*invalid)) return;  // NaN marks itself
    // The tag writes the mark in fewer digits than the float has.
    const double tolerance = 1e-6 * std::abs(*invalid);
    mark_missing(depth, [&](double value) { return std::abs(value - *invalid) <= tolerance; });
  }

  static void finish(Channel& channel, const Tags& tags, const std::string& where) {
    const auto pitch = [&](const std::string& key) {
      return tags.text(key).empty() ? 0.0 : std::abs(tags.number(key));
    };
    set_pitch(channel, pitch("PixelSizeXMeter"), pitch("PixelSizeYMeter"), where);
    for (const auto& [key, value] : tags.all()) {
      if (key != "DirSpacer" && key != "PlaceHolder" && !key.ends_with("Offset") &&
          !key.ends_with("Ptr")) {
        add_setting(channel, key, value);
      }
    }
  }
};

}  // namespace

const Reader& alicona_al3d_reader() {
  static const AliconaReader reader;
  return reader;
}

}  // namespace manoscope::io
