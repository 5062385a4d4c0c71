#include "manoscope/twin/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::twin {
namespace {

void require(bool holds, const std::string& found, const char* mend) {
  if (!holds) throw InputError("scenario", found, mend);
}

bool not_negative(double value) { return value >= 0.0 && std::isfinite(value); }

/// Refuses the first level under which the law of a long wall finds too high a crest.
void check_rise(const Scenario& scenario) {
  const wall::ClampedWall& wall = scenario.wall;
  const double half_width = 0.5 * std::min(wall.width, wall.length).si();
  const Pressure limit = wall.largest_pressure();
  for (const Pressure level : scenario.levels) {
    const Pressure load = level - wall.preload.load;
    if (!(load > limit)) continue;
    throw InputError(
        "scenario",
        fmt::format("the level of {:g} Pa of \"{}\" lifts the wall by more than {:g} of its "
                    "half-width, {:.4g} um: its theory (moderate rotations) ends there",
                    level.si(), scenario.name, wall::kLargestRise,
                    wall::kLargestRise * half_width * 1e6),
        fmt::format("Give levels up to about {:.3g} kPa, or make the wall thicker, stiffer or "
                    "narrower",
                    0.99 * (limit + wall.preload.load).in(kPa)));
  }
}

}  // namespace

void GaugeOptions::validate() const {
  require(not_negative(noise.si()), fmt::format("gauge noise is {:g} Pa", noise.si()),
          "Give 0 Pa (off) or more");
  require(not_negative(gain_uncertainty) && gain_uncertainty < 0.2,
          fmt::format("gauge gain uncertainty is {:g}", gain_uncertainty),
          "Choose a relative value in [0, 0.2)");
  require(not_negative(zero_uncertainty.si()),
          fmt::format("gauge zero uncertainty is {:g} Pa", zero_uncertainty.si()),
          "Give 0 Pa (off) or more");
  require(not_negative(transducer_noise.si()),
          fmt::format("transducer noise is {:g} Pa", transducer_noise.si()),
          "Give 0 Pa (off) or more");
}

void PumpOptions::validate() const {
  require(not_negative(pulsation) && pulsation <= 0.1,
          fmt::format("pulsation of the pump is {:g}", pulsation),
          "Choose a relative value in [0, 0.1]");
}

Scenario Scenario::without_errors() const {
  Scenario clean = *this;
  clean.camera = camera.without_errors();
  clean.height_uncertainty = Length{};
  clean.gauge = {Pressure{}, 0.0, Pressure{}, Pressure{}};
  clean.pump.pulsation = 0.0;
  return clean;
}

void Scenario::validate() const {
  const std::string where = "scenario";
  require(!name.empty(), "it has no name", "Name it, such as \"S1\"");
  channel.validate(where);
  fluid.validate(where);
  wall.validate();
  require(std::abs(wall.width / channel.width - 1.0) < 1e-12 &&
              std::abs(wall.length / channel.length - 1.0) < 1e-12,
          fmt::format("the wall is {:g} mm by {:g} mm, the channel {:g} mm by {:g} mm",
                      wall.length.in(mm), wall.width.in(mm), channel.length.in(mm),
                      channel.width.in(mm)),
          "Give both the same length and width");
  if (wall_law == WallLaw::tapered_membrane) {
    require(wall.prestress >= Pressure{},
            fmt::format("a tapered membrane under {:g} MPa of compression", wall.prestress.in(MPa)),
            "Give a tension, above 0, or choose law = \"foppl_von_karman\": a compressed wall "
            "buckles");
    require(wall.prestress > Pressure{},
            "a tapered membrane without prestress: flat and slack, it gives way to any pressure",
            "Give a tension such as \"1 MPa\", or choose law = \"foppl_von_karman\", whose wall "
            "bends");
    require(wall.shear_correction == 0.0 && wall.initial_shape.crest == Length{},
            "a tapered membrane with shear or an initial shape",
            "Choose law = \"foppl_von_karman\", which knows both");
  }
  require(not_negative(height_uncertainty.si()) && height_uncertainty < 0.2 * channel.height,
          fmt::format("height uncertainty is {:g} um", height_uncertainty.in(um)),
          "Choose 0 or more, and less than a fifth of the height");
  require(!levels.empty(), "it has no pressure level", "Give at least one, such as \"0 Pa\"");
  for (const Pressure level : levels) {
    require(not_negative(level.si()), fmt::format("one level is {:g} Pa", level.si()),
            "Give gauge pressures of 0 Pa or more");
  }
  for (std::size_t i = 1; i < levels.size(); ++i) {
    require(levels[i] >= levels[i - 1],
            fmt::format("the levels descend: {:g} Pa follows {:g} Pa", levels[i].si(),
                        levels[i - 1].si()),
            "Sort the levels by rising pressure; the wall is loaded in their order");
  }
  for (std::size_t i = 0; i < flow_rates.size(); ++i) {
    const FlowRate flow_rate = flow_rates[i];
    require(flow_rate.si() > 0.0 && std::isfinite(flow_rate.si()),
            fmt::format("one flow rate is {:g} mL/min", flow_rate.in(mL_per_min)),
            "Give positive flow rates");
    for (std::size_t j = 0; j < i; ++j) {
      require(flow_rates[j] != flow_rate,
              fmt::format("the flow rate {:g} mL/min stands there twice", flow_rate.in(mL_per_min)),
              "Give each flow rate once");
    }
  }
  require(std::isfinite(outlet.head.si()) && not_negative(outlet.tubing_resistance),
          fmt::format("outlet head is {:g} Pa, tubing resistance {:g} Pa s/m3", outlet.head.si(),
                      outlet.tubing_resistance),
          "Give a finite head and a resistance of 0 or more");
  camera.validate();
  gauge.validate();
  pump.validate();
  solver.validate();
  check_rise(*this);
}

