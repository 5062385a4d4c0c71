#include "manoscope/experiment/list_checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

namespace manoscope::experiment {
namespace {

constexpr std::size_t kFewestLevels = 3;

/// Where each file on disk is listed first.
using Seen = std::map<std::string, std::size_t>;

bool same_value(const HydrostaticMap& a, const HydrostaticMap& b) {
  return a.pressure == b.pressure;
}
bool same_value(const FlowMap& a, const FlowMap& b) { return a.flow_rate == b.flow_rate; }

template <class T>
Seen check_repeats(const MapList<T>& list, const char* value_name, io::Faults& faults) {
  Seen seen;
  for (std::size_t i = 0; i < list.maps.size(); ++i) {
    const T& map = list.maps[i];
    if (map.name.empty()) continue;
    const auto [first, fresh] = seen.try_emplace(MapFiles::identity(map.map), i);
    if (fresh) continue;
    const T& other = list.maps[first->second];
    faults.add(
        list.place(i, "map"),
        fmt::format("{} is listed twice, first in line {}", io::in_quotes(map.name), other.line),
        same_value(map, other)
            ? "Keep one of the two: a repeat is another map of the same level"
            : fmt::format("One map has one {}: correct the name, or remove a row", value_name));
  }
  return seen;
}

void check_levels(const MapList<HydrostaticMap>& hydrostatic, io::Faults& faults) {
  if (!hydrostatic.complete) return;  // the missing levels may stand in the rows at fault
  std::set<double> levels;
  for (const HydrostaticMap& map : hydrostatic.maps) levels.insert(map.pressure.si());
  if (levels.size() >= kFewestLevels) return;
  faults.add(
      hydrostatic.whole,
      fmt::format("{} distinct pressure level{}", levels.size(), levels.size() == 1 ? "" : "s"),
      fmt::format("A constitutive curve needs at least {}: add maps at other pressures",
                  kFewestLevels));
}

void check_runs(const MapList<FlowMap>& flow, io::Faults& faults) {
  constexpr double kRelative = 1e-9;  // the same rate in two units differs by round-off
  std::map<std::string, std::size_t> first_of_run;
  for (std::size_t i = 0; i < flow.maps.size(); ++i) {
    const FlowMap& map = flow.maps[i];
    if (map.run.empty()) continue;
    const FlowMap& other = flow.maps[first_of_run.try_emplace(map.run, i).first->second];
    const double rate = map.flow_rate.si(), first_rate = other.flow_rate.si();
    if (std::abs(rate - first_rate) <= kRelative * std::abs(first_rate)) continue;
    faults.add(flow.place(i, "run"),
               fmt::format("run {} has {:g} mL/min here and {:g} mL/min in line {}",
                           io::in_quotes(map.run), map.flow_rate.in(mL_per_min),
                           other.flow_rate.in(mL_per_min), other.line),
               "One run has one flow rate: correct it, or name another run");
  }
}

}  // namespace

void check_lists(const MapList<HydrostaticMap>& hydrostatic, const MapList<FlowMap>& flow,
                 io::Faults& faults) {
  const Seen at_rest = check_repeats(hydrostatic, "pressure", faults);
  std::map<std::size_t, std::size_t> at_rest_too;  // rows of both lists, in the order of the flow's
  for (const auto& [identity, row] : check_repeats(flow, "flow rate", faults)) {
    const auto found = at_rest.find(identity);
    if (found != at_rest.end()) at_rest_too.emplace(row, found->second);
  }
  for (const auto& [row, row_at_rest] : at_rest_too) {
    const io::Place other = hydrostatic.rows[row_at_rest];
    faults.add(
        flow.place(row, "map"),
        fmt::format("{} is also in the hydrostatic list, {}:{}", io::in_quotes(flow.maps[row].name),
                    other.file.filename().string(), other.line),
        "A map is taken at rest or under flow: remove it from one list");
  }
  check_levels(hydrostatic, faults);
  check_runs(flow, faults);
}

void check_reference(const std::filesystem::path& reference, const io::Place& place,
                     const MapList<HydrostaticMap>& hydrostatic, const MapList<FlowMap>& flow,
                     io::Faults& faults) {
  const std::string identity = MapFiles::identity(reference);
  const auto refuse_listed = [&](const auto& list) {
    for (std::size_t i = 0; i < list.maps.size(); ++i) {
      if (list.maps[i].name.empty() || MapFiles::identity(list.maps[i].map) != identity) continue;
      faults.add(place,
                 fmt::format("the reference is also a listed map, {}:{}",
                             list.rows[i].file.filename().string(), list.rows[i].line),
                 "A reference is a map of a flat, not of the wall: name that, or remove the key");
      return;
    }
  };
  refuse_listed(hydrostatic);
  refuse_listed(flow);
}

}  // namespace manoscope::experiment
