#include "manoscope/serve/place_api.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "manoscope/core/frame_words.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/reduce.hpp"
#include "manoscope/pipeline/file_warnings.hpp"
#include "manoscope/pipeline/stages.hpp"
#include "manoscope/serve/experiment_api.hpp"
#include "manoscope/serve/json.hpp"

namespace manoscope::serve {
namespace {

using experiment::Experiment;
using nlohmann::json;

/// Takes out the rows that have a fault: what is left stands as it was meant.
template <class T>
void drop_faulty(std::vector<T>& maps, const std::string& list,
                 const std::vector<InputError>& faults) {
  std::set<int> lines;
  for (const InputError& fault : faults) {
    const std::string prefix = list + ":";
    if (!fault.where().starts_with(prefix)) continue;
    const std::string rest = fault.where().substr(prefix.size());
    const auto line = parse_number(rest.substr(0, rest.find(':')));
    if (line) lines.insert(static_cast<int>(*line));
  }
  std::erase_if(maps, [&](const T& map) { return lines.contains(map.line); });
}

/// The experiment of a draft as far as it can be understood, for placing the channel alone.
Experiment understood(const Folder& folder, const ExperimentDraft& draft) {
  const experiment::Form form = experiment::read_form(draft.texts);
  auto outside = names_that_lead_out(folder, draft, form);
  if (!outside.empty()) throw InputErrors(std::move(outside));
  experiment::FileTexts texts{{folder.absolute(draft.file), draft.texts.toml}};
  const auto path_of = [&](const std::optional<experiment::FormList>& list) {
    if (!list || list->file.empty()) return folder.absolute(draft.file);
    return folder.absolute(beneath(draft.file, list->file).value_or(""));
  };
  for (const auto& [name, text] : draft.texts.lists) {
    const auto path = beneath(draft.file, name);
    if (path && !text.empty()) texts[folder.absolute(*path)] = text;
  }
  auto [experiment, faults] = experiment::attempt_experiment(folder.absolute(draft.file), texts);
  drop_faulty(experiment.hydrostatic, path_of(form.hydrostatic).string(), faults);
  drop_faulty(experiment.flow, path_of(form.flow).string(), faults);
  return std::move(experiment);
}

void check_enough(const Experiment& experiment, const std::string& file) {
  if (!(experiment.channel.length > Length{}) || !(experiment.channel.width > Length{})) {
    throw InputError(file, "the channel's length or width is missing",
                     "Give channel.length and channel.width");
  }
  const auto& levels = experiment.hydrostatic;
  const bool two = std::any_of(levels.begin(), levels.end(), [&](const auto& level) {
    return level.pressure != levels.front().pressure;
  });
  if (!two) {
    throw InputError(file, "no two hydrostatic maps of different pressure",
                     "Give the pressures of two maps at least: their difference shows the channel");
  }
}

std::string millimetres(Length length) { return fmt::format("{:.6g} mm", length.in(mm)); }

json frame_json(const ChannelFrame& frame, const CameraGrid& camera) {
  const double l = frame.length.si(), half = 0.5 * frame.width.si();
  json corners = json::array();
  for (const auto& [x, z] :
       {std::pair(0.0, -half), std::pair(l, -half), std::pair(l, half), std::pair(0.0, half)}) {
    corners.push_back(frame.camera_from_channel(x, z));
  }
  return {{"corners_m", corners},
          {"origin_m", {frame.origin_x.si(), frame.origin_y.si()}},
          {"length_m", frame.length.si()},
          {"width_m", frame.width.si()},
          {"flow", word_of(kFlowDirections, frame.flow)},
          {"outward", word_of(kOutwards, frame.outward)},
          {"rotation_rad", frame.rotation.si()},
          {"across_reversed", frame.across_reversed},
          {"rim_margin_m", maps::auto_rim_margin(maps::channel_grid(camera, frame), frame).si()}};
}

}  // namespace

Reply place_reply(const Folder& folder, const std::string& body) {
  const json request = parse_object(body);
  const std::string file = experiment_file(text_in(request, "file", ""));
  const auto old = load_experiment(folder, file);
  const Experiment experiment = understood(folder, draft_from(folder, file, old, request));
  check_enough(experiment, file);
  const maps::FoundPlace place = pipeline::place_channel(experiment);
  const ChannelFrame& frame = place.frame;
  const auto [low, high] =
      std::minmax_element(experiment.hydrostatic.begin(), experiment.hydrostatic.end(),
                          [](const auto& a, const auto& b) { return a.pressure < b.pressure; });
  const CameraGrid camera =
      io::read_height_map(low->map, pipeline::reading_options(experiment)).grid();
  return json_reply({{"found",
                      {{"origin", {millimetres(frame.origin_x), millimetres(frame.origin_y)}},
                       {"flow", word_of(kFlowDirections, frame.flow)},
                       {"rotation", fmt::format("{:.4g} deg", frame.rotation.in(deg))},
                       {"outward", word_of(kOutwards, frame.outward)}}},
                     {"frame", frame_json(frame, camera)},
                     {"length_misfit_m", number(place.length_misfit)},
                     {"width_misfit_m", number(place.width_misfit)},
                     {"along_misfit_m", number(place.along_misfit)},
                     {"across_misfit_m", number(place.across_misfit)},
                     {"low", low->name},
                     {"high", high->name}});
}

}  // namespace manoscope::serve
