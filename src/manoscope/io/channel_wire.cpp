#include "manoscope/io/channel_wire.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "manoscope/io/byte_cursor.hpp"
#include "manoscope/io/file_units.hpp"

namespace manoscope::io {
namespace {

constexpr std::uint64_t kMagic = 0x31304e4843414e4dU;  // "MNACHN01"
constexpr std::uint64_t kEnd = 0x21444e4548434e4dU;
constexpr std::uint64_t kChannels = 1, kError = 2;
constexpr std::uint64_t kMostText = 1 << 16, kMostItems = 4096;

void put(const WireSink& sink, std::uint64_t value) { sink(&value, sizeof(value)); }
void put(const WireSink& sink, double value) { sink(&value, sizeof(value)); }
void put(const WireSink& sink, std::string_view text) {
  text = text.substr(0, kMostText);
  put(sink, static_cast<std::uint64_t>(text.size()));
  sink(text.data(), text.size());
}

std::uint64_t number(const WireSource& source) {
  std::uint64_t value = 0;
  source(&value, sizeof(value));
  return value;
}

std::uint64_t number(const WireSource& source, std::uint64_t most) {
  const std::uint64_t value = number(source);
  if (value > most) throw BrokenAnswer("a count beyond its limit");
  return value;
}

std::string text(const WireSource& source) {
  std::string value(number(source, kMostText), '\0');
  source(value.data(), value.size());
  return value;
}

Length pitch(const WireSource& source) {
  const double value = double_from_f64_bits(number(source));
  if (!std::isfinite(value) || value < 0.0) throw BrokenAnswer("a pitch that is none");
  return Length::from_si(value);
}

/// Offsets are signed.
Index offset(const WireSource& source) {
  const auto value = static_cast<std::int64_t>(number(source));
  constexpr std::int64_t kMost = std::int64_t{1} << 40;
  if (value > kMost || value < -kMost) throw BrokenAnswer("an offset beyond its limit");
  return static_cast<Index>(value);
}

Channel channel(const WireSource& source, std::uintmax_t& bytes_left) {
  Channel channel;
  channel.name = text(source);
  channel.unit = text(source);
  channel.file_unit = text(source);
  channel.page = static_cast<int>(number(source, 1U << 30U));
  channel.grid.nx = static_cast<Index>(number(source, static_cast<std::uint64_t>(kMostPixels)));
  channel.grid.ny = static_cast<Index>(number(source, static_cast<std::uint64_t>(kMostPixels)));
  channel.grid.pitch_x = pitch(source);
  channel.grid.pitch_y = pitch(source);
  channel.offset_x = offset(source);
  channel.offset_y = offset(source);
  const std::uint64_t n_settings = number(source, kMostItems);
  for (std::uint64_t i = 0; i < n_settings; ++i) {
    std::string name = text(source);
    channel.settings.emplace_back(std::move(name), text(source));
  }
  const std::uint64_t n_warnings = number(source, kMostItems);
  for (std::uint64_t i = 0; i < n_warnings; ++i) channel.warnings.push_back(text(source));

  const double n_pixels =
      static_cast<double>(channel.grid.nx) * static_cast<double>(channel.grid.ny);
  if (!(n_pixels >= 1.0 && n_pixels <= kMostPixels)) throw BrokenAnswer("an absurd map");
  const auto n_bytes = static_cast<std::uintmax_t>(n_pixels) * sizeof(double);
  if (n_bytes > bytes_left) throw BrokenAnswer("more values than the limit");
  bytes_left -= n_bytes;
  channel.values.resize(channel.grid.ny, channel.grid.nx);
  source(channel.values.data(), n_bytes);
  for (Index i = 0; i < channel.values.size(); ++i) {
    double& value = channel.values.data()[i];
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    value = double_from_f64_bits(bits);
  }
  return channel;
}

}  // namespace

void write_channels(const std::vector<Channel>& channels, const WireSink& sink) {
  put(sink, kMagic);
  put(sink, kChannels);
  put(sink, static_cast<std::uint64_t>(channels.size()));
  for (const Channel& channel : channels) {
    put(sink, channel.name);
    put(sink, channel.unit);
    put(sink, channel.file_unit);
    put(sink, static_cast<std::uint64_t>(channel.page));
    put(sink, static_cast<std::uint64_t>(channel.grid.nx));
    put(sink, static_cast<std::uint64_t>(channel.grid.ny));
    put(sink, channel.grid.pitch_x.si());
    put(sink, channel.grid.pitch_y.si());
    put(sink, static_cast<std::uint64_t>(channel.offset_x));
    put(sink, static_cast<std::uint64_t>(channel.offset_y));
    const std::size_t n_settings = std::min<std::size_t>(channel.settings.size(), kMostItems);
    put(sink, static_cast<std::uint64_t>(n_settings));
    for (std::size_t i = 0; i < n_settings; ++i) {
      put(sink, channel.settings[i].first);
      put(sink, channel.settings[i].second);
    }
    const std::size_t n_warnings = std::min<std::size_t>(channel.warnings.size(), kMostItems);
    put(sink, static_cast<std::uint64_t>(n_warnings));
    for (std::size_t i = 0; i < n_warnings; ++i) put(sink, channel.warnings[i]);
    sink(channel.values.data(), static_cast<std::size_t>(channel.values.size()) * sizeof(double));
  }
  put(sink, kEnd);
}

void write_error(const InputError& error, const WireSink& sink) {
  put(sink, kMagic);
  put(sink, kError);
  put(sink, error.where());
  put(sink, error.found());
  put(sink, error.mend());
  put(sink, kEnd);
}

std::vector<Channel> read_answer(const WireSource& source, std::uintmax_t most_bytes) {
  if (number(source) != kMagic) throw BrokenAnswer("another protocol");
  const std::uint64_t kind = number(source);
  if (kind == kError) {
    std::string where = text(source), found = text(source), mend = text(source);
    if (number(source) != kEnd || found.empty()) throw BrokenAnswer("no end");
    throw InputError(std::move(where), std::move(found), std::move(mend));
  }
  if (kind != kChannels) throw BrokenAnswer("an unknown kind of answer");
  const std::uint64_t n = number(source, kMostItems);
  if (n == 0) throw BrokenAnswer("no channels");
  std::vector<Channel> channels;
  for (std::uint64_t i = 0; i < n; ++i) channels.push_back(channel(source, most_bytes));
  if (number(source) != kEnd) throw BrokenAnswer("no end");
  return channels;
}

}  // namespace manoscope::io
