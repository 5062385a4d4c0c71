// One experiment of a campaign: made, measured, held against its truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "manoscope/results/measurement.hpp"
#include "manoscope/twin/scenario.hpp"
#include "manoscope/twin/solved_scenario.hpp"
#include "manoscope/twin/truth.hpp"
#include "manoscope/validation/judge.hpp"

namespace manoscope::campaign {

/// A stretch of the channel that is judged, m.
struct Stretch {
  const char* name;
  double start, end;
};
inline constexpr Stretch kStretches[] = {
    {"inside", 1.6e-3, 13.9e-3}, {"inlet", 0.3e-3, 1.6e-3}, {"outlet", 13.9e-3, 15.2e-3}};

struct Member {
  std::string base;        ///< shipped scenario
  std::uint64_t wall = 0;  ///< of varied_scenario()
  std::uint64_t seed = 1;

  /// "S1,0,1,": how its rows begin.
  std::string name() const;
  /// Of the random numbers: no two members of a campaign share any.
  std::uint64_t own_seed() const;
};

/// A member as a folder that can be measured, and its truth.
struct WrittenMember {
  std::filesystem::path folder;
  twin::Truth truth;
  std::vector<twin::RunScalars> scalars;  ///< one a run
};

/// Makes the experiment and writes it to a folder of its own below `scratch`.
WrittenMember write_member(const Member& member, const twin::Scenario& scenario,
                           const twin::SolvedScenario& solved,
                           const std::filesystem::path& scratch);

/// A member with its truth.
struct MeasuredMember {
  results::Measurement measurement;
  twin::Truth truth;
};

/// Makes the experiment by write_member(), and measures it with the settings that a user gets who
/// sets none.
/// @param keep  leave the folder.
MeasuredMember measure_member(const Member& member, const twin::Scenario& scenario,
                              const twin::SolvedScenario& solved,
                              const std::filesystem::path& scratch, bool keep = false);

/// One run of a member over a stretch.
validation::Judgement judge_stretch(const MeasuredMember& member, Index run,
                                    const Stretch& stretch);

/// The header of the table, and the rows of one member: each run over each stretch, the whole
/// channel, and the drop over its test section.
extern const char* const kHeader;
std::string rows_of(const Member& member, const twin::Scenario& scenario,
                    const MeasuredMember& measured);

}  // namespace manoscope::campaign
