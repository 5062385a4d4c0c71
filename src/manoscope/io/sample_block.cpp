#include "manoscope/io/sample_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"

namespace manoscope::io {
namespace {

void check_block(const ByteCursor& cursor, SampleType type, std::uint64_t nx, std::uint64_t ny,
                 std::string_view what) {
  check_pixel_counts(static_cast<double>(nx), static_cast<double>(ny), cursor.where());
  cursor.require(nx * ny, sample_bytes(type), what);
}

/// The unsigned number of sizeof(Raw) bytes at `at`.
template <class Raw>
Raw raw_at(const char* at, Endian order) {
  Raw raw = 0;
  for (unsigned i = 0; i < sizeof(Raw); ++i) {
    const unsigned shift = 8 * (order == Endian::little ? i : sizeof(Raw) - 1 - i);
    raw = static_cast<Raw>(
        raw | static_cast<Raw>(static_cast<Raw>(static_cast<unsigned char>(at[i])) << shift));
  }
  return raw;
}

/// Fills `values` with as many samples, some at a time: a file need not be in memory as a whole.
template <class Raw, class ToDouble>
void fill(ByteCursor& cursor, Endian order, std::span<double> values, ToDouble to_double) {
  constexpr std::size_t kAtOnce = 8192;
  for (std::size_t first = 0; first < values.size(); first += kAtOnce) {
    const auto part = values.subspan(first, std::min(kAtOnce, values.size() - first));
    const char* at = cursor.bytes(sizeof(Raw) * part.size()).data();
    for (double& value : part) {
      value = to_double(raw_at<Raw>(at, order));
      at += sizeof(Raw);
    }
  }
}

template <class Number, class Raw>
double as_number(Raw raw) {
  return static_cast<double>(static_cast<Number>(raw));
}

bool is_utf8(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size()) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    const int n_more = lead < 0x80                    ? 0
                       : lead >= 0xc2 && lead < 0xe0  ? 1
                       : lead >= 0xe0 && lead < 0xf0  ? 2
                       : lead >= 0xf0 && lead <= 0xf4 ? 3
                                                      : -1;
    if (n_more < 0) return false;
    for (int more = 0; more < n_more; ++more) {
      if (i == text.size() || (static_cast<unsigned char>(text[i++]) & 0xc0U) != 0x80U) {
        return false;
      }
    }
  }
  return true;
}

std::string utf8_from_latin1(std::string_view text) {
  std::string out;
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (code < 0x80) {
      out += letter;
    } else {
      out += static_cast<char>(0xc0U | code >> 6);
      out += static_cast<char>(0x80U | (code & 0x3fU));
    }
  }
  return out;
}

}  // namespace

std::uint64_t sample_bytes(SampleType type) {
  switch (type) {
    case SampleType::u8:
    case SampleType::i8:
      return 1;
    case SampleType::u16:
    case SampleType::i16:
      return 2;
    case SampleType::u32:
    case SampleType::i32:
    case SampleType::f32:
      return 4;
    case SampleType::f64:
      break;
  }
  return 8;
}

void read_samples(ByteCursor& cursor, SampleType type, Endian order, std::span<double> values) {
  cursor.require(values.size(), sample_bytes(type), "samples");
  switch (type) {
    case SampleType::u8:
      return fill<std::uint8_t>(cursor, order, values, as_number<std::uint8_t, std::uint8_t>);
    case SampleType::i8:
      return fill<std::uint8_t>(cursor, order, values, as_number<std::int8_t, std::uint8_t>);
    case SampleType::u16:
      return fill<std::uint16_t>(cursor, order, values, as_number<std::uint16_t, std::uint16_t>);
    case SampleType::i16:
      return fill<std::uint16_t>(cursor, order, values, as_number<std::int16_t, std::uint16_t>);
    case SampleType::u32:
      return fill<std::uint32_t>(cursor, order, values, as_number<std::uint32_t, std::uint32_t>);
    case SampleType::i32:
      return fill<std::uint32_t>(cursor, order, values, as_number<std::int32_t, std::uint32_t>);
    case SampleType::f32:
      return cursor.f32_array(order, values);
    case SampleType::f64:
      return fill<std::uint64_t>(cursor, order, values, double_from_f64_bits);
  }
}

