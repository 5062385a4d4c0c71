// Gwyddion's own files (.gwy).
//
// Source: "Gwyddion file format", gwyddion.net/documentation/user-guide-en/gwyfile-format.html. The
// letters GWYP and one object; an object is its type's name, a length and components, each a name,
// a letter for its type and a value; everything little-endian. Channel n is the GwyDataField
// "/n/data", with the rows from the top in base SI units, "/n/data/title" and the mask "/n/mask":
// masked pixels count as missing, which is how Gwyddion's own import of instrument files marks
// them.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/byte_cursor.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"

namespace manoscope::io {
namespace {

constexpr const char* kSaveAgain = "Save the file in Gwyddion again";

/// Channels beyond this are not of a measurement.
constexpr std::size_t kMostChannels = 1000;

/// One component of an object; `value` is what follows the letter of its type.
struct Component {
  std::string_view name;
  char type = 0;
  std::string_view value;
};

/// Walks over the components of one object. Nested objects are handed out whole: whoever knows them
/// walks over them in turn, so that no file decides how deep the program goes.
class Components {
 public:
  /// @param bytes  the object from its type's name on; the rest behind it is not looked at.
  Components(std::string_view bytes, const std::string& where) : cursor_(bytes, where) {
    type_ = cursor_.zero_terminated();
    const std::uint32_t size = cursor_.u32(Endian::little);
    cursor_.require(size, 1, "bytes of an object");
    end_ = cursor_.offset() + size;
  }

  std::string_view type() const { return type_; }
  std::uint64_t end() const { return end_; }

  bool next(Component& component) {
    if (cursor_.offset() >= end_) return false;
    component.name = cursor_.zero_terminated();
    component.type = static_cast<char>(cursor_.u8());
    const std::uint64_t start = cursor_.offset();
    pass(component.type);
    if (cursor_.offset() > end_) {
      cursor_.fail(fmt::format("\"{}\" reaches beyond its object", excerpt(component.name)),
                   kSaveAgain);
    }
    const std::uint64_t length = cursor_.offset() - start;
    cursor_.seek(start);
    component.value = cursor_.bytes(length);
    return true;
  }

 private:
  void pass_object() {
    static_cast<void>(cursor_.zero_terminated());
    cursor_.skip(cursor_.u32(Endian::little));
  }

  void pass(char type) {
    switch (type) {
      case 'b':
      case 'c':
        return cursor_.skip(1);
      case 'i':
        return cursor_.skip(4);
      case 'q':
      case 'd':
        return cursor_.skip(8);
      case 's':
        static_cast<void>(cursor_.zero_terminated());
        return;
      case 'o':
        return pass_object();
      default:
        break;
    }
    const std::uint64_t n = cursor_.u32(Endian::little);
    switch (type) {
      case 'C':
        return cursor_.skip(n);
      case 'I':
        return cursor_.skip(4 * n);
      case 'Q':
      case 'D':
        return cursor_.skip(8 * n);
      case 'S':
        for (std::uint64_t i = 0; i < n; ++i) static_cast<void>(cursor_.zero_terminated());
        return;
      case 'O':
        for (std::uint64_t i = 0; i < n; ++i) pass_object();
        return;
      default:
        cursor_.fail(fmt::format("has a component of unknown type {:d}", static_cast<int>(type)),
                     kSaveAgain);
    }
  }

  ByteCursor cursor_;
  std::string_view type_;
  std::uint64_t end_ = 0;
};

std::string_view text_value(const Component& component) {
  return component.value.substr(0, component.value.find('\0'));
}

/// The unit that a GwySIUnit object names.
std::string unit_text(std::string_view object, const std::string& where) {
  Components components(object, where);
  Component component;
  while (components.next(component)) {
    if (component.name == "unitstr" && component.type == 's') {
      return std::string(text_value(component).substr(0, 200));
    }
  }
  return {};
}

/// A GwyDataField as stored.
struct Field {
  double nx = 0.0, ny = 0.0, x_real = 0.0, y_real = 0.0, x_off = 0.0, y_off = 0.0;
  std::string unit_xy, unit_z;
  std::string_view data;  ///< of the array: its length and the numbers

