#include "manoscope/wall/clamped_wall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/wall/plate_strip.hpp"

namespace manoscope::wall {

void ClampedWall::validate() const {
  const auto refuse = [](const std::string& found, const char* mend) {
    throw InputError("clamped wall", found, mend);
  };
  if (!(length.si() > 0.0) || !std::isfinite(length.si())) {
    refuse(fmt::format("length is {:g} mm", length.in(mm)),
           "Give a positive length such as \"15.5 mm\"");
  }
  section().validate("clamped wall");
  if (std::abs(prestress.si()) > youngs_modulus.si()) {
    refuse(fmt::format("prestress is {:g} MPa", prestress.in(MPa)),
           "Give a stress well below Young's modulus, tension positive");
  }
  if (!std::isfinite(preload.load.si()) || !(std::abs(preload.lopsidedness) <= 2.0)) {
    refuse(fmt::format("preload is {:g} Pa with lopsidedness {:g}", preload.load.si(),
                       preload.lopsidedness),
           "Give a finite load and a lopsidedness in [-2, 2]");
  }
  if (!std::isfinite(initial_shape.crest.si()) || !(std::abs(initial_shape.lopsidedness) <= 2.0)) {
    refuse(fmt::format("initial shape has crest {:g} um and lopsidedness {:g}",
                       initial_shape.crest.in(um), initial_shape.lopsidedness),
           "Give a finite crest and a lopsidedness in [-2, 2]");
  }
}

double ClampedWall::edge_layer(Pressure pressure) const {
  const double a = 0.5 * width.si(), t = thickness.si(), bending = bending_stiffness();
  const double stretch = 12.0 * bending / (t * t);
  const double tension = std::max(prestress.si(), 0.0) * t, p = std::abs(pressure.si());
  const auto law = [&](double z) {
    const double slope = z / a;
    return (24.0 * bending / (a * a) + 2.0 * tension + 4.0 / 3.0 * stretch * slope * slope) * z /
           (a * a);
  };
  double low = 0.0, high = a;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (law(middle) < p ? low : high) = middle;
  }
  const double n_mid = tension + stretch * 2.0 / 3.0 * (high / a) * (high / a);
  return n_mid > 4.0 * bending / (a * a) ? std::sqrt(bending / n_mid) : 0.5 * a;
}

Pressure ClampedWall::largest_pressure() const {
  const Length shorter = std::min(width, length), longer = std::max(width, length);
  WallSection across = section();
  across.width = shorter;
  across.prestress = std::max(prestress, Pressure{});
  const double short_ends = 1.0 + std::pow(shorter / longer, 4);
  return short_ends * PlateStrip(across).pressure(kLargestRise * 0.5 * shorter);
}

WallLoad WallLoad::uniform(Pressure pressure) {
  return along(Array1::Zero(1), Array1::Constant(1, pressure.si()));
}

WallLoad WallLoad::along(Array1 x, Array1 pressure) {
  const auto refuse = [](const std::string& found, const char* mend) {
    throw InputError("wall load", found, mend);
  };
  if (x.size() == 0 || x.size() != pressure.size()) {
    refuse(fmt::format("{} stations and {} pressures", x.size(), pressure.size()),
           "Give one pressure for each of one or more stations");
  }
  for (Index i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x(i)) || !std::isfinite(pressure(i))) {
      refuse(fmt::format("station {} is at {:g} m with {:g} Pa", i, x(i), pressure(i)),
             "Positions and pressures must be finite numbers");
    }
    if (i > 0 && !(x(i) > x(i - 1))) {
      refuse(fmt::format("station {} at {:g} m follows one at {:g} m", i, x(i), x(i - 1)),
             "Sort the stations by ascending x, each only once");
    }
  }
  WallLoad load;
  load.x_ = std::move(x);
  load.pressure_ = std::move(pressure);
  return load;
}

WallLoad WallLoad::field(std::function<double(double, double)> pressure) {
  WallLoad load;
  load.field_ = std::move(pressure);
  return load;
}

WallLoad WallLoad::plus(double share, const WallLoad& other) const {
  const bool lines = !field_ && !other.field_;
  if (lines && other.x_.size() == 1) return along(x_, pressure_ + share * other.pressure_(0));
  if (lines && x_.size() == 1) return along(other.x_, pressure_(0) + share * other.pressure_);
  if (!lines || x_.size() != other.x_.size() || (x_ != other.x_).any()) {
    throw InputError("wall load", "two loads at different stations cannot be added",
                     "Give both at the same stations, or one of them uniform");
  }
  return along(x_, pressure_ + share * other.pressure_);
}

}  // namespace manoscope::wall
