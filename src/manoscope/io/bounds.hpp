#pragma once

#include <numbers>
#include <optional>
#include <string>

#include "manoscope/core/units.hpp"
#include "manoscope/io/faults.hpp"

namespace manoscope::io {

/// What a value must lie within to be believed, in SI, and what to say to whoever went beyond.
///
/// The limits catch slips of unit and decimal mark, they are no claim about what can be measured.
struct Bounds {
  double low, high;  ///< both allowed, unless `above_low`
  bool above_low;    ///< `low` itself is refused
  const char* mend;
  const char* example = nullptr;  ///< of such a value, "1.7 mm"; nullptr = that of its unit
  const char* advice = "";        ///< what to know before filling it in: a clause, or ""
};

/// SI unit of a quantity with the words messages need.
struct UnitInfo {
  const char* si = nullptr;  ///< nullptr = no unit
  const char* kind = "";
  const char* example = "";
};

template <class Q>
constexpr UnitInfo unit_info() {
  return {UnitOf<Q>::name, UnitOf<Q>::kind, UnitOf<Q>::example};
}

namespace bounds {

inline constexpr Bounds kLength{0.0, 1.0, true, "A micro-channel is between 0 and 1 m long",
                                "15.5 mm"};
inline constexpr Bounds kWidth{0.0, 0.1, true, "A micro-channel is between 0 and 10 cm wide",
                               "1.7 mm"};
inline constexpr Bounds kHeight{
    0.0, 0.01, true, "The gap under the undeflected wall lies between 0 and 1 cm", "175 um"};
inline constexpr Bounds kLengthUncertainty{
    0.0, 0.01, false, "A standard uncertainty is zero or positive, here at most 1 cm", "0.5 um"};
inline constexpr Bounds kOrigin{-1.0, 1.0, false, "The corner lies within 1 m of the first pixel",
                                "0.4 mm"};
inline constexpr Bounds kRotation{
    -std::numbers::pi / 4, std::numbers::pi / 4, false,
    "The rotation is what is left after `flow` chose the axis: at most 45 deg either way"};
inline constexpr Bounds kThickness{0.0, 0.1, true, "A wall is between 0 and 10 cm thick", "0.2 um"};
inline constexpr Bounds kModulus{
    0.0, 1e13, true, "Young's modulus is positive, diamond has 1.2 TPa: check the unit", "250 GPa"};
inline constexpr Bounds kPrestress{
    -1e11, 1e11, false, "A prestress beyond 100 GPa breaks any wall: check the unit", "100 MPa"};
inline constexpr Bounds kPoissonRatio{-1.0, 0.5, true,
                                      "Poisson's ratio of an isotropic solid lies in (-1, 0.5]"};
inline constexpr Bounds kViscosity{
    0.0, 1e4, true,
    "A dynamic viscosity is positive (water 1 mPa s, air 18 uPa s): check the unit"};
inline constexpr Bounds kDensity{0.0, 3e4, true,
                                 "A density is positive and below that of osmium (22 590 kg/m3)"};
inline constexpr Bounds kPixelPitch{0.0, 1e-2, true, "A pixel is between 0 and 1 cm wide",
                                    "1.5 um"};
inline constexpr Bounds kHeightNoise{
    0.0, 1e-3, false, "A standard deviation is zero or positive, here at most 1 mm", "20 nm"};
inline constexpr Bounds kWavelength{1e-7, 2e-5, false, "Light is between 100 nm and 20 um long",
                                    "600 nm"};
inline constexpr Bounds kPressureUncertainty{
    0.0, 1e8, false, "A standard uncertainty is zero or positive, here at most 100 MPa", "5 Pa"};
inline constexpr Bounds kPressureNoise{
    0.0,
    1e8,
    false,
    "A standard deviation is zero or positive, here at most 100 MPa",
    "10 Pa",
    "the standard deviation of one reading of the gauge at rest, from its data sheet or from "
    "repeated readings; \"0 Pa\" claims an exact gauge"};
inline constexpr Bounds kViscosityUncertainty{
    0.0, 1e4, false, "A standard uncertainty is zero or positive: check the unit", "0.01 mPa s"};
inline constexpr Bounds kRelativeFlowUncertainty{
    0.0, 0.5, false, "The standard uncertainty of the flow rate is a fraction: 0.01 means 1 %"};
inline constexpr Bounds kGainUncertainty{
    0.0, 0.5, false, "The gain's standard uncertainty is a fraction: 0.002 means 0.2 %"};
inline constexpr Bounds kGaugePressure{
    -1.1e5, 1e8, false,
    "Give the gauge pressure: no lower than a vacuum (-101 kPa), here at most 100 MPa"};
inline constexpr Bounds kPressureDrop{-1e8, 1e8, false,
                                      "A drop lies within 100 MPa either way: check the unit"};
inline constexpr Bounds kFlowRate{
    0.0, 1e-3, false,
    "A flow rate is zero or positive (`flow` in [channel] gives its direction) and below 1 L/s"};
inline constexpr Bounds kTime{-1e11, 1e11, false, "A time lies within 3000 years: check the unit"};

}  // namespace bounds

/// Adds a fault for a value beyond its bounds, or not finite. `written` is the value as in the
/// file, `si_unit` may be nullptr.
/// @return True if the value can be used.
bool check_bounds(double value, const Bounds& bounds, const std::string& written,
                  const char* si_unit, const Place& place, Faults& faults);

/// True for the "?" that a drafted experiment holds where only the user knows the value.
bool is_placeholder(const std::string& text);

/// The unit's words with the example that fits the field.
UnitInfo with_example(UnitInfo unit, const Bounds& bounds);

/// The SI value of a text like "175 um".
/// @return nullopt, with a fault added, if it is a placeholder, no quantity of the kind, or beyond
///         its bounds.
std::optional<double> checked_quantity(const std::string& text, const UnitInfo& unit,
                                       const Bounds& bounds, const Place& place, Faults& faults);

}  // namespace manoscope::io