  /// @throws InputError if the sizes contradict each other.
  Field(std::string_view object, const std::string& where) {
    Components components(object, where);
    Component component;
    while (components.next(component)) {
      ByteCursor value(component.value, where);
      const std::string_view name = component.name;
      if (component.type == 'i' && name == "xres") nx = value.i32(Endian::little);
      if (component.type == 'i' && name == "yres") ny = value.i32(Endian::little);
      if (component.type == 'd' && name == "xreal") x_real = value.f64(Endian::little);
      if (component.type == 'd' && name == "yreal") y_real = value.f64(Endian::little);
      if (component.type == 'd' && name == "xoff") x_off = value.f64(Endian::little);
      if (component.type == 'd' && name == "yoff") y_off = value.f64(Endian::little);
      if (component.type == 'o' && name == "si_unit_xy")
        unit_xy = unit_text(component.value, where);
      if (component.type == 'o' && name == "si_unit_z") unit_z = unit_text(component.value, where);
      if (component.type == 'D' && name == "data") data = component.value;
    }
    check_pixel_counts(nx, ny, where);
    const std::uint64_t n = data.empty() ? 0 : ByteCursor(data, where).u32(Endian::little);
    if (static_cast<double>(n) != nx * ny) {
      throw InputError(where, fmt::format("{} x {} pixels are announced, {} are there", nx, ny, n),
                       kSaveAgain);
    }
  }
};

/// What one channel number of the file collects.
struct Parts {
  std::string_view data, mask;  ///< objects
  std::string title;
  std::string_view meta;
};

Length pitch(double real, double n, const std::string& unit, const ReadOptions& options,
             const char* what, const std::string& where) {
  const auto scale = length_scale(unit.empty() ? options.lateral_unit : unit);
  if (!std::isfinite(real) || std::abs(real) > 1e30) {
    throw InputError(where, fmt::format("{} is {}", what, number_text(real)), kSaveAgain);
  }
  if (!scale || real == 0.0) return {};
  return Length::from_si(checked_pitch(scale->to_si(real) / n, what, where));
}

void mark_missing(Array2& values, std::string_view mask_object, Channel& channel,
                  const std::string& where) {
  const Field mask(mask_object, where + ", its mask");
  if (static_cast<Index>(mask.nx) != values.cols() ||
      static_cast<Index>(mask.ny) != values.rows()) {
    throw InputError(where, fmt::format("its mask has {} x {} pixels", mask.nx, mask.ny),
                     kSaveAgain);
  }
  ByteCursor cursor(mask.data, where);
  cursor.skip(4);
  Index n_masked = 0;
  for (Index i = 0; i < values.size(); ++i) {
    const double value = cursor.f64(Endian::little);
    if (std::isnan(value) || value < 0.5) continue;
    values.data()[i] = std::numeric_limits<double>::quiet_NaN();
    ++n_masked;
  }
  channel.settings.emplace_back("masked pixels, counted as missing", fmt::format("{}", n_masked));
}

class GwyReader final : public Reader {
 public:
  std::string_view name() const override { return "gwy"; }
  std::string_view description() const override { return "Gwyddion native"; }
  std::vector<std::string> extensions() const override { return {".gwy"}; }
  int score(const Probe& probe) const override {
    return probe.head.starts_with("GWYP") || probe.head.starts_with("GWYO") ? 100 : 0;
  }

  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    const std::string where = path.string();
    const std::string bytes = read_file(path);
    if (!bytes.starts_with("GWYP")) {
      throw InputError(where,
                       bytes.starts_with("GWYO") ? "is of Gwyddion 1, a format no longer in use"
                                                 : "does not begin with GWYP",
                       "Open it in Gwyddion 2 and save it again");
    }
    std::vector<Channel> channels;
    for (const auto& [number, parts] : collect(std::string_view(bytes).substr(4), where)) {
      if (!parts.data.empty()) {
        channels.push_back(channel(parts, options, fmt::format("{}: channel {}", where, number)));
      }
    }
    if (channels.empty()) {
      throw InputError(where, "holds no image channel", "Save the file with the height channel");
    }
    return channels;
  }

