#pragma once

#include <cmath>

#include "manoscope/core/random.hpp"
#include "manoscope/results/measurement.hpp"

namespace manoscope::test_support {

/// Gives every map of a measurement a picture of n_z by n_x cells: a bulge with two counts of
/// noise, one cell in a hundred missing.
inline void add_example_pictures(results::Measurement& m, Index n_z = 12, Index n_x = 40) {
  for (std::size_t i = 0; i < m.map.size(); ++i) {
    RandomStream noise(3, "pictures", i);
    MapPicture picture;
    picture.x = Array1::LinSpaced(n_x, -0.03 * m.channel_length, 1.03 * m.channel_length);
    picture.z = Array1::LinSpaced(n_z, -0.8 * m.channel_width, 0.8 * m.channel_width);
    picture.step = 1e-8 * (1.0 + 0.01 * static_cast<double>(i));
    picture.counts = Counts2(n_z, n_x);
    for (Index iz = 0; iz < n_z; ++iz) {
      for (Index ix = 0; ix < n_x; ++ix) {
        const double v = 2.0 * picture.z[iz] / m.channel_width;
        const double height = 400.0 * static_cast<double>(i) * std::max(0.0, 1.0 - v * v);
        picture.counts(iz, ix) = noise.uniform(0.0, 1.0) < 0.01
                                     ? MapPicture::kMissing
                                     : static_cast<std::int16_t>(height + 2.0 * noise.normal());
      }
    }
    m.map_picture.push_back(picture);
  }
}

}  // namespace manoscope::test_support
