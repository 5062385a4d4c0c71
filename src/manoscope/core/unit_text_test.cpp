#include "manoscope/core/unit_text.hpp"

#include <gtest/gtest.h>

#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope {
namespace {

TEST(UnitText, ReadsTheUnitsPeopleWrite) {
  // Round-off of one conversion, in parts of the value.
  constexpr double kRelative = 1e-14;
  const auto near = [](double value, double expected) {
    EXPECT_NEAR(value, expected, kRelative * std::abs(expected));
  };
  near(parse_quantity<FlowRate>("70 mL/min", "t").si(), 70e-6 / 60.0);
  near(parse_quantity<Length>("175 um", "t").si(), 175e-6);
  near(parse_quantity<Length>("175 µm", "t").si(), 175e-6);
  near(parse_quantity<Length>("175µm", "t").si(), 175e-6);
  near(parse_quantity<Length>("175 μm", "t").si(), 175e-6);  // Greek mu
  near(parse_quantity<Pressure>("2.3 kPa", "t").si(), 2300.0);
  near(parse_quantity<Pressure>("-1.5 mbar", "t").si(), -150.0);
  near(parse_quantity<Viscosity>("0.89 mPa s", "t").si(), 0.89e-3);
  near(parse_quantity<Viscosity>("1 cP", "t").si(), 1e-3);
  near(parse_quantity<Pressure>("1 mmH2O", "t").si(), 9.80665);
  near(parse_quantity<Density>("998 kg/m3", "t").si(), 998.0);
  near(parse_quantity<Density>("0.998 g/cm^3", "t").si(), 998.0);
  near(parse_quantity<Angle>("0.3 deg", "t").si(), 0.3 * std::numbers::pi / 180.0);
  near(parse_quantity<Length>("+1.5e-3 m", "t").si(), 1.5e-3);
}

TEST(UnitText, RefusesWhatIsNotAQuantityOfTheRightKind) {
  for (const char* text : {"175", "", "um", "175 kPa", "175 umm", "nan um", "inf m", "1e999 m",
                           "0x10 um", "175 2", "1 s/m", "1 1/m", "1,5 mm"}) {
    EXPECT_THROW(parse_quantity<Length>(text, "channel.height"), InputError) << text;
  }
}

TEST(UnitText, SaysWhatWasFoundAndWhatToWrite) {
  try {
    parse_quantity<Length>("175 kPa", "experiment.toml:4: channel.height");
    FAIL();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("experiment.toml:4: channel.height"), std::string::npos);
    EXPECT_NE(text.find("\"175 kPa\" is not a length"), std::string::npos) << text;
    EXPECT_NE(text.find("\"175 um\""), std::string::npos) << text;
  }
}

TEST(UnitText, TemperatureScalesHaveAnOffset) {
  const auto celsius = unit_scale("degC", "K");
  ASSERT_TRUE(celsius);
  EXPECT_NEAR(celsius->to_si(25.0), 298.15, 1e-9);  // udunits keeps 273.15 exactly
}

TEST(UnitText, NumbersUseAPointWhateverTheLocale) {
  EXPECT_EQ(parse_number(" 1.5e3 "), 1500.0);
  EXPECT_EQ(parse_number("1,5"), std::nullopt);
  EXPECT_EQ(parse_number(""), std::nullopt);
}

}  // namespace
}  // namespace manoscope
