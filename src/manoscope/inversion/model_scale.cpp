#include "manoscope/inversion/model_scale.hpp"

#include <algorithm>
#include <cmath>

namespace manoscope::inversion {
namespace {

/// The upper end of the step around a value; of the first or last step beyond them.
Index step(const Array1& from, double value) {
  const Index above = std::upper_bound(from.begin(), from.end(), value) - from.begin();
  return std::clamp<Index>(above, 1, from.size() - 1);
}

double map(const Array1& from, const Array1& to, double value) {
  const Index k = step(from, value);
  const double share = std::clamp((value - from[k - 1]) / (from[k] - from[k - 1]), 0.0, 1.0);
  const double at = from[k - 1] + share * (from[k] - from[k - 1]);
  return to[k - 1] + share * (to[k] - to[k - 1]) + (value - at);
}

}  // namespace

ModelScale::ModelScale(const NonlocalWall& wall)
    : own_(wall.uniform.pressure), model_(own_ - wall.offset) {
  const Index n = own_.size();
  if (!(model_.tail(n - 1) > model_.head(n - 1)).all()) model_ = own_;
}

double ModelScale::to_model(double pressure) const { return map(own_, model_, pressure); }

double ModelScale::from_model(double pressure) const { return map(model_, own_, pressure); }

double ModelScale::doubt(double pressure) const {
  const Index k = step(own_, pressure);
  return 0.5 * std::abs((model_[k] - own_[k]) - (model_[k - 1] - own_[k - 1]));
}

}  // namespace manoscope::inversion
