#pragma once

#include <limits>
#include <span>
#include <string_view>

#include "manoscope/core/arrays.hpp"
#include "manoscope/io/byte_cursor.hpp"
#include "manoscope/io/reader.hpp"

namespace manoscope::io {

/// How one sample of a binary block is written.
enum class SampleType { u8, i8, u16, i16, u32, i32, f32, f64 };

/// Bytes of one sample.
std::uint64_t sample_bytes(SampleType type);

/// Reads as many samples as `values` has room for; every type fits a double exactly.
/// @throws InputError if the bytes do not suffice.
void read_samples(ByteCursor& cursor, SampleType type, Endian order, std::span<double> values);

/// A block of ny rows of nx samples, first row first.
///
/// Room is made only after the file is seen to hold the block. `what` names it in messages.
/// @throws InputError if a count is 0 or absurd, or the file ends before the block does.
Array2 read_block(ByteCursor& cursor, SampleType type, Endian order, std::uint64_t nx,
                  std::uint64_t ny, std::string_view what);

/// As read_block(), for a block of columns that each run from the bottom row to the top one.
Array2 read_columns_from_below(ByteCursor& cursor, SampleType type, Endian order, std::uint64_t nx,
                               std::uint64_t ny, std::string_view what);

/// Makes NaN of every sample for which `is_missing(sample)` holds. NaN are passed over.
template <class IsMissing>
void mark_missing(Array2& values, IsMissing is_missing) {
  for (Index i = 0; i < values.size(); ++i) {
    double& value = values.data()[i];
    if (value == value && is_missing(value)) value = std::numeric_limits<double>::quiet_NaN();
  }
}

/// Turns the rows of a map over, where a file begins with the bottom row.
void turn_rows_over(Array2& values);

/// A channel of SI heights or of plain numbers from a block of raw samples: value = scale * raw.
///
/// What is not finite, or beyond what an instrument can mean, becomes NaN.
/// @param unit  "m" for heights, "1" for intensities, "" where the file names none.
/// @throws InputError(where, ...) if the scale is absurd.
Channel make_channel(std::string name, std::string unit, Array2 raw, double scale,
                     const std::string& where);

/// False for a picture beside the heights where only heights were asked for: it need not be read.
/// In a file without heights everything is wanted, so that the message about it can say what is
/// there.
bool is_wanted(const ReadOptions& options, bool holds_heights, bool file_has_heights);

/// Refuses more channels than any instrument writes into one file, before each is described at
/// length.
/// @throws InputError(where, ...) for more than 64.
void check_channel_count(std::uint64_t n_channels, const std::string& where);

/// Sets the lateral scale of a channel in m per pixel; 0 = the file gives none.
/// @throws InputError(where, ...) if a pitch is neither 0 nor between 1e-12 m and 1e3 m.
void set_pitch(Channel& channel, double pitch_x_m, double pitch_y_m, const std::string& where);

/// Adds a setting where the file has one: empty texts are left out, control codes become blanks,
/// Latin-1 letters are carried to UTF-8.
void add_setting(Channel& channel, std::string_view name, std::string_view value);

/// A number and its unit, as a setting: "632.8 nm". What is not finite is left out.
void add_setting(Channel& channel, std::string_view name, double value, std::string_view unit = "");

}  // namespace manoscope::io
