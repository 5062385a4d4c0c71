#include "manoscope/pipeline/judged_stretch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::pipeline {
namespace {

double interpolate_one(const Array1& x, const Array1& y, double at) {
  const auto* const begin = x.data();
  const auto* const above = std::upper_bound(begin, begin + x.size(), at);
  if (above == begin) return y[0];
  if (above == begin + x.size()) return y[y.size() - 1];
  const Index i = above - begin - 1;
  return y[i] + (at - x[i]) / (x[i + 1] - x[i]) * (y[i + 1] - y[i]);
}

}  // namespace

Array1 interpolate(const Array1& x, const Array1& y, const Array1& at) {
  Array1 values(at.size());
  for (Index i = 0; i < at.size(); ++i) values[i] = interpolate_one(x, y, at[i]);
  return values;
}

const twin::RunTruth& find_truth(const twin::Truth& truth, const std::string& run) {
  for (const twin::RunTruth& candidate : truth.runs) {
    if (candidate.run == run) return candidate;
  }
  throw InputError("truth", fmt::format("holds no run \"{}\"", run),
                   "Give the truth of the same experiment");
}

std::array<double, 2> judged_stretch(const results::Measurement& m, Index run,
                                     std::optional<Length> start, std::optional<Length> end) {
  return {start ? start->si() : m.test_section(run, 0), end ? end->si() : m.test_section(run, 1)};
}

Flags1 within(const Array1& x, double start, double end) {
  Flags1 inside = Flags1::Zero(x.size());
  if (std::isnan(start) || std::isnan(end)) return inside;
  for (Index i = 0; i < x.size(); ++i) inside[i] = x[i] >= start && x[i] <= end ? 1 : 0;
  return inside;
}

Flags1 answers(const Flags1& inside, const Array1& values) {
  Flags1 answered = inside;
  for (Index i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) answered[i] = 0;
  }
  return answered;
}

}  // namespace manoscope::pipeline
