#include "manoscope/serve/form_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "manoscope/io/toml_edit.hpp"
#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/json.hpp"

namespace manoscope::serve {
namespace {

using experiment::Form;
using experiment::FormKey;
using experiment::FormKind;
using experiment::FormList;
using nlohmann::json;

json list_json(const std::optional<FormList>& list) {
  if (!list) return nullptr;
  return {{"file", list->file.empty() ? json(nullptr) : json(list->file)},
          {"columns", list->columns},
          {"rows", list->rows},
          {"locked", list->locked.empty() ? json(nullptr) : json(list->locked)}};
}

std::optional<FormList> list_from(const json& form, const char* name) {
  const auto found = form.find(name);
  if (found == form.end() || found->is_null()) return std::nullopt;
  if (!found->is_object()) throw wrong_kind(name, "an object");
  FormList list;
  list.file = text_in(*found, "file", "");
  const auto part = [&](const char* key) {
    const auto there = found->find(key);
    if (there == found->end()) throw wrong_kind(fmt::format("{}.{}", name, key), "there");
    return *there;
  };
  list.columns = texts_of(part("columns"), fmt::format("{}.columns", name));
  const json rows = part("rows");
  if (!rows.is_array()) throw wrong_kind(fmt::format("{}.rows", name), "a list of rows");
  for (const json& row : rows) list.rows.push_back(texts_of(row, fmt::format("{}.rows", name)));
  return list;
}

/// @throws ApiError for a key that no form has: a slip of its spelling would be lost in silence.
void check_names(const json& form) {
  const auto keys = experiment::form_keys();
  const auto refuse = [](const std::string& name) {
    throw ApiError(400, name, "the form has no such key", "Send what the manual describes");
  };
  for (const auto& [section, value] : form.items()) {
    const auto in_section = [&, name = section](const FormKey& key) {
      return key.section == name || (*key.section == '\0' && key.key == name);
    };
    if (section == "comments" || section == "hydrostatic" || section == "flow") continue;
    if (std::none_of(keys.begin(), keys.end(), in_section)) refuse(section);
    if (!value.is_object()) continue;
    for (const auto& [name, ignored] : value.items()) {
      const std::string whole = fmt::format("{}.{}", section, name);
      if (std::none_of(keys.begin(), keys.end(),
                       [&](const FormKey& key) { return key.name() == whole; })) {
        refuse(whole);
      }
    }
  }
}

}  // namespace

json form_json(const Form& form, const std::string& toml) {
  json object = json::object();
  for (const FormKey& key : experiment::form_keys()) {
    json& place = *key.section == '\0' ? object[key.key] : object[key.section][key.key];
    const auto found = form.values.find(key.name());
    if (found == form.values.end()) {
      place = nullptr;
    } else if (key.kind == FormKind::pair) {
      place = found->second;
    } else {
      place = found->second[0];
    }
  }
  object["hydrostatic"] = list_json(form.hydrostatic);
  object["flow"] = list_json(form.flow);
  object["comments"] = io::toml_comments(toml);
  return object;
}

Form form_from(const json& object) {
  if (!object.is_object()) {
    throw ApiError(400, "form", "this is no form", "Send what the manual describes");
  }
  check_names(object);
  Form form;
  for (const FormKey& key : experiment::form_keys()) {
    const bool top = *key.section == '\0';
    const auto section = top ? object.end() : object.find(key.section);
    if (!top && (section == object.end() || section->is_null())) continue;
    const json& table = top ? object : *section;
    if (!table.is_object()) throw wrong_kind(key.section, "an object");
    const auto value = table.find(key.key);
    if (value == table.end() || value->is_null()) continue;
    form.values[key.name()] = key.kind == FormKind::pair ? texts_of(*value, key.name())
                                                         : std::vector{text_of(*value, key.name())};
  }
  form.hydrostatic = list_from(object, "hydrostatic");
  form.flow = list_from(object, "flow");
  return form;
}

}  // namespace manoscope::serve