 private:
  static std::map<std::uint64_t, Parts> collect(std::string_view bytes, const std::string& where) {
    Components components(bytes, where);
    if (components.type() != "GwyContainer") {
      throw InputError(where,
                       fmt::format("holds a {}, not a GwyContainer", excerpt(components.type())),
                       kSaveAgain);
    }
    std::map<std::uint64_t, Parts> found;
    Component component;
    while (components.next(component)) {
      std::string_view key = component.name;
      if (!key.starts_with('/')) continue;
      key.remove_prefix(1);
      const auto slash = key.find('/');
      if (slash == std::string_view::npos || slash == 0 || slash > 9) continue;
      std::uint64_t number = 0;
      bool digits = true;
      for (const char letter : key.substr(0, slash)) {
        digits = digits && letter >= '0' && letter <= '9';
        number = 10 * number + static_cast<std::uint64_t>(digits ? letter - '0' : 0);
      }
      if (!digits) continue;
      key.remove_prefix(slash);
      const bool is_object = component.type == 'o';
      if (is_object && key == "/data" && is_of_type(component.value, "GwyDataField")) {
        found[number].data = component.value;
      } else if (is_object && key == "/mask" && is_of_type(component.value, "GwyDataField")) {
        found[number].mask = component.value;
      } else if (is_object && key == "/meta" && is_of_type(component.value, "GwyContainer")) {
        found[number].meta = component.value;
      } else if (component.type == 's' && key == "/data/title") {
        found[number].title = one_line(text_value(component).substr(0, 200));
      }
      if (found.size() > kMostChannels) {
        throw InputError(where, fmt::format("has more than {} channels", kMostChannels),
                         kSaveAgain);
      }
    }
    return found;
  }

  static bool is_of_type(std::string_view object, std::string_view type) {
    return object.starts_with(type) && object.size() > type.size() && object[type.size()] == '\0';
  }

  static Channel channel(const Parts& parts, const ReadOptions& options, const std::string& where) {
    const Field field(parts.data, where);
    Channel channel;
    channel.name = parts.title;
    channel.grid.nx = static_cast<Index>(field.nx);
    channel.grid.ny = static_cast<Index>(field.ny);
    channel.grid.pitch_x = pitch(field.x_real, field.nx, field.unit_xy, options, "xreal", where);
    channel.grid.pitch_y = pitch(field.y_real, field.ny, field.unit_xy, options, "yreal", where);
    channel.file_unit = field.unit_z;
    const SiUnit unit = si_unit(field.unit_z, where);
    channel.unit = unit.name;
    channel.values.resize(channel.grid.ny, channel.grid.nx);
    ByteCursor cursor(field.data, where);
    cursor.skip(4);
    for (Index i = 0; i < channel.values.size(); ++i) {
      channel.values.data()[i] = cursor.f64(Endian::little);
    }
    scale_values(channel.values, unit.scale, where);
    for (const auto& [name, offset] :
         {std::pair{"offset x", field.x_off}, std::pair{"offset y", field.y_off}}) {
      if (std::isfinite(offset) && offset != 0.0) {
        channel.settings.emplace_back(name,
                                      fmt::format("{:g} {}", offset, one_line(field.unit_xy)));
      }
    }
    if (!parts.mask.empty()) mark_missing(channel.values, parts.mask, channel, where);
    add_meta(parts.meta, channel, where);
    return channel;
  }

  static void add_meta(std::string_view meta, Channel& channel, const std::string& where) {
    constexpr std::size_t kMostSettings = 500;
    if (meta.empty()) return;
    Components components(meta, where);
    Component component;
    while (channel.settings.size() < kMostSettings && components.next(component)) {
      if (component.type != 's') continue;
      channel.settings.emplace_back(one_line(component.name.substr(0, 100)),
                                    one_line(text_value(component).substr(0, 1000)));
    }
  }
};

}  // namespace

const Reader& gwy_reader() {
  static const GwyReader reader;
  return reader;
}

}  // namespace manoscope::io
