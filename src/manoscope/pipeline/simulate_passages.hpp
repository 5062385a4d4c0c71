#pragma once

#include <functional>
#include <string>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/parasitic.hpp"

namespace manoscope::pipeline {

/// One rigid passage joined to the channel, as a Navier-Stokes solver is asked for its drop.
struct GivenPassage {
  bool is_inlet = true;
  flow::Channel channel;
  flow::RigidPassage passage;
  Length beyond_width{}, beyond_height{};  ///< of a wider section at the gauge's end; 0: none
  Length port{};                           ///< 0: none
  bool port_at_side = false;
  flow::Fluid fluid;
  FlowRate flow_rate{};
};

/// What the solver answers.
struct SolvedPassage {
  double drop = 0.0, drop_uncertainty = 0.0;  ///< Pa; numerical, k = 1
  bool converged = false;
  double n_unknowns = 0.0, seconds = 0.0, peak_memory = 0.0;  ///< peak_memory in bytes
};

/// @throws InputError for a flow that cannot be solved; Interrupted.
using PassageSolver = std::function<SolvedPassage(const GivenPassage&)>;

/// The parasitic drop at one flow rate, Pa; uncertainties are standard.
struct ParasiticDrop {
  FlowRate flow_rate{};
  SolvedPassage inlet, outlet;                      ///< 0 where there is no such passage
  double bends = 0.0, bends_uncertainty = 0.0;      ///< by their formula: no mesh has them
  double height_effect = 0.0;                       ///< of one standard deviation of the heights
  double formula = 0.0, formula_uncertainty = 0.0;  ///< what passage_terms() say instead

  double drop() const { return inlet.drop + outlet.drop + bends; }
  double uncertainty() const;
  bool converged() const { return inlet.converged && outlet.converged; }
};

/// Flow rates of the named runs, ascending, each once.
/// @param names  labels of runs, or "all".
/// @throws InputError for a name that is no run (told with those there are) or a run that flows
///         backward or not at all.
std::vector<FlowRate> flow_rates_of(const experiment::Experiment& experiment,
                                    const std::vector<std::string>& names);

/// Solves the passages that [rigid] describes: the paper's appendix A.
///
/// Each is joined to a straight piece of channel. A step to a section `from` (inlet) or `into`
/// (outlet) is one to a section of the passage's proportions; a reservoir is six of the shorter
/// side wider on every side but the floor. Bends but that of a port are added by their formula.
/// Uncertainty: numerical of both passages (added up: they err alike), formula of the bends, and
/// height_uncertainty through the formulas' derivatives (added up: one error for both).
///
/// @throws InputError if the experiment has no passages, a section lies between passage and channel
///         that is not the channel's, and as the solver.
std::vector<ParasiticDrop> simulate_passages(const experiment::Experiment& experiment,
                                             const std::vector<FlowRate>& flow_rates,
                                             const PassageSolver& solver,
                                             const Monitor& monitor = {});

/// The drops as the key `simulated` of [rigid], for a person to put into the experiment file.
std::string simulated_key(const std::vector<ParasiticDrop>& drops);

/// One row a flow rate, SI, standard uncertainties: flow_rate_m3_s, then inlet_drop_Pa,
/// outlet_drop_Pa, bends_drop_Pa, parasitic_drop_Pa, formula_drop_Pa, each with its uncertainty.
std::string passages_table(const std::vector<ParasiticDrop>& drops);

/// What a person should know of the drops before believing them, in words.
std::vector<std::string> passage_doubts(const experiment::Experiment& experiment,
                                        const std::vector<ParasiticDrop>& drops);

}  // namespace manoscope::pipeline
