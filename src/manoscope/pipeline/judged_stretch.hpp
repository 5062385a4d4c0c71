// What the parts of `judge` share: the truth at the stations of a result, and where it is judged.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/results/measurement.hpp"
#include "manoscope/twin/truth.hpp"

namespace manoscope::pipeline {

/// Linear interpolation of y(x) to other stations; the end values are held beyond the ends.
Array1 interpolate(const Array1& x, const Array1& y, const Array1& at);

/// The truth of the run of that name.
/// @throws InputError if there is none.
const twin::RunTruth& find_truth(const twin::Truth& truth, const std::string& run);

/// The stretch of a run that is judged, m: [start, end], or what is absent from its test section;
/// NaN where it has none.
std::array<double, 2> judged_stretch(const results::Measurement& measurement, Index run,
                                     std::optional<Length> start, std::optional<Length> end);

/// 1 at the stations in [start, end]; nowhere if either is NaN.
Flags1 within(const Array1& x, double start, double end);

/// `inside` without the stations that hold no value.
Flags1 answers(const Flags1& inside, const Array1& values);

/// Levels of a truth and of a result are the same if their labels agree to this, Pa: lists give one
/// digit.
inline constexpr double kSameLabel = 0.1;

}  // namespace manoscope::pipeline
