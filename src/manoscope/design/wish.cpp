#include "manoscope/design/wish.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/suggest.hpp"

namespace manoscope::design {
namespace {

template <class Q>
void require_positive(const std::optional<Q>& value, const char* option) {
  if (!value || (value->si() > 0.0 && std::isfinite(value->si()))) return;
  throw InputError(option, fmt::format("is {:g} {}", value->si(), UnitOf<Q>::name),
                   fmt::format("Give a value above 0, such as \"{}\"", UnitOf<Q>::example));
}

void require_count(int value, int least, int most, const char* option) {
  if (value >= least && value <= most) return;
  throw InputError(option, fmt::format("is {}", value),
                   fmt::format("Give a number from {} to {}", least, most));
}

}  // namespace

Aim Wish::aim() const {
  if (minimise) return *minimise == "rms" ? Aim::rms : Aim::worst;
  return uncertainty ? Aim::worst : Aim::rms;
}

void Wish::validate() const {
  require_positive(uncertainty, "--uncertainty");
  require_positive(drop_uncertainty, "--drop-uncertainty");
  require_positive(resolution, "--resolution");
  require_positive(highest, "--highest");
  require_positive(highest_level, "--highest-level");
  if (lowest && !(lowest->si() >= 0.0)) {
    throw InputError("--lowest", fmt::format("is {:g} Pa", lowest->si()),
                     "Give a gauge pressure of 0 Pa or more: no level stands below");
  }
  if (lowest && highest && !(*lowest < *highest)) {
    throw InputError("--lowest",
                     fmt::format("is {:g} Pa, --highest {:g} Pa", lowest->si(), highest->si()),
                     "Give a range of pressure, the lower end first");
  }
  constexpr int kFewest = 5, kMost = 100;
  if (levels) require_count(*levels, kFewest, kMost, "--levels");
  require_count(most_levels, kFewest, kMost, "--most-levels");
  require_count(most_repeats, 1, kMost, "--most-repeats");
  require_count(flow_maps, 1, 10000, "--flow-maps");
  if (minimise && *minimise != "worst" && *minimise != "rms") {
    const std::vector<std::string> words{"worst", "rms"};
    throw InputError("--minimise",
                     fmt::format("is \"{}\"{}", *minimise, did_you_mean(*minimise, words)),
                     "Give worst or rms");
  }
  if (!(wall_doubt >= 0.0 && wall_doubt <= 0.5)) {
    throw InputError("--wall-doubt", fmt::format("is {:g}", wall_doubt),
                     "Give a share from 0 (the wall is as the scenario says) to 0.5");
  }
}

}  // namespace manoscope::design