wall::TaperedMembrane Scenario::tapered_membrane() const {
  return {wall.length,
          {wall.width, wall.thickness, wall.youngs_modulus, wall.poisson_ratio, wall.prestress},
          wall.preload};
}

WallModel Scenario::wall_model(const Monitor& monitor) const {
  if (wall_law == WallLaw::tapered_membrane) return membrane_model(tapered_membrane());
  wall::FopplVonKarmanOptions options;
  options.n_cells_x = wall_grid.n_cells_x;
  options.n_cells_z = wall_grid.n_cells_z;
  options.design_pressure = *std::max_element(levels.begin(), levels.end());
  // A snap runs along a long wall as a front, a cell or less at a factorisation.
  options.max_iterations = 1000;
  return plate_model(wall, options, monitor);
}

Scenario small_s1() {
  Scenario scenario;
  scenario.name = "S1 (virtual)";
  scenario.channel = {15.5 * mm, 1.7 * mm, 175.0 * um};
  scenario.height_uncertainty = 0.5 * um;
  scenario.fluid = {1.0 * mPa_s, 998.0 * kg_per_m3};
  scenario.fluid_name = "water";
  scenario.wall_law = WallLaw::tapered_membrane;
  scenario.wall = {15.5 * mm, 1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, 10.0 * MPa};
  scenario.wall.preload = {700.0 * Pa, 0.04};
  scenario.wall_material = "SiN";
  scenario.solver.momentum_factor = 0.0;
  // Closely spaced where the wall passes from bowed to stretched, then by equal ratios.
  for (const double level : {0.0, 150.0, 300.0, 450.0, 600.0, 700.0, 800.0, 1000.0, 1400.0, 2100.0,
                             3300.0, 5200.0, 8200.0, 13000.0, 20500.0, 32000.0, 50000.0}) {
    scenario.levels.push_back(level * Pa);
  }
  for (const double flow_rate : {5.0, 20.0, 40.0, 70.0}) {
    scenario.flow_rates.push_back(flow_rate * mL_per_min);
  }
  scenario.outlet = {285.0 * Pa, 3.1 * (Pa / mL_per_min).si()};
  scenario.inlet_passage = flow::RigidPassage{2.0 * mm, 1.7 * mm, 250.0 * um};
  scenario.outlet_passage = flow::RigidPassage{2.0 * mm, 1.7 * mm, 250.0 * um};
  scenario.camera.n_along = 512;
  scenario.camera.n_across = 96;
  // Anywhere within half a pixel of 32 um: what a measurement takes unregistered maps to show.
  scenario.camera.shift = 9.2 * um;
  return scenario;
}

}  // namespace manoscope::twin
