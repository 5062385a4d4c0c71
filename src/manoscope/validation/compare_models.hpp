#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/profile.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/flow/wall_friction.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/validation/flow_setup.hpp"
#include "manoscope/validation/pieces.hpp"

namespace manoscope::validation {

struct CompareModelsOptions {
  int pieces = 8;  ///< of the test section, for chi-square along x
  double validity =
      0.02;  ///< largest stated error of a model that is valid, as a share of the drop
  double along_tail = 0.01;  ///< p(x) along x is called different below this probability

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("pieces", pieces, "pieces of the test section whose mean pressures are compared");
    visit("validity", validity, "largest stated error of a flow model that counts as valid");
    visit("along-tail", along_tail,
          "probability of chi-square along x below which p(x) is called different");
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// What a comparison says.
enum class Agreement {
  agree,       ///< the drop, and p(x) along x
  drop_only,   ///< the drop alone: errors of the model that cancel look like this
  differ,      ///< not even the drop
  no_verdict,  ///< nothing can be said
};

/// One flow model against the reading of one run.
struct ModelAgreement {
  flow::FlowModel model = flow::FlowModel::paper;
  Array1 pressure;          ///< (n) Pa, on the line, 0 at the outlet
  Estimate drop;            ///< Pa, over the test section
  double difference = 0.0;  ///< Pa, model less reading
  /// Pa, standard, of the difference: what both share is in it once, and the inlet profile only
  /// where it moves the drop towards the reading.
  double uncertainty = 0.0;
  /// |difference| / (2 uncertainty): the E_n number of ISO/IEC 17043; NaN without a verdict.
  double en_number = 0.0;
  ChiSquare along;  ///< of the mean pressures of the pieces; tail 1 without a verdict
  /// Of p along x with gap, viscosity and flow rate free by another 5 % each: tells models apart by
  /// the shape of p(x), so that a wrong gap is not taken for another model. 0 without a verdict.
  double log_likelihood = 0.0;
  flow::ModelError error;  ///< stated error of the model at this flow
  bool valid = false;      ///< whether that is at most CompareModelsOptions::validity
  bool separated = false;  ///< a march met backflow
  Agreement agreement = Agreement::no_verdict;
  std::string words;  ///< the verdict for a person
};

/// E_n, agreement and verdict of a comparison whose difference, uncertainty and chi-square along x
/// are there: the one rule of flow models and simulations.
/// @param who  what is compared, for the words.
void judge(ModelAgreement& found, const Estimate& extracted, const CompareModelsOptions& options,
           const char* who = "model");

/// What one physical effect adds to the drop.
struct Correction {
  std::string name;
  Pressure section{};  ///< over the test section
  Pressure channel{};  ///< over the whole channel
  /// Standard uncertainty over the section that the inlet profile leaves; "entry" alone has one.
  std::optional<Pressure> spread;
};

/// Flow models against the reading of one run.
struct ModelComparison {
  Estimate extracted;  ///< Pa, dp_e = p(x_start) - p(x_end) off the wall
  std::vector<ModelAgreement> models;
  /// In this order: "mean-gap rectangle" (the drop by eq. (4) itself), "true section", "inertia",
  /// "entry", "section march"; each less the one before. They add up to the drop of the last. The
  /// section march stands there if it is among the models, and the last two only in forward flow.
  std::vector<Correction> corrections;
  WallLine line;
  Array1 reynolds;                ///< (n) Re_x = 2Q/(nu (w + h)) on the line
  double reduced_reynolds = 0.0;  ///< Re h/l
  bool laminar = true;            ///< Re_x below 2000 everywhere
  flow::WallShear shear;          ///< (n) Pa, of developed flow, on the line
  double drag = 0.0;              ///< N, friction on all walls of the whole channel
  double relative_drag = 1.0;     ///< over that of the undeflected channel
};

/// Compares dp_e of one run with the drop of several flow models over the test section.
///
/// zeta(x) is in both, with its noise, plane and position, and they count once; the curves and the
/// gauge are in dp_e alone; gap, viscosity, flow rate, stated error of the model and inlet profile
/// in the model alone:
///
///   u(m - e)^2 = u(m)^2 + u(e)^2 - 2 cov(m, e),  E_n = |m - e| / (2 u(m - e))
///
/// "agree" where E_n <= 1 and chi-square along x, which asks the same of p(x) up to a constant, is
/// not larger than chance makes it (along_tail). Without a stated uncertainty of the gap there is
/// no verdict: 1 % of 2 h0 moves the drop by 3 %. For errors that are normal with the stated
/// widths, E_n > 1 in 4.6 % of runs whose model is true; in fewer where the inlet is not known,
/// since its profile lies anywhere within its spread.
///
/// Source: ISO/IEC 17043 (E_n); JCGM 102 (covariance). Cost: that of the models, and n stations
/// squared for their derivatives.
///
/// @param models  in any order; models that march are left out if the flow rate is not positive.
/// @throws InputError as flow::pressure_along(), or if an end of the section has no answer.
ModelComparison compare_models(const FlowSetup& setup, FlowRate flow_rate, const Profile& state,
                               const inversion::PressureReading& reading,
                               const inversion::TestSection& section,
                               const std::vector<flow::FlowModel>& models,
                               const CompareModelsOptions& options = {});

/// Every model of kFlowModels.
std::vector<flow::FlowModel> all_models();

}  // namespace manoscope::validation
