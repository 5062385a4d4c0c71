#include "manoscope/numerics/distribution.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {
namespace {

void demand(bool good, const std::string& found, const char* mend) {
  if (!good) throw InputError("probability distribution", found, mend);
}

void demand_limits(double low, double high) {
  demand(std::isfinite(low) && std::isfinite(high) && low < high,
         fmt::format("limits are {:g} and {:g}", low, high), "Give a lower limit below the upper");
}

void demand_positive(double value, const char* name) {
  demand(std::isfinite(value) && value > 0.0, fmt::format("{} is {:g}", name, value),
         "Give a number above 0");
}

/// Exponential of mean 1.
double draw_exponential(RandomStream& random) { return -std::log1p(-random.uniform()); }

/// Gamma of scale 1: Marsaglia & Tsang 2000, "A simple method for generating gamma variables", ACM
/// TOMS 26, 363; exact.
double draw_gamma(double shape, RandomStream& random) {
  if (shape < 1.0) {  // their section 6
    const double larger = draw_gamma(shape + 1.0, random);
    return larger * std::exp(-draw_exponential(random) / shape);
  }
  const double d = shape - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
  while (true) {
    const double x = random.normal(), root = 1.0 + c * x;
    if (root <= 0.0) continue;
    const double v = root * root * root;
    const double log_u = -draw_exponential(random);
    if (log_u < 0.5 * x * x + d - d * v + d * std::log(v)) return d * v;
  }
}

}  // namespace

Distribution Distribution::normal(double mean, double sigma) {
  demand(std::isfinite(mean), fmt::format("mean is {:g}", mean), "Give a finite number");
  demand(std::isfinite(sigma) && sigma >= 0.0, fmt::format("sigma is {:g}", sigma),
         "Give 0 or more");
  return {Kind::normal, mean, sigma};
}

Distribution Distribution::rectangular(double low, double high) {
  demand_limits(low, high);
  return {Kind::rectangular, low, high};
}

Distribution Distribution::doubtful_rectangular(double low, double high, double doubt) {
  demand_limits(low, high);
  demand(doubt > 0.0 && 2.0 * doubt <= (high - low) * (1.0 + 1e-12),
         fmt::format("doubt of the limits is {:g}", doubt),
         "Give a number above 0 and up to half of the width");
  return {Kind::doubtful_rectangular, low, high, doubt};
}

Distribution Distribution::trapezoidal(double low, double high, double top) {
  demand_limits(low, high);
  demand(top >= 0.0 && top <= 1.0, fmt::format("ratio of top to base is {:g}", top),
         "Give a number in [0, 1]");
  return {Kind::trapezoidal, low, high, top};
}

Distribution Distribution::triangular(double low, double high) {
  return trapezoidal(low, high, 0.0);
}

Distribution Distribution::arcsine(double low, double high) {
  demand_limits(low, high);
  return {Kind::arcsine, low, high};
}

Distribution Distribution::student_t(double location, double scale, double degrees_of_freedom) {
  demand(std::isfinite(location), fmt::format("location is {:g}", location),
         "Give a finite number");
  demand_positive(scale, "scale");
  demand_positive(degrees_of_freedom, "number of degrees of freedom");
  return {Kind::student_t, location, scale, degrees_of_freedom};
}

Distribution Distribution::exponential(double mean) {
  demand_positive(mean, "mean");
  return {Kind::exponential, mean, 0.0};
}

Distribution Distribution::gamma(double shape, double scale) {
  demand_positive(shape, "shape");
  demand_positive(scale, "scale");
  return {Kind::gamma, shape, scale};
}

double Distribution::mean() const {
  switch (kind_) {
    case Kind::normal:
    case Kind::student_t:
    case Kind::exponential:
      return a_;
    case Kind::gamma:
      return a_ * b_;
    case Kind::rectangular:
    case Kind::doubtful_rectangular:
    case Kind::trapezoidal:
    case Kind::arcsine:
      break;
  }
  return 0.5 * (a_ + b_);
}

double Distribution::sigma() const {
  const double width = b_ - a_;
  switch (kind_) {
    case Kind::normal:
      return b_;
    case Kind::rectangular:
      return width / std::sqrt(12.0);
    case Kind::doubtful_rectangular:
      return std::sqrt(width * width / 12.0 + c_ * c_ / 9.0);
    case Kind::trapezoidal:
      return width * std::sqrt((1.0 + c_ * c_) / 24.0);
    case Kind::arcsine:
      return width / std::sqrt(8.0);
    case Kind::student_t:
      return c_ > 2.0 ? b_ * std::sqrt(c_ / (c_ - 2.0)) : std::numeric_limits<double>::infinity();
    case Kind::exponential:
      return a_;
    case Kind::gamma:
      break;
  }
  return std::sqrt(a_) * b_;
}

double Distribution::draw(RandomStream& random) const {
  switch (kind_) {
    case Kind::normal:
      return a_ + b_ * random.normal();
    case Kind::rectangular:
      return random.uniform(a_, b_);
    case Kind::doubtful_rectangular: {
      const double low = (a_ - c_) + 2.0 * c_ * random.uniform();
      return random.uniform(low, (a_ + b_) - low);
    }
    case Kind::trapezoidal: {
      const double first = (1.0 + c_) * random.uniform(), second = (1.0 - c_) * random.uniform();
      return a_ + 0.5 * (b_ - a_) * (first + second);
    }
    case Kind::arcsine:
      return 0.5 * (a_ + b_) +
             0.5 * (b_ - a_) * std::sin(2.0 * std::numbers::pi * random.uniform());
    case Kind::student_t: {
      const double z = random.normal();
      return a_ + b_ * z / std::sqrt(2.0 * draw_gamma(0.5 * c_, random) / c_);
    }
    case Kind::exponential:
      return a_ * draw_exponential(random);
    case Kind::gamma:
      break;
  }
  return b_ * draw_gamma(a_, random);
}

}  // namespace manoscope::numerics
