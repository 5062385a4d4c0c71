#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/flow/passage_losses.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/pipeline/stages.hpp"
#include "manoscope/validation/flow_setup.hpp"
#include "manoscope/validation/predict_flow.hpp"

namespace manoscope::pipeline {

// What an experiment tells of its channel, gauge and fluid, as the layers below take it.
flow::Channel channel_of(const experiment::Experiment& experiment);
flow::Fluid fluid_of(const experiment::Experiment& experiment);
inversion::GaugeErrors gauge_of(const experiment::Experiment& experiment);
validation::FlowUncertainty flow_uncertainty_of(const experiment::Experiment& experiment);
flow::PassageUncertainty passage_uncertainty_of(const experiment::Experiment& experiment);

/// The channel as the flow models see it, and where that comes from.
struct FlowKnowledge {
  validation::FlowSetup setup;  ///< with tables; the inlet's spread is that of no run yet
  std::string words;            ///< section and inlet
  std::vector<Index> stations;  ///< of the curves, at which models are run
  calibration::ConstitutiveCurves curves;  ///< at these stations
  /// Over which the fitted wall forgets a disturbance; none without a fitted wall.
  std::optional<Length> healing_length;
};

/// Section shape from the picture of the wall's response, inlet and uncertainties from the
/// experiment, tables of sections for every deflection that the curves and the runs hold.
/// @param n_stations  about how many there shall be along the channel.
/// @param largest_extrapolation  of the curves, PredictFlowOptions: the tables reach as far.
/// @throws InputError if the gap closes or reaches the width somewhere.
FlowKnowledge know_flow(const experiment::Experiment& experiment, const ReducedExperiment& reduced,
                        const calibration::ConstitutiveCurves& curves,
                        const std::vector<FlowRun>& runs, Index n_stations,
                        double largest_extrapolation);

/// Shape of the wall across the channel: even polynomial through the mean of the middle half of
/// the picture. None where the picture is too coarse or does not show a wall that gives way.
std::optional<flow::WallShape> shape_across(const maps::ResponsePicture& response,
                                            const flow::Channel& channel);

/// How far the profile at the channel's inlet may lie from the one that is taken, 0 to 1: as the
/// experiment says; else what a rigid inlet passage leaves of a uniform profile's development,
/// 1 - K(x+)/K(infinity) with K of Shah (1978); else 1.
double inlet_spread(const experiment::Experiment& experiment, FlowRate flow_rate);

/// Parts of the drop in the rigid passages, "inlet, duct" and so on, or what simulations of them
/// say; empty if the experiment tells of no passage.
/// @throws InputError as flow::passage_terms() and flow::simulated_drop().
std::vector<flow::PressureTerm> passages(const experiment::Experiment& experiment,
                                         FlowRate flow_rate);

/// Gauge pressure at the channel's outlet where a gauge behind it reads this much: with the drop of
/// the rigid outlet passage, if there is one.
validation::Outlet behind_passage(const experiment::Experiment& experiment, FlowRate flow_rate,
                                  Pressure gauge);

/// Gauge pressure at the channel's outlet during a run: behind_passage() of the outlet pressure
/// that the flow list tells; else the reading at the end of the test section, less what `momentum`
/// has the pressure fall from there on through the measured gap; without a test section the last
/// reading. (A passage alone does not tell it: there is a head of liquid behind.)
validation::Outlet outlet_of(const experiment::Experiment& experiment,
                             const FlowKnowledge& knowledge, const FlowRun& run,
                             const inversion::PressureReading& reading,
                             const std::optional<inversion::TestSection>& section);

}  // namespace manoscope::pipeline
