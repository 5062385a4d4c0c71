#include "manoscope/serve/experiment_api.hpp"

#include <nlohmann/json.hpp>
#include <system_error>

#include "manoscope/experiment/draft.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/experiment/file_doubts.hpp"
#include "manoscope/pipeline/file_warnings.hpp"
#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/fault_json.hpp"
#include "manoscope/serve/form_json.hpp"
#include "manoscope/serve/json.hpp"

namespace manoscope::serve {
namespace {

using nlohmann::json;

experiment::FileTexts file_texts(const Folder& folder, const ExperimentDraft& draft) {
  experiment::FileTexts texts{{folder.absolute(draft.file), draft.texts.toml}};
  for (const auto& [name, text] : draft.texts.lists) {
    const auto path = beneath(draft.file, name);
    if (path && !text.empty()) texts[folder.absolute(*path)] = text;
  }
  return texts;
}

/// Faults, notes and the numbers of maps of a draft.
void check_into(json& answer, const Folder& folder, const ExperimentDraft& draft,
                const experiment::Form& form, const Monitor* maps) {
  std::vector<InputError> faults = names_that_lead_out(folder, draft, form);
  if (faults.empty()) {
    auto attempt =
        experiment::attempt_experiment(folder.absolute(draft.file), file_texts(folder, draft));
    faults = std::move(attempt.faults);
    answer["hydrostatic_maps"] = attempt.experiment.hydrostatic.size();
    answer["flow_maps"] = attempt.experiment.flow.size();
    if (faults.empty()) answer["notes"] = experiment::file_doubts(attempt.experiment);
    if (faults.empty() && maps != nullptr) {
      pipeline::MapCheck check = pipeline::check_maps(attempt.experiment, 0, *maps);
      faults = std::move(check.faults);
      for (std::string& warning : check.warnings) answer["notes"].push_back(std::move(warning));
      answer["maps_checked"] = true;
    }
  }
  for (const InputError& fault : faults) {
    answer["faults"].push_back(fault_json(folder, draft, &form, fault));
  }
}

/// @param maps  with one, every map is read too.
json experiment_json(const Folder& folder, const ExperimentDraft& draft, const json& revision,
                     const Monitor* maps = nullptr) {
  json answer = {{"file", draft.file},       {"revision", revision},
                 {"text", draft.texts.toml}, {"lists", draft.texts.lists},
                 {"form", nullptr},          {"faults", json::array()},
                 {"notes", json::array()},   {"maps_checked", false},
                 {"hydrostatic_maps", 0},    {"flow_maps", 0}};
  try {
    const experiment::Form form = experiment::read_form(draft.texts);
    answer["form"] = form_json(form, draft.texts.toml);
    check_into(answer, folder, draft, form, maps);
  } catch (const InputError& error) {
    // No TOML: where it ceases to be is told in the words of the reader of the whole file.
    const auto attempt = experiment::attempt_experiment(
        folder.absolute(draft.file), {{folder.absolute(draft.file), draft.texts.toml}});
    for (const InputError& fault : attempt.faults) {
      answer["faults"].push_back(fault_json(folder, draft, nullptr, fault));
    }
    if (attempt.faults.empty())
      answer["faults"].push_back(fault_json(folder, draft, nullptr, error));
  }
  return answer;
}

/// 412 with what is on the disk.
Reply changed_reply(const Folder& folder, const ExperimentDraft& there) {
  json answer = {{"error",
                  {{"where", there.file},
                   {"found", "the file or one of its lists has changed in the meantime"},
                   {"mend", "Look at what is there now, then write again"}}}};
  answer["experiment"] = experiment_json(folder, there, revision_of(there));
  return json_reply(answer, 412);
}

[[noreturn]] void refuse_missing(const std::string& file) {
  throw ApiError(404, file, "there is no such file", "Draft an experiment from a folder of maps");
}

}  // namespace

ExperimentDraft draft_from(const Folder& folder, const std::string& file,
                           const std::optional<ExperimentDraft>& old, const json& object) {
  ExperimentDraft draft = old.value_or(ExperimentDraft{file, {"manoscope = 1\n", {}}});
  const auto form = object.find("form"), text = object.find("text");
  if (form != object.end() && !form->is_null()) {
    experiment::Form wanted = form_from(*form);
    adopt_lists(folder, draft, wanted);
    draft.texts = experiment::apply_form(draft.texts, wanted);
  } else if (text != object.end() && text->is_string()) {
    draft.texts.toml = text->get<std::string>();
    draft.texts.lists = read_lists(folder, file, draft.texts.toml);
    const auto lists = object.find("lists");
    if (lists != object.end() && !lists->is_null()) {
      if (!lists->is_object()) throw wrong_kind("lists", "an object");
      for (const auto& [name, list] : lists->items()) {
        if (draft.texts.lists.contains(name)) draft.texts.lists[name] = text_of(list, name);
      }
    }
  } else {
    throw ApiError(400, "request", "neither a form nor a text", "Send one of them");
  }
  return draft;
}

Reply ExperimentApi::read(const Request& request) const {
  const std::string file = experiment_file(request.address.value("file").value_or(""));
  const auto draft = load_experiment(*folder_, file);
  if (!draft) refuse_missing(file);
  return json_reply(experiment_json(*folder_, *draft, revision_of(*draft)));
}

Reply ExperimentApi::check(const Request& request, const Monitor& monitor) const {
  const json object = parse_object(request.body);
  const std::string file = experiment_file(text_in(object, "file", ""));
  const auto old = load_experiment(*folder_, file);
  const ExperimentDraft draft = draft_from(*folder_, file, old, object);
  return json_reply(experiment_json(*folder_, draft, old ? json(revision_of(*old)) : json(nullptr),
                                    flag_in(object, "maps") ? &monitor : nullptr));
}

Reply ExperimentApi::write(const Request& request) {
  const std::string file = experiment_file(request.address.value("file").value_or(""));
  const std::scoped_lock lock(writing_);
  const auto old = load_experiment(*folder_, file);
  const bool anew = request.if_none_match == "*";
  if (!anew && request.if_match.empty()) {
    throw ApiError(428, file, "the request does not say which state it changes",
                   "Send If-Match with the revision, or If-None-Match: *");
  }
  if (!anew && !old) refuse_missing(file);
  if (anew ? bool(old) : request.if_match != '"' + revision_of(*old) + '"') {
    return changed_reply(*folder_, *old);
  }
  const ExperimentDraft draft = draft_from(*folder_, file, old, parse_object(request.body));
  try {
    write_experiment(*folder_, old, draft, own_lists_);
  } catch (const ApiError& error) {
    const auto there = error.status() == 412 ? load_experiment(*folder_, file) : std::nullopt;
    if (!there) throw;
    return changed_reply(*folder_, *there);
  }
  const auto written = load_experiment(*folder_, file);
  if (!written) refuse_missing(file);
  return json_reply(experiment_json(*folder_, *written, revision_of(*written)), old ? 200 : 201);
}

Reply ExperimentApi::draft(const Request& request) {
  const json object = parse_object(request.body);
  const std::string relative = text_in(object, "folder", "");
  if (!relative_parts(relative) || !folder_->has(relative, Folder::Kind::folder)) {
    throw ApiError(404, relative, "there is no such folder", "Name a folder of maps");
  }
  const std::filesystem::path path = folder_->absolute(relative);
  std::error_code error;
  for (std::filesystem::directory_iterator it(path, error), end; !error && it != end;
       it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (folder_->leads_out(under(relative, name))) {
      throw InputError(name, "the link leads out of the folder that is served",
                       "Copy the file into the folder");
    }
  }
  // It replaces nothing, and takes as long as the maps: writing does not wait for it.
  const experiment::Draft draft = experiment::draft_experiment(path);
  json written = json::array();
  for (const auto& file : draft.written) {
    written.push_back(file.lexically_relative(folder_->path()).string());
  }
  return json_reply({{"file", under(relative, "experiment.toml")},
                     {"written", written},
                     {"hydrostatic", draft.hydrostatic},
                     {"flow", draft.flow},
                     {"unassigned", draft.unassigned},
                     {"no_maps", draft.no_maps}},
                    201);
}

}  // namespace manoscope::serve
