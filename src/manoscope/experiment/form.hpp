#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "manoscope/experiment/form_list.hpp"

namespace manoscope::experiment {

/// How a key of the form is written: in quotes, as a plain number, or as two texts in brackets.
enum class FormKind { text, number, pair };

/// A key that a form shows; what no form shows stays in the text as it is.
struct FormKey {
  const char* section;  ///< "" = the top of the file
  const char* key;
  FormKind kind;

  /// "channel.length"
  std::string name() const {
    return *section == '\0' ? std::string(key) : std::string(section) + "." + key;
  }
};
/// All of them, in the order of the manual.
std::span<const FormKey> form_keys();

/// The texts of an experiment: of experiment.toml, and of its lists by the names that it gives
/// them.
struct ExperimentTexts {
  std::string toml;
  std::map<std::string, std::string> lists;

  friend bool operator==(const ExperimentTexts&, const ExperimentTexts&) = default;
};

/// An experiment as a form shows it: texts as they are written, nothing understood yet.
struct Form {
  /// By the key's name: one text, of a pair two. A key that is absent is not there.
  std::map<std::string, std::vector<std::string>> values;
  std::optional<FormList> hydrostatic, flow;
};

/// Names of the list files that an experiment.toml gives, in the order hydrostatic, flow.
/// @throws InputError if the text is no TOML.
std::vector<std::string> list_files(const std::string& toml);

/// @throws InputError if the text is no TOML.
Form read_form(const ExperimentTexts& texts);

/// The texts with what differs from `wanted` changed in place: comments and every other key stay.
/// @throws InputError if a table is not one, or the text is written in a way that only a text
/// editor
///         can change.
ExperimentTexts apply_form(const ExperimentTexts& texts, const Form& wanted);

}  // namespace manoscope::experiment
