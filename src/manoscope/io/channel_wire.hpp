#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/io/reader.hpp"

namespace manoscope::io {

// The answer of the process that reads HDF5 files: channels, or why there are none. Between two
// processes of one machine and one build, so in native byte order and with a number of its own.

/// Takes the next bytes of an answer.
using WireSink = std::function<void(const void* bytes, std::size_t size)>;
/// Fills `size` bytes; throws BrokenAnswer if they end before.
using WireSource = std::function<void(void* bytes, std::size_t size)>;

/// An answer that ends early or cannot be one.
class BrokenAnswer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void write_channels(const std::vector<Channel>& channels, const WireSink& sink);
void write_error(const InputError& error, const WireSink& sink);

/// The channels of an answer.
///
/// Trusts nothing: the process that wrote it read a file that may have been made to take it over.
/// Every count is held against a limit before room is made, and every value is a number or a quiet
/// NaN.
/// @param most_bytes  what the values of all channels may take together.
/// @throws InputError if that is the answer; BrokenAnswer if it is none.
std::vector<Channel> read_answer(const WireSource& source, std::uintmax_t most_bytes);

}  // namespace manoscope::io
