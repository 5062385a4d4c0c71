#include "manoscope/maps/registration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::maps {
namespace {

constexpr double kLength = 15.5e-3, kWidth = 1.7e-3, kReach = kWidth / 3.14159265358979;

/// The linear wall zeta - L^2 zeta'' = c p with p = p0 + g x, held at both ends: its exact answer.
double tensioned(double x, double p0, double g, double reach = kReach) {
  const double c = 2e-9;
  if (x <= 0.0 || x >= kLength) return 0.0;
  const double end = p0 + g * kLength;
  return c * (p0 + g * x - p0 * std::exp(-x / reach) - end * std::exp(-(kLength - x) / reach));
}

/// Its profile seen by pixels of 16 um in a map that has slipped by `shift`.
Profile seen(double p0, double g, double shift, double noise = 0.0, std::uint64_t seed = 0) {
  const Index n = 968;
  const double pitch = 16e-6;
  RandomStream random(seed, "profile");
  Profile profile;
  profile.x = Array1::LinSpaced(n, 0.5 * pitch, (static_cast<double>(n) - 0.5) * pitch);
  profile.zeta = Array1(n);
  for (Index i = 0; i < n; ++i) {
    profile.zeta[i] = tensioned(profile.x[i] - shift, p0, g) + noise * random.normal();
  }
  profile.uncertainty.independent = Array1::Constant(n, noise);
  profile.uncertainty.modes.push_back({"shift of m", "registration", Array1::Constant(n, 5e-9)});
  profile.flags = Flags1::Zero(n);
  return profile;
}

std::vector<const Profile*> views(const std::vector<Profile>& profiles) {
  std::vector<const Profile*> found;
  for (const Profile& profile : profiles) found.push_back(&profile);
  return found;
}

TEST(Registration, FindsTheShiftsOfHydrostaticMapsAndOfFlowMaps) {
  std::vector<Profile> hydrostatic, flow;
  const double shifts[] = {0.0, 3e-6, -7e-6, 30e-6, -46e-6};  // up to three pixels
  for (int i = 0; i < 5; ++i) hydrostatic.push_back(seen(4e3 * (i + 1), 0.0, shifts[i]));
  // Pressures that fall by a tenth, a quarter and all but a tenth over the channel.
  const double flow_shifts[] = {-5e-6, 8e-6, 2e-6}, falls[] = {0.1, 0.25, 0.9};
  for (int i = 0; i < 3; ++i) {
    flow.push_back(seen(15e3, -15e3 * falls[i] / kLength, flow_shifts[i]));
  }
  const Registration found = register_profiles(views(hydrostatic), views(flow),
                                               Length::from_si(kLength), Length::from_si(kWidth));
  ASSERT_TRUE(found.offset.has_value());
  for (std::size_t i = 0; i < 5; ++i) {
    ASSERT_TRUE(found.hydrostatic[i].has_value());
    EXPECT_NEAR((found.hydrostatic[i]->shift + found.offset->shift).si(), shifts[i], 0.15e-6) << i;
    EXPECT_LT(found.hydrostatic[i]->uncertainty.si(), 0.5e-6);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(found.flow[i].has_value());
    const double error = (found.flow[i]->shift + found.offset->shift).si() - flow_shifts[i];
    // The gradient that the straight line through the profile takes out, and the rest of it.
    EXPECT_LT(std::abs(error), 0.5e-6) << i;
    EXPECT_LT(std::abs(error), 2.0 * found.flow[i]->uncertainty.si()) << i;
  }
}

TEST(Registration, ReadsAFlowTowardsSmallerPressuresAtTheOtherEndAlike) {
  std::vector<Profile> hydrostatic{seen(5e3, 0.0, 0.0), seen(15e3, 0.0, 0.0)};
  std::vector<Profile> flow{seen(1e3, 10e3 / kLength, 6e-6)};
  const Registration found = register_profiles(views(hydrostatic), views(flow),
                                               Length::from_si(kLength), Length::from_si(kWidth));
  ASSERT_TRUE(found.flow[0].has_value());
  EXPECT_NEAR(found.flow[0]->shift.si(), 6e-6, 0.5e-6);
}

TEST(Registration, TakesEachFractionFromTheMapsThatShowIt) {
  // Pixels so large that only the walls of long reach, those of the lowest levels, pass a tenth of
  // their height inside the profile: the others are no measure of how far the wall reaches.
  const auto coarse = [](double p0, double g, double shift) {
    const double pitch = 40e-6;
    Profile profile = seen(p0, g, shift);
    const Index n = 387;
    profile.x = Array1::LinSpaced(n, 0.5 * pitch, (static_cast<double>(n) - 0.5) * pitch);
    profile.zeta = profile.uncertainty.independent = Array1::Zero(n);
    profile.uncertainty.modes.clear();
    profile.flags = Flags1::Zero(n);
    for (Index i = 0; i < n; ++i) {
      // The reach at the end that registers a flow map.
      const double reach = kReach * (1.0 + std::exp(-p0 / 4e3));
      profile.zeta[i] = tensioned(profile.x[i] - shift, p0, g, reach);
    }
    return profile;
  };
  std::vector<Profile> hydrostatic, flow;
  for (int i = 1; i <= 10; ++i) hydrostatic.push_back(coarse(2e3 * i, 0.0, 0.0));
  const double shifts[] = {-5e-6, 8e-6};
  for (const double shift : shifts) flow.push_back(coarse(15e3, -5e3 / kLength, shift));
  const Registration found = register_profiles(views(hydrostatic), views(flow),
                                               Length::from_si(kLength), Length::from_si(kWidth));
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(found.flow[i].has_value());
    const double error = found.flow[i]->shift.si() - shifts[i];
    EXPECT_LT(std::abs(error), 2.0 * found.flow[i]->uncertainty.si()) << i;
    // Cubic interpolation over 40 um of e^(-x/0.54 mm), and the straight line between levels.
    EXPECT_LT(std::abs(error), 1e-6) << i;
  }
}

