#include "manoscope/wall/clamped_wall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {

void ClampedWall::validate() const {
  const auto refuse = [](const std::string& found, const char* mend) {
    throw InputError("clamped wall", found, mend);
  };
  const auto need_positive = [&](const char* name, double value, double scale, const char* unit,
                                 const char* mend) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      refuse(fmt::format("{} is {:g} {}", name, value / scale, unit), mend);
    }
  };
  need_positive("length", length.si(), 1e-3, "mm", "Give a positive length such as \"15.5 mm\"");
  need_positive("width", width.si(), 1e-3, "mm", "Give a positive width such as \"1.7 mm\"");
  need_positive("thickness", thickness.si(), 1e-6, "um",
                "Give a positive thickness such as \"0.2 um\"");
  need_positive("youngs_modulus", youngs_modulus.si(), 1e9, "GPa",
                "Give a positive modulus such as \"250 GPa\"");
  if (!(poisson_ratio > -1.0 && poisson_ratio <= 0.5)) {
    refuse(fmt::format("poisson_ratio is {:g}", poisson_ratio), "Give a value in (-1, 0.5]");
  }
  if (!std::isfinite(prestress.si()) || std::abs(prestress.si()) > youngs_modulus.si()) {
    refuse(fmt::format("prestress is {:g} MPa", prestress.in(MPa)),
           "Give a finite stress well below Young's modulus, tension positive");
  }
  if (!(shear_correction >= 0.0 && shear_correction <= 1.0)) {
    refuse(fmt::format("shear_correction is {:g}", shear_correction),
           "Give a value in (0, 1] such as 0.8333, or 0 for a wall rigid in shear");
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

double ClampedWall::bending_stiffness() const {
  const double t = thickness.si();
  return youngs_modulus.si() * t * t * t / (12.0 * (1.0 - poisson_ratio * poisson_ratio));
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

}  // namespace manoscope::wall