Array2 read_block(ByteCursor& cursor, SampleType type, Endian order, std::uint64_t nx,
                  std::uint64_t ny, std::string_view what) {
  check_block(cursor, type, nx, ny, what);
  Array2 values(static_cast<Index>(ny), static_cast<Index>(nx));
  read_samples(cursor, type, order, {values.data(), nx * ny});
  return values;
}

Array2 read_columns_from_below(ByteCursor& cursor, SampleType type, Endian order, std::uint64_t nx,
                               std::uint64_t ny, std::string_view what) {
  check_block(cursor, type, nx, ny, what);
  Array2 values(static_cast<Index>(ny), static_cast<Index>(nx));
  std::vector<double> column(ny);
  for (Index ix = 0; ix < values.cols(); ++ix) {
    read_samples(cursor, type, order, column);
    for (Index iy = 0; iy < values.rows(); ++iy) {
      values(values.rows() - 1 - iy, ix) = column[static_cast<std::size_t>(iy)];
    }
  }
  return values;
}

void turn_rows_over(Array2& values) {
  for (Index iy = 0; iy < values.rows() / 2; ++iy) {
    double* row = values.data() + iy * values.cols();
    double* mirrored = values.data() + (values.rows() - 1 - iy) * values.cols();
    std::swap_ranges(row, row + values.cols(), mirrored);
  }
}

Channel make_channel(std::string name, std::string unit, Array2 raw, double scale,
                     const std::string& where) {
  if (!std::isfinite(scale)) {
    throw InputError(where, "its height scale is not a finite number", "Export the map again");
  }
  Channel channel;
  channel.name = std::move(name);
  channel.unit = std::move(unit);
  channel.file_unit = channel.unit;
  channel.values = std::move(raw);
  channel.grid.nx = channel.values.cols();
  channel.grid.ny = channel.values.rows();
  UnitScale to_si;
  to_si.factor = scale;
  scale_values(channel.values, to_si, where);
  return channel;
}

bool is_wanted(const ReadOptions& options, bool holds_heights, bool file_has_heights) {
  return holds_heights || !file_has_heights || !options.heights_only;
}

void check_channel_count(std::uint64_t n_channels, const std::string& where) {
  constexpr std::uint64_t kMost = 64;
  if (n_channels <= kMost) return;
  throw InputError(where, fmt::format("announces {} channels", n_channels),
                   fmt::format("Files of up to {} channels are read; export it again", kMost));
}

void set_pitch(Channel& channel, double pitch_x_m, double pitch_y_m, const std::string& where) {
  const auto pitch = [&](double value, std::string_view axis) {
    if (value == 0.0) return Length{};
    return Length::from_si(checked_pitch(value, fmt::format("its scale in {}", axis), where));
  };
  channel.grid.pitch_x = pitch(std::isnan(pitch_x_m) ? 0.0 : pitch_x_m, "x");
  channel.grid.pitch_y = pitch(std::isnan(pitch_y_m) ? 0.0 : pitch_y_m, "y");
}

void add_setting(Channel& channel, std::string_view name, std::string_view value) {
  const auto readable = [](std::string_view text) {
    text = trimmed(text);
    return one_line(is_utf8(text) ? std::string(text) : utf8_from_latin1(text));
  };
  const std::string text = readable(value);
  if (!text.empty()) channel.settings.emplace_back(readable(name), text);
}

void add_setting(Channel& channel, std::string_view name, double value, std::string_view unit) {
  if (!std::isfinite(value)) return;
  add_setting(channel, name, fmt::format("{:.10g}{}{}", value, unit.empty() ? "" : " ", unit));
}

}  // namespace manoscope::io
