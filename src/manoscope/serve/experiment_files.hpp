#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/form.hpp"
#include "manoscope/serve/folder.hpp"

namespace manoscope::serve {

/// An experiment of the served folder: where it is and what its files hold, or would hold.
struct ExperimentDraft {
  std::string file;  ///< "s1/experiment.toml"
  experiment::ExperimentTexts texts;
};

/// @throws ApiError 400 if `file` is no path of a .toml beneath the folder.
std::string experiment_file(const std::string& file);

/// What a name in an experiment file means, relative to the served folder: "../a.csv" in
/// "s1/experiment.toml" is "a.csv". Nullopt if it leaves the folder.
std::optional<std::string> beneath(const std::string& experiment_file, const std::string& name);

/// The lists that an experiment.toml names, as far as they are beneath the folder and can be read;
/// a list that is not there yet is an empty text.
std::map<std::string, std::string> read_lists(const Folder& folder, const std::string& file,
                                              const std::string& toml);

/// What is on the disk; nullopt if there is no such file.
/// @throws InputError if it cannot be read, or is no text of settings for its size.
std::optional<ExperimentDraft> load_experiment(const Folder& folder, const std::string& file);

/// Tells one state of the files from another.
std::string revision_of(const ExperimentDraft& draft);

/// Every name in an experiment that leads out of the served folder, as faults of its keys.
std::vector<InputError> names_that_lead_out(const Folder& folder, const ExperimentDraft& draft,
                                            const experiment::Form& form);

/// Writes the files that differ from what is on the disk, each of them whole or not at all, the
/// lists first. A list that is new replaces nothing.
/// @throws ApiError 409 if a new list's name is taken; InputError if a file leads out of the
/// folder,
///         is no list by its name, or cannot be written.
void write_experiment(const Folder& folder, const std::optional<ExperimentDraft>& old,
                      const ExperimentDraft& draft);

}  // namespace manoscope::serve
