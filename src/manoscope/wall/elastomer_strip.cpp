#include "manoscope/wall/elastomer_strip.hpp"

#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {

ElastomerStrip::ElastomerStrip(const WallSection& section) : section_(section) {
  section.validate("elastomer strip");
  if (!(section.shear_correction > 0.0)) {
    throw InputError("elastomer strip", "shear correction is 0: a wall rigid in shear",
                     "Give a value such as 0.8333 (5/6), or use the plate strip");
  }
  const double a = section.half_width();
  bent_ = a * a * a * a / (24.0 * section.bending_stiffness());
  sheared_ = a * a / (2.0 * section.shear_stiffness());
}

double ElastomerStrip::shape(Length /*crest*/, double s) const {
  if (!(std::abs(s) < 1.0)) return 0.0;
  const double parabola = 1.0 - s * s;
  return (bent_ * parabola + sheared_) * parabola / (bent_ + sheared_);
}

double ElastomerStrip::mean_over_crest(Length /*crest*/) const {
  return (8.0 / 15.0 * bent_ + 2.0 / 3.0 * sheared_) / (bent_ + sheared_);
}

}  // namespace manoscope::wall
