#include "manoscope/experiment/sections.hpp"

#include <fmt/format.h>

#include <cmath>

#include "manoscope/core/frame_words.hpp"

namespace manoscope::experiment {
namespace {

constexpr Word<flow::InletProfile> kInletProfiles[] = {{"developed", flow::InletProfile::developed},
                                                       {"uniform", flow::InletProfile::uniform}};

constexpr io::Bounds kSpread{0.0, 1.0, false,
                             "The spread is a fraction of the way to the other profile: 0 claims "
                             "`profile` as it stands, 1 leaves open which of the two it is"};
constexpr io::Bounds kDevelopingLength{
    0.0, 1.0, false, "The duct before x = 0 is zero or more and at most 1 m long", "2 mm"};

/// The gap is the small side: another order is a slip of unit or of name.
void check_proportions(const ChannelSection& channel, const io::TableReader& table,
                       io::Faults& faults) {
  const Length none{};
  const auto told = [](Length value) { return fmt::format("{:g} mm", value.in(mm)); };
  if (channel.height > none && channel.width > none && channel.height > channel.width) {
    faults.add(
        table.place("height"),
        fmt::format("the height, {}, is above the width, {}", told(channel.height),
                    told(channel.width)),
        "The gap under a deformable wall is at most as high as wide: check both, their units "
        "and whether they are swapped");
  } else if (channel.height > none && channel.length > none && channel.height > channel.length) {
    faults.add(table.place("height"),
               fmt::format("the height, {}, is above the length, {}", told(channel.height),
                           told(channel.length)),
               "The gap is lower than the channel is long: check both and their units");
  }
  if (channel.height_uncertainty && channel.height > none &&
      *channel.height_uncertainty >= channel.height) {
    faults.add(table.place("height_uncertainty"),
               fmt::format("the uncertainty, {}, is not below the height itself, {}",
                           told(*channel.height_uncertainty), told(channel.height)),
               "Give the standard uncertainty of the height: check its unit");
  }
}

}  // namespace

ChannelSection read_channel(io::TableReader& table, io::Faults& faults) {
  ChannelSection channel;
  channel.length =
      table.quantity<Length>("length", io::bounds::kLength, io::Need::required).value_or(Length{});
  channel.width =
      table.quantity<Length>("width", io::bounds::kWidth, io::Need::required).value_or(Length{});
  channel.height =
      table.quantity<Length>("height", io::bounds::kHeight, io::Need::required).value_or(Length{});
  channel.height_uncertainty =
      table.quantity<Length>("height_uncertainty", io::bounds::kLengthUncertainty);
  channel.origin = table.pair<Length>("origin", io::bounds::kOrigin);
  channel.flow = table.choice("flow", kFlowDirections);
  channel.rotation = table.quantity<Angle>("rotation", io::bounds::kRotation);
  channel.outward = table.choice("outward", kOutwards);
  table.finish();
  check_proportions(channel, table, faults);
  return channel;
}

InletSection read_inlet(io::TableReader& table, io::Faults& faults) {
  InletSection inlet;
  const auto profile = table.choice("profile", kInletProfiles);
  inlet.profile = profile.value_or(inlet.profile);
  inlet.spread = table.number("spread", kSpread, "0.3");
  const auto length = table.quantity<Length>("developing_length", kDevelopingLength);
  inlet.developing_length = length.value_or(Length{});
  table.finish();
  // A profile at fault may have been meant to be uniform.
  const bool developed = profile == flow::InletProfile::developed || !table.has("profile");
  if (length && developed) {
    faults.add(table.place("developing_length"),
               table.has("profile") ? "a developing length of a flow that is developed"
                                    : "a developing length without a profile that develops",
               "Write profile = \"uniform\" if the flow begins to develop this far before x = 0, "
               "or remove the key");
  }
  return inlet;
}

WallSection read_wall(io::TableReader& table) {
  WallSection wall;
  wall.material = table.text("material").value_or("");
  wall.thickness = table.quantity<Length>("thickness", io::bounds::kThickness);
  wall.youngs_modulus = table.quantity<Pressure>("youngs_modulus", io::bounds::kModulus);
  wall.poisson_ratio = table.number("poisson_ratio", io::bounds::kPoissonRatio, "0.23");
  wall.prestress = table.quantity<Pressure>("prestress", io::bounds::kPrestress);
  table.finish();
  return wall;
}

FluidSection read_fluid(io::TableReader& table, io::Faults& faults) {
  FluidSection fluid;
  fluid.name = table.text("name").value_or("");
  fluid.viscosity =
      table.quantity<Viscosity>("viscosity", io::bounds::kViscosity, io::Need::required)
          .value_or(Viscosity{});
  fluid.viscosity_uncertainty =
      table.quantity<Viscosity>("viscosity_uncertainty", io::bounds::kViscosityUncertainty);
  fluid.density = table.quantity<Density>("density", io::bounds::kDensity, io::Need::required)
                      .value_or(Density{});
  table.finish();
  if (fluid.viscosity_uncertainty && fluid.viscosity > Viscosity{} &&
      *fluid.viscosity_uncertainty >= fluid.viscosity) {
    faults.add(table.place("viscosity_uncertainty"),
               fmt::format("the uncertainty, {:g} mPa s, is not below the viscosity, {:g} mPa s",
                           fluid.viscosity_uncertainty->in(mPa_s), fluid.viscosity.in(mPa_s)),
               "Give the standard uncertainty of the viscosity: check its unit");
  }
  return fluid;
}

InstrumentSection read_instrument(io::TableReader& table) {
  InstrumentSection instrument;
  instrument.height_noise = table.quantity<Length>("height_noise", io::bounds::kHeightNoise);
  instrument.wavelength = table.quantity<Length>("wavelength", io::bounds::kWavelength);
  instrument.pressure_noise =
      table.quantity<Pressure>("pressure_noise", io::bounds::kPressureNoise);
  instrument.pressure_gain_uncertainty =
      table.number("pressure_gain_uncertainty", io::bounds::kGainUncertainty, "0.002");
  instrument.pressure_zero_uncertainty =
      table.quantity<Pressure>("pressure_zero_uncertainty", io::bounds::kPressureUncertainty);
  instrument.flow_rate_uncertainty =
      table.number("flow_rate_uncertainty", io::bounds::kRelativeFlowUncertainty, "0.01");
  instrument.pressure_drop_uncertainty =
      table.quantity<Pressure>("pressure_drop_uncertainty", io::bounds::kPressureUncertainty);
  instrument.pixel_pitch = table.pair<Length>("pixel_pitch", io::bounds::kPixelPitch);
  instrument.height_unit = table.text("height_unit").value_or("");
  instrument.channel = table.text("channel").value_or("");
  if (const auto reference = table.text("reference")) instrument.reference = *reference;
  table.finish();
  return instrument;
}

}  // namespace manoscope::experiment
