#include "manoscope/experiment/rigid_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/experiment/area_unit.hpp"

namespace manoscope::experiment {
namespace {

constexpr io::Bounds kArea{0.0, 0.01, true,
                           "A cross-section is between 0 and 100 cm2; of a wider one write "
                           "from_reservoir = true or into_reservoir = true instead"};
constexpr io::Bounds kBends{0.0, 1000.0, false,
                            "Count the bends of 90 degrees: a whole number from 0, here to 1000"};
constexpr io::Bounds kSimulatedFlowRate{
    0.0, 1e-3, true, "A simulation has a flow rate above zero and below 1 L/s", "20 mL/min"};
constexpr const char* kSimulation =
    "{flow_rate = \"20 mL/min\", drop = \"310 Pa\", uncertainty = \"10 Pa\"}";
constexpr double kRelative = 1e-9;  // the same value in two units differs by round-off

/// What a passage comes from or goes into: a section of known size, or one without bound.
struct PassageEnd {
  std::optional<flow::Area> area;
  bool reservoir = false;
};

/// @param key  "from" or "into".
/// @param own  The passage's section; 0 if its sizes are at fault.
PassageEnd read_end(io::TableReader& passage, const std::string& key, flow::Area own,
                    io::Faults& faults) {
  const std::string reservoir_key = key + "_reservoir";
  PassageEnd end;
  end.area = passage.quantity<flow::Area>(key, kArea);
  end.reservoir = passage.boolean(reservoir_key).value_or(false);
  if (!end.area) return end;
  if (end.reservoir) {
    faults.add(passage.place(reservoir_key),
               fmt::format("both `{}` and `{} = true` are given", key, reservoir_key),
               fmt::format("Keep `{}` for a section of known size, or `{}` for a chamber far "
                           "wider than the passage",
                           key, reservoir_key));
  } else if (own > (1.0 + kRelative) * *end.area) {
    faults.add(passage.place(key),
               fmt::format("the section, {:.4g} mm2, is below the passage's own, width times "
                           "height = {:.4g} mm2",
                           end.area->si() * 1e6, own.si() * 1e6),
               "Give a section at least as large as the passage's: check the unit, or remove the "
               "key where there is no such step");
  } else {
    end.area = std::max(*end.area, own);
  }
  return end;
}

int read_bends(io::TableReader& passage, const std::string& key, io::Faults& faults) {
  const int n_bends = passage.integer(key).value_or(0);
  const bool usable = io::check_bounds(n_bends, kBends, fmt::format("{}", n_bends), nullptr,
                                       passage.place(key), faults);
  return usable ? n_bends : 0;
}

/// @param end  "from" or "into": what lies on the gauge's side of the passage.
void read_port(io::TableReader& table, const std::string& end, const PassageEnd& step,
               Passage& passage, io::Faults& faults) {
  passage.port = table.quantity<Length>("port", io::bounds::kLength);
  const auto side = table.text("port_side");
  if (!passage.port) {
    if (side) {
      faults.add(table.place("port_side"), "there is no port",
                 "Give its length along the flow as `port`, or remove the key");
    }
    return;
  }
  passage.port_at_side = side == "side";
  if (side && *side != "side" && *side != "top") {
    faults.add(table.place("port_side"), fmt::format("{} is no side", io::in_quotes(*side)),
               "Write \"top\" for a hole in the roof, \"side\" for one in a side wall");
  }
  if (step.area || step.reservoir) {
    faults.add(table.place("port"),
               fmt::format("there is a step at the gauge's end, too (`{}`)", end),
               "Keep what the flow meets first, and leave out what lies beyond");
  }
  if (passage.length > Length{} && *passage.port > passage.length) {
    faults.add(table.place("port"),
               fmt::format("the port, {:g} mm, is longer than the passage, {:g} mm",
                           passage.port->in(mm), passage.length.in(mm)),
               "The port opens into the passage: count its length to that of the passage");
  }
  ++passage.fittings.mitre_bends;
}

/// @param height  0 if it is at fault itself.
std::optional<Length> read_height_uncertainty(io::TableReader& passage, Length height,
                                              io::Faults& faults) {
  const auto uncertainty =
      passage.quantity<Length>("height_uncertainty", io::bounds::kLengthUncertainty);
  if (!uncertainty || height == Length{} || *uncertainty < height) return uncertainty;
  faults.add(passage.place("height_uncertainty"),
             fmt::format("the uncertainty, {:g} um, is not below the height itself, {:g} um",
                         uncertainty->in(um), height.in(um)),
             "Give the standard uncertainty of the height: check its unit");
  return std::nullopt;
}

std::optional<Passage> read_passage(io::TableReader& rigid, const std::string& key,
                                    io::Faults& faults) {
  auto table = rigid.table(key);
  if (!table) return std::nullopt;
  Passage passage;
  passage.length =
      table->quantity<Length>("length", io::bounds::kLength, io::Need::required).value_or(Length{});
  passage.width =
      table->quantity<Length>("width", io::bounds::kWidth, io::Need::required).value_or(Length{});
  passage.height =
      table->quantity<Length>("height", io::bounds::kHeight, io::Need::required).value_or(Length{});
  passage.height_uncertainty = read_height_uncertainty(*table, passage.height, faults);
  const flow::Area own = passage.width * passage.height;
  const PassageEnd from = read_end(*table, "from", own, faults);
  const PassageEnd into = read_end(*table, "into", own, faults);
  passage.fittings = {from.area, from.reservoir, into.area, into.reservoir, 0, 0};
  passage.fittings.round_bends = read_bends(*table, "round_bends", faults);
  passage.fittings.mitre_bends = read_bends(*table, "mitre_bends", faults);
  const bool before = key == "inlet";
  read_port(*table, before ? "from" : "into", before ? from : into, passage, faults);
  table->finish();
  return passage;
}

/// One simulation and the line it stands on.
struct Simulation {
  flow::SimulatedDrop drop;
  int line = 0;
};

Simulation read_simulation(io::TableReader& table) {
  Simulation simulation;
  simulation.line = table.line();
  simulation.drop.flow_rate =
      table.quantity<FlowRate>("flow_rate", kSimulatedFlowRate, io::Need::required)
          .value_or(FlowRate{});
  simulation.drop.drop =
      table.quantity<Pressure>("drop", io::bounds::kPressureDrop, io::Need::required)
          .value_or(Pressure{});
  simulation.drop.uncertainty =
      table.quantity<Pressure>("uncertainty", io::bounds::kPressureUncertainty)
          .value_or(Pressure{});
  table.finish();
  return simulation;
}

bool at_one_flow_rate(const Simulation& a, const Simulation& b) {
  const double rate = a.drop.flow_rate.si(), other = b.drop.flow_rate.si();
  return std::abs(rate - other) <= kRelative * std::abs(other);
}

std::vector<flow::SimulatedDrop> read_simulated(io::TableReader& rigid, io::Faults& faults) {
  const io::TomlValue* list = rigid.list("simulated", kSimulation);
  if (list == nullptr) return {};
  if (list->items.empty()) {
    faults.add(rigid.place("simulated"), "the list has no simulations",
               fmt::format("Write {} for every simulation, or remove the key", kSimulation));
  }
  std::vector<Simulation> simulations;
  for (std::size_t i = 0; i < list->items.size(); ++i) {
    const std::string path = fmt::format("rigid.simulated entry {}", i + 1);
    const io::TomlValue& entry = list->items[i];
    if (entry.kind != io::TomlValue::Kind::table) {
      faults.add({rigid.file(), entry.line, path},
                 fmt::format("{} stands where a simulation belongs", io::in_quotes(entry.text)),
                 fmt::format("Write {} for every simulation", kSimulation));
      continue;
    }
    io::TableReader table(entry, path + ": ", rigid.file(), faults);
    const Simulation simulation = read_simulation(table);
    if (!(simulation.drop.flow_rate > FlowRate{})) continue;
    const auto first =
        std::find_if(simulations.begin(), simulations.end(),
                     [&](const Simulation& other) { return at_one_flow_rate(simulation, other); });
    if (first != simulations.end()) {
      faults.add(table.place("flow_rate"),
                 fmt::format("{:g} mL/min is simulated twice, first in line {}",
                             simulation.drop.flow_rate.in(mL_per_min), first->line),
                 "Keep one simulation of a flow rate, or correct the flow rate");
    }
    simulations.push_back(simulation);
  }
  std::vector<flow::SimulatedDrop> drops;
  for (const Simulation& simulation : simulations) drops.push_back(simulation.drop);
  return drops;
}

}  // namespace

RigidSection read_rigid(io::TableReader& table, io::Faults& faults) {
  RigidSection rigid;
  rigid.inlet = read_passage(table, "inlet", faults);
  rigid.outlet = read_passage(table, "outlet", faults);
  rigid.simulated = read_simulated(table, faults);
  table.finish();
  return rigid;
}

}  // namespace manoscope::experiment
