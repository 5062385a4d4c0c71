#include "manoscope/experiment/form.hpp"

#include <fmt/format.h>

#include "manoscope/core/error.hpp"
#include "manoscope/io/toml_document.hpp"
#include "manoscope/io/toml_edit.hpp"

namespace manoscope::experiment {
namespace {

using io::TomlValue;

constexpr const char* kWhere = "experiment.toml";

constexpr FormKey kKeys[] = {{"", "name", FormKind::text},
                             {"channel", "length", FormKind::text},
                             {"channel", "width", FormKind::text},
                             {"channel", "height", FormKind::text},
                             {"channel", "height_uncertainty", FormKind::text},
                             {"channel", "origin", FormKind::pair},
                             {"channel", "flow", FormKind::text},
                             {"channel", "rotation", FormKind::text},
                             {"channel", "outward", FormKind::text},
                             {"inlet", "profile", FormKind::text},
                             {"inlet", "spread", FormKind::number},
                             {"inlet", "developing_length", FormKind::text},
                             {"wall", "material", FormKind::text},
                             {"wall", "thickness", FormKind::text},
                             {"wall", "youngs_modulus", FormKind::text},
                             {"wall", "poisson_ratio", FormKind::number},
                             {"wall", "prestress", FormKind::text},
                             {"fluid", "name", FormKind::text},
                             {"fluid", "viscosity", FormKind::text},
                             {"fluid", "viscosity_uncertainty", FormKind::text},
                             {"fluid", "density", FormKind::text},
                             {"instrument", "height_noise", FormKind::text},
                             {"instrument", "wavelength", FormKind::text},
                             {"instrument", "pressure_noise", FormKind::text},
                             {"instrument", "pressure_gain_uncertainty", FormKind::number},
                             {"instrument", "pressure_zero_uncertainty", FormKind::text},
                             {"instrument", "flow_rate_uncertainty", FormKind::number},
                             {"instrument", "pressure_drop_uncertainty", FormKind::text},
                             {"instrument", "pixel_pitch", FormKind::pair},
                             {"instrument", "height_unit", FormKind::text},
                             {"instrument", "channel", FormKind::text},
                             {"instrument", "reference", FormKind::text}};

const TomlValue* find(const TomlValue& root, const FormKey& key) {
  const TomlValue* table = *key.section == '\0' ? &root : root.find(key.section);
  return table == nullptr ? nullptr : table->find(key.key);
}

/// Nothing for a value of another shape than the key's: the form does not touch it.
std::vector<std::string> texts_of(const TomlValue& value, FormKind kind) {
  const auto is_scalar = [](const TomlValue& v) {
    return v.kind != TomlValue::Kind::table && v.kind != TomlValue::Kind::list;
  };
  if (kind != FormKind::pair) {
    return is_scalar(value) ? std::vector{value.text} : std::vector<std::string>{};
  }
  const bool pair = value.kind == TomlValue::Kind::list && value.items.size() == 2 &&
                    is_scalar(value.items[0]) && is_scalar(value.items[1]);
  return pair ? std::vector{value.items[0].text, value.items[1].text} : std::vector<std::string>{};
}

/// What is no number is written as a text, for the check to say so.
std::string number_literal(const std::string& text) {
  try {
    const TomlValue root = io::parse_toml("value = " + text, kWhere);
    const TomlValue* value = root.find("value");
    const bool alone = root.keys.size() == 1 && text.find_first_of("\r\n#") == std::string::npos;
    const bool number = value != nullptr && (value->kind == TomlValue::Kind::integer ||
                                             value->kind == TomlValue::Kind::real);
    if (alone && number) return text;
  } catch (const InputError&) {
    // no number
  }
  return io::toml_quoted(text);
}

std::string literal(const std::vector<std::string>& texts, const FormKey& key) {
  const std::size_t wanted = key.kind == FormKind::pair ? 2 : 1;
  if (texts.size() != wanted) {
    throw InputError(key.name(), fmt::format("{} texts stand for it", texts.size()),
                     fmt::format("Give {}", wanted == 2 ? "two" : "one"));
  }
  if (key.kind == FormKind::number) return number_literal(texts[0]);
  if (key.kind == FormKind::text) return io::toml_quoted(texts[0]);
  return fmt::format("[{}, {}]", io::toml_quoted(texts[0]), io::toml_quoted(texts[1]));
}

std::optional<FormList> read_list(const TomlValue& root, const char* section,
                                  const std::map<std::string, std::string>& lists) {
  const TomlValue* table = root.find(section);
  if (table == nullptr) return std::nullopt;
  const TomlValue* file = table->find("list");
  const TomlValue* maps = table->find("maps");
  FormList list;
  if (file != nullptr && file->kind == TomlValue::Kind::text && maps == nullptr) {
    const auto text = lists.find(file->text);
    if (text != lists.end()) return read_csv_form(text->second, file->text);
    list.file = file->text;
    list.locked = fmt::format("{} cannot be read here", io::toml_quoted(file->text));
    return list;
  }
  if (maps != nullptr && maps->kind == TomlValue::Kind::list && file == nullptr) {
    return read_inline_form(*maps);
  }
  list.locked = fmt::format("section [{}] names no maps, or names them twice", section);
  return list;
}

void apply_list(ExperimentTexts& texts, const char* section, const std::optional<FormList>& old,
                const std::optional<FormList>& wanted) {
  if (!wanted) {
    if (old) texts.toml = io::without_toml_section(texts.toml, section);
    return;
  }
  const bool same_file = old && old->file == wanted->file;
  if (same_file && same_table(*old, *wanted)) return;
  if (same_file && !old->locked.empty()) {
    throw InputError(section, old->locked, "Change the text itself");
  }
  if (wanted->file.empty()) {
    texts.toml = io::without_toml_key(texts.toml, section, "list");
    texts.toml = io::with_toml_value(texts.toml, section, "maps", inline_list(*wanted));
    return;
  }
  if (!same_file) {
    texts.toml = io::without_toml_key(texts.toml, section, "maps");
    texts.toml = io::with_toml_value(texts.toml, section, "list", io::toml_quoted(wanted->file));
  }
  std::string& text = texts.lists[wanted->file];
  // A file that is there already is named as it is, even where it is no sound table.
  if (!same_file && !text.empty() && same_table(read_csv_form(text, wanted->file), *wanted)) return;
  text = edit_csv_list(text, *wanted);
}

}  // namespace

std::span<const FormKey> form_keys() { return kKeys; }

std::vector<std::string> list_files(const std::string& toml) {
  const TomlValue root = io::parse_toml(toml, kWhere);
  std::vector<std::string> names;
  for (const char* section : {"hydrostatic", "flow"}) {
    const TomlValue* table = root.find(section);
    const TomlValue* file = table == nullptr ? nullptr : table->find("list");
    if (file != nullptr && file->kind == TomlValue::Kind::text) names.push_back(file->text);
  }
  return names;
}

Form read_form(const ExperimentTexts& texts) {
  const TomlValue root = io::parse_toml(texts.toml, kWhere);
  Form form;
  for (const FormKey& key : kKeys) {
    const TomlValue* value = find(root, key);
    if (value == nullptr) continue;
    auto written = texts_of(*value, key.kind);
    if (!written.empty()) form.values[key.name()] = std::move(written);
  }
  form.hydrostatic = read_list(root, "hydrostatic", texts.lists);
  form.flow = read_list(root, "flow", texts.lists);
  return form;
}

ExperimentTexts apply_form(const ExperimentTexts& texts, const Form& wanted) {
  const Form old = read_form(texts);
  ExperimentTexts changed = texts;
  for (const FormKey& key : kKeys) {
    const std::string name = key.name();
    const auto before = old.values.find(name), after = wanted.values.find(name);
    if (after == wanted.values.end()) {
      if (before == old.values.end()) continue;
      changed.toml = io::without_toml_key(changed.toml, key.section, key.key);
    } else if (before == old.values.end() || before->second != after->second) {
      changed.toml =
          io::with_toml_value(changed.toml, key.section, key.key, literal(after->second, key));
    }
  }
  apply_list(changed, "hydrostatic", old.hydrostatic, wanted.hydrostatic);
  apply_list(changed, "flow", old.flow, wanted.flow);
  return changed;
}

}  // namespace manoscope::experiment
