#pragma once

#include <span>
#include <string>

namespace manoscope::io {

/// The step of positions that rise evenly, in their own unit.
///
/// @throws InputError(where, ...) if a position is no number, they do not rise, or one departs from
///         even spacing by more than 1e-6 of the whole length.
double even_step(std::span<const double> positions, const std::string& where);

}  // namespace manoscope::io
