#include "manoscope/core/colour_map.hpp"

#include <algorithm>
#include <cmath>

namespace manoscope {

Rgb viridis(double place) {
  // Its table at 0, 1/16, ... 1.
  constexpr std::array<Rgb, 17> kTable{{{68, 1, 84},
                                        {72, 24, 106},
                                        {71, 45, 123},
                                        {66, 64, 134},
                                        {59, 82, 139},
                                        {51, 99, 141},
                                        {44, 114, 142},
                                        {38, 130, 142},
                                        {33, 145, 140},
                                        {31, 160, 136},
                                        {40, 174, 128},
                                        {63, 188, 115},
                                        {94, 201, 98},
                                        {132, 212, 75},
                                        {173, 220, 48},
                                        {216, 226, 25},
                                        {253, 231, 37}}};
  const double at = 16.0 * std::clamp(place, 0.0, 1.0);
  const auto below = std::min<std::size_t>(15, static_cast<std::size_t>(at));
  const double part = at - static_cast<double>(below);
  Rgb colour{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = (1.0 - part) * kTable[below][i] + part * kTable[below + 1][i];
    colour[i] = static_cast<std::uint8_t>(std::lround(value));
  }
  return colour;
}

}  // namespace manoscope
