#include "manoscope/core/units.hpp"

#include <gtest/gtest.h>

#include <type_traits>

namespace manoscope {
namespace {

template <class A, class B>
concept Addable = requires(A a, B b) {
  a + b;
};

TEST(Quantity, AddsOnlyWhatHasTheSameDimension) {
  static_assert(Addable<Length, Length>);
  static_assert(!Addable<Length, Pressure>);
  static_assert(!std::is_convertible_v<double, Length>);
  EXPECT_DOUBLE_EQ((1.0 * mm + 500.0 * um).in(mm), 1.5);
}

TEST(Quantity, ProductsAndRatiosCarryTheirDimension) {
  static_assert(std::is_same_v<decltype(mPa_s / kg_per_m3), KinematicViscosity>);
  static_assert(std::is_same_v<decltype(mm / um), double>);
  EXPECT_DOUBLE_EQ((60.0 * mL_per_min).si(), 1e-6);
  EXPECT_DOUBLE_EQ((180.0 * deg).si(), std::numbers::pi);
}

}  // namespace
}  // namespace manoscope
