#pragma once

#include <string>
#include <variant>
#include <vector>

#include "manoscope/results/simulation.hpp"

namespace manoscope::results {

/// Where a variable of a simulation's file lives.
using SimulationMember =
    std::variant<double Simulation::*, Array1 Simulation::*, Array2 Simulation::*,
                 std::vector<Array2> Simulation::*, std::string Simulation::*,
                 std::vector<std::string> Simulation::*>;

/// A variable of a simulation's file: name, shape, unit, meaning, and the member that holds it.
struct SimulationVariable {
  const char* name;
  std::vector<const char*> dimensions;  ///< names, slowest first; empty = one number or text
  const char* units;                    ///< "1" for pure numbers and texts
  const char* long_name;
  SimulationMember member;

  bool is_text() const {
    return std::holds_alternative<std::string Simulation::*>(member) ||
           std::holds_alternative<std::vector<std::string> Simulation::*>(member);
  }
};

/// The one list of variables: writer, reader and manual use it.
const std::vector<SimulationVariable>& simulation_variables();

/// The list as a Markdown table, for the manual.
std::string simulation_schema_as_markdown();

}  // namespace manoscope::results