TEST(Registration, TellsANoiseThatItsErrorsHave) {
  double square = 0.0;
  int n = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    std::vector<Profile> hydrostatic;
    for (std::uint64_t i = 0; i < 4; ++i) {
      hydrostatic.push_back(seen(3e3 * static_cast<double>(i + 1), 0.0, 0.0, 30e-9, 10 * seed + i));
    }
    const Registration found = register_profiles(views(hydrostatic), {}, Length::from_si(kLength),
                                                 Length::from_si(kWidth));
    for (const auto& shift : found.hydrostatic) {
      ASSERT_TRUE(shift.has_value());
      square += std::pow(shift->shift / shift->uncertainty, 2);
      ++n;
    }
  }
  // Shifts against their own mean; the floor of 0.1 um and the model's share make the uncertainty
  // the larger one, but never twice what it need be.
  EXPECT_LT(square / n, 1.3);
  EXPECT_GT(square / n, 0.2);
}

TEST(Registration, LeavesAloneWhatShowsNoEnds) {
  std::vector<Profile> hydrostatic{seen(20.0, 0.0, 5e-6), seen(8e3, 0.0, 0.0),
                                   seen(16e3, 0.0, 0.0)};
  std::vector<Profile> flow{seen(50.0, 0.0, 5e-6)};
  const Registration found = register_profiles(views(hydrostatic), views(flow),
                                               Length::from_si(kLength), Length::from_si(kWidth));
  EXPECT_FALSE(found.hydrostatic[0].has_value());
  EXPECT_TRUE(found.hydrostatic[1].has_value());
  EXPECT_FALSE(found.flow[0].has_value());
  const Registration none =
      register_profiles({}, views(flow), Length::from_si(kLength), Length::from_si(kWidth));
  EXPECT_FALSE(none.offset.has_value());
  EXPECT_THROW(register_profiles({}, {}, Length{}, Length::from_si(kWidth)), InputError);
}

TEST(MoveProfile, GivesTheProfileThatAMapInPlaceWouldHaveShown) {
  for (const double shift : {0.0, 4e-6, -7e-6, 40e-6}) {
    Profile moved = seen(9e3, -2e5, shift);
    const Profile in_place = seen(9e3, -2e5, 0.0);
    move_profile(moved, {Length::from_si(shift), 1.0 * um}, "m", 5.0 * um);
    Index good = 0;
    for (Index i = 0; i < moved.x.size(); ++i) {
      if (moved.flags[i] != 0) continue;
      ++good;
      // At the very ends the wall has a kink, which no interpolation follows.
      if (moved.x[i] < 80e-6 || moved.x[i] > kLength - 80e-6) continue;
      // Fourth order: 0.023 (16 um/0.54 mm)^4 of 18 um.
      EXPECT_NEAR(moved.zeta[i], in_place.zeta[i], 1e-12) << i;
    }
    EXPECT_GE(good, moved.x.size() - 4);
    EXPECT_DOUBLE_EQ(moved.uncertainty.modes[0].effect[5], 1e-9);
  }
}

TEST(MoveProfile, DoesNotReadFlaggedStations) {
  Profile profile = seen(9e3, 0.0, 0.0);
  profile.flags[100] = StationFlag::no_data;
  profile.zeta[100] = 1.0;
  move_profile(profile, {4.0 * um, 1.0 * um}, "m", 5.0 * um);
  EXPECT_NE(profile.flags[99], 0);
  EXPECT_NE(profile.flags[100], 0);
  for (const Index i : {97, 98, 101, 102}) {
    EXPECT_EQ(profile.flags[i], 0);
    EXPECT_LT(profile.zeta[i], 30e-6);
  }
}

}  // namespace
}  // namespace manoscope::maps
