#include "manoscope/io/file_units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/io/file_text.hpp"
#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

TEST(FileUnits, LengthsAreUnderstoodInTheSpellingsOfInstruments) {
  // One conversion by udunits: round-off only.
  const auto near = [](const char* unit, double factor) {
    const auto scale = length_scale(unit);
    ASSERT_TRUE(scale) << unit;
    EXPECT_NEAR(scale->factor, factor, 1e-14 * factor) << unit;
  };
  near("m", 1.0);
  near(" nm ", 1e-9);
  near("\xC2\xB5m", 1e-6);  // UTF-8 micro sign
  near("\xCE\xBCm", 1e-6);  // UTF-8 Greek mu
  near("\xB5m", 1e-6);      // Latin-1 micro sign
  near("Microns", 1e-6);
  near("\xC3\x85", 1e-10);  // A with ring, UTF-8
  near("\xC5", 1e-10);      // the same in Latin-1
  EXPECT_FALSE(length_scale("V"));
  EXPECT_FALSE(length_scale(""));
  EXPECT_FALSE(length_scale("furlongish"));
}

TEST(FileUnits, EveryUnitIsCarriedToSi) {
  EXPECT_EQ(si_unit("mV", "f").name, "V");
  EXPECT_NEAR(si_unit("mV", "f").scale.to_si(5.0), 5e-3, 1e-17);
  EXPECT_EQ(si_unit("", "f").name, "");
  EXPECT_EQ(si_unit("%", "f").name, "1");
  EXPECT_EQ(si_unit("1", "f").name, "1");
  EXPECT_EQ(si_unit("mm2", "f").name, "mm2");  // no name listed: kept as it is
  EXPECT_TRUE(testing::contains(testing::complaint([] { si_unit("blub", "a.gsf"); }),
                                "a.gsf | names an unknown unit \"blub\""));
}

TEST(FileUnits, ScalingTurnsWhatIsNoValueIntoNan) {
  Array2 values(1, 5);
  constexpr double kInf = std::numeric_limits<double>::infinity();
  values << 2.0, kInf, std::numeric_limits<double>::quiet_NaN(), 1e308, -3.0;
  scale_values(values, UnitScale{1e3, 0.5}, "f");
  EXPECT_EQ(values(0, 0), 2000.5);
  EXPECT_TRUE(std::isnan(values(0, 1)) && std::isnan(values(0, 2)) && std::isnan(values(0, 3)));
  EXPECT_EQ(values(0, 4), -2999.5);
  EXPECT_THROW(scale_values(values, UnitScale{0.0, 0.0}, "f"), InputError);
  EXPECT_THROW(scale_values(values, UnitScale{1e40, 0.0}, "f"), InputError);
}

TEST(FileUnits, AbsurdSizesAreRefused) {
  EXPECT_NO_THROW(check_pixel_counts(4096, 768, "f"));
  for (const auto& [nx, ny] : {std::pair{0.0, 5.0}, std::pair{1e5, 1e5}, std::pair{1e300, 1e300}}) {
    EXPECT_THROW(check_pixel_counts(nx, ny, "f"), InputError) << nx << " x " << ny;
  }
  EXPECT_NO_THROW(checked_pitch(1e-6, "XReal", "f"));
  for (const double pitch : {0.0, -1e-6, 1e-15, 1e6, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(checked_pitch(pitch, "XReal", "f"), InputError) << pitch;
  }
}

TEST(FileText, ExcerptsAreShortAndHarmless) {
  EXPECT_EQ(excerpt(" a\x1b[31mb\n"), "a [31mb");
  EXPECT_EQ(excerpt(std::string(1000, 'x')), std::string(60, 'x') + "...");
  // Never half a UTF-8 letter: byte 60 falls into the 31st of these two-byte letters.
  std::string umlauts = "x";
  for (int i = 0; i < 50; ++i) umlauts += "\xC3\xB6";
  EXPECT_EQ(excerpt(umlauts).size(), 59U + 3U);
}

}  // namespace
}  // namespace manoscope::io
