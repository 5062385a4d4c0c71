#pragma once

#include <compare>
#include <numbers>

namespace manoscope {

/// A physical scalar: a double in SI that knows its dimension kg^M m^L s^T rad^A.
///
/// Adding a length to a pressure does not compile; products and ratios carry their dimension, and a
/// ratio of equals is a plain double. There is no conversion from double: write `175.0 * um`.
template <int M, int L, int T, int A = 0>
class Quantity {
 public:
  constexpr Quantity() = default;
  static constexpr Quantity from_si(double value) { return Quantity(value); }

  constexpr double si() const { return value_; }
  /// The number of `unit`s: `gap.in(um)`.
  constexpr double in(Quantity unit) const { return value_ / unit.value_; }

  constexpr Quantity operator-() const { return Quantity(-value_); }
  constexpr Quantity& operator+=(Quantity other) {
    value_ += other.value_;
    return *this;
  }
  constexpr Quantity& operator-=(Quantity other) {
    value_ -= other.value_;
    return *this;
  }
  friend constexpr Quantity operator+(Quantity a, Quantity b) { return a += b; }
  friend constexpr Quantity operator-(Quantity a, Quantity b) { return a -= b; }
  friend constexpr Quantity operator*(double factor, Quantity a) {
    return Quantity(factor * a.value_);
  }
  friend constexpr Quantity operator*(Quantity a, double factor) { return factor * a; }
  friend constexpr Quantity operator/(Quantity a, double divisor) {
    return Quantity(a.value_ / divisor);
  }
  friend constexpr auto operator<=>(Quantity, Quantity) = default;
  friend constexpr bool operator==(Quantity, Quantity) = default;

 private:
  constexpr explicit Quantity(double value) : value_(value) {}
  double value_ = 0.0;
};

template <int M1, int L1, int T1, int A1, int M2, int L2, int T2, int A2>
constexpr auto operator*(Quantity<M1, L1, T1, A1> a, Quantity<M2, L2, T2, A2> b) {
  if constexpr (M1 + M2 == 0 && L1 + L2 == 0 && T1 + T2 == 0 && A1 + A2 == 0) {
    return a.si() * b.si();
  } else {
    return Quantity<M1 + M2, L1 + L2, T1 + T2, A1 + A2>::from_si(a.si() * b.si());
  }
}

template <int M1, int L1, int T1, int A1, int M2, int L2, int T2, int A2>
constexpr auto operator/(Quantity<M1, L1, T1, A1> a, Quantity<M2, L2, T2, A2> b) {
  if constexpr (M1 == M2 && L1 == L2 && T1 == T2 && A1 == A2) {
    return a.si() / b.si();
  } else {
    return Quantity<M1 - M2, L1 - L2, T1 - T2, A1 - A2>::from_si(a.si() / b.si());
  }
}

using Length = Quantity<0, 1, 0>;
using Time = Quantity<0, 0, 1>;
using Pressure = Quantity<1, -1, -2>;   ///< gauge pressure; also stress and elastic modulus
using FlowRate = Quantity<0, 3, -1>;    ///< volumetric
using Viscosity = Quantity<1, -1, -1>;  ///< dynamic
using KinematicViscosity = Quantity<0, 2, -1>;
using Density = Quantity<1, -3, 0>;
using Velocity = Quantity<0, 1, -1>;
using Angle = Quantity<0, 0, 0, 1>;

inline constexpr Length metre = Length::from_si(1.0);
inline constexpr Length mm = Length::from_si(1e-3);
inline constexpr Length um = Length::from_si(1e-6);
inline constexpr Length nm = Length::from_si(1e-9);
inline constexpr Time second = Time::from_si(1.0);
inline constexpr Pressure Pa = Pressure::from_si(1.0);
inline constexpr Pressure kPa = Pressure::from_si(1e3);
inline constexpr Pressure MPa = Pressure::from_si(1e6);
inline constexpr Pressure GPa = Pressure::from_si(1e9);
inline constexpr FlowRate mL_per_min = FlowRate::from_si(1e-6 / 60.0);
inline constexpr Viscosity mPa_s = Viscosity::from_si(1e-3);
inline constexpr Density kg_per_m3 = Density::from_si(1.0);
inline constexpr Angle rad = Angle::from_si(1.0);
inline constexpr Angle deg = Angle::from_si(std::numbers::pi / 180.0);

/// The SI unit of a quantity as udunits and the result file write it.
template <class Q>
struct UnitOf;
template <>
struct UnitOf<Length> {
  static constexpr const char* name = "m";
  static constexpr const char* kind = "length";
  static constexpr const char* example = "175 um";
};
template <>
struct UnitOf<Time> {
  static constexpr const char* name = "s";
  static constexpr const char* kind = "time";
  static constexpr const char* example = "2.5 s";
};
template <>
struct UnitOf<Pressure> {
  static constexpr const char* name = "Pa";
  static constexpr const char* kind = "pressure";
  static constexpr const char* example = "2.3 kPa";
};
template <>
struct UnitOf<FlowRate> {
  static constexpr const char* name = "m3 s-1";
  static constexpr const char* kind = "flow rate";
  static constexpr const char* example = "70 mL/min";
};
template <>
struct UnitOf<Viscosity> {
  static constexpr const char* name = "Pa s";
  static constexpr const char* kind = "dynamic viscosity";
  static constexpr const char* example = "0.89 mPa s";
};
template <>
struct UnitOf<Density> {
  static constexpr const char* name = "kg m-3";
  static constexpr const char* kind = "density";
  static constexpr const char* example = "998 kg/m3";
};
template <>
struct UnitOf<Angle> {
  static constexpr const char* name = "rad";
  static constexpr const char* kind = "angle";
  static constexpr const char* example = "0.3 deg";
};

}  // namespace manoscope
