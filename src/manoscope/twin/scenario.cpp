#include "manoscope/twin/scenario.hpp"

#include <fmt/format.h>

#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::twin {
namespace {

void require(bool holds, const std::string& found, const char* mend) {
  if (!holds) throw InputError("scenario", found, mend);
}

bool not_negative(double value) { return value >= 0.0 && std::isfinite(value); }

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

void Scenario::validate() const {
  const std::string where = "scenario";
  require(!name.empty(), "it has no name", "Name it, such as \"S1\"");
  channel.validate(where);
  fluid.validate(where);
  membrane.validate(where);
  require(std::abs(membrane.width / channel.width - 1.0) < 1e-12,
          fmt::format("the wall is {:g} mm wide, the channel {:g} mm", membrane.width.in(mm),
                      channel.width.in(mm)),
          "Give both the same width");
  require(not_negative(height_uncertainty.si()) && height_uncertainty < 0.2 * channel.height,
          fmt::format("height uncertainty is {:g} um", height_uncertainty.in(um)),
          "Choose 0 or more, and less than a fifth of the height");
  require(!levels.empty(), "it has no pressure level", "Give at least one, such as \"0 Pa\"");
  for (const Pressure level : levels) {
    require(not_negative(level.si()), fmt::format("one level is {:g} Pa", level.si()),
            "Give gauge pressures of 0 Pa or more");
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
  solver.validate();
}

Scenario small_s1() {
  Scenario scenario;
  scenario.name = "S1 (virtual)";
  scenario.channel = {15.5 * mm, 1.7 * mm, 175.0 * um};
  scenario.height_uncertainty = 0.5 * um;
  scenario.fluid = {1.0 * mPa_s, 998.0 * kg_per_m3};
  scenario.fluid_name = "water";
  scenario.membrane = {1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, 10.0 * MPa};
  scenario.wall_material = "SiN";
  scenario.preload = {700.0 * Pa, 0.04};
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
