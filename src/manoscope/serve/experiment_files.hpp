#pragma once

#include <filesystem>
#include <map>
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

/// The lists that an experiment.toml names, as far as they are beneath the folder, are called as
/// lists are (.csv, .tsv, .txt, not hidden) and can be read; one that is not there yet is an empty
/// text.
std::map<std::string, std::string> read_lists(const Folder& folder, const std::string& file,
                                              const std::string& toml);

/// What is on the disk; nullopt if there is no such file.
/// @throws InputError if it cannot be read, or is no text of settings for its size.
std::optional<ExperimentDraft> load_experiment(const Folder& folder, const std::string& file);

/// Tells one state of the files from another.
std::string revision_of(const ExperimentDraft& draft);

/// Lists that a form names and the draft does not: one that is on the disk already joins the draft
/// as it is there, if the form shows the same table, or none. A form without rows gets them.
void adopt_lists(const Folder& folder, ExperimentDraft& draft, experiment::Form& form);

/// Every name in an experiment that leads out of the served folder, or to what is not served there,
/// as faults of its keys.
std::vector<InputError> names_that_lead_out(const Folder& folder, const ExperimentDraft& draft,
                                            const experiment::Form& form);

/// The lists that were made here, by path, and what tells the state in which they were left.
using OwnLists = std::map<std::string, std::string>;

/// Writes the files that differ from what is on the disk, each of them whole or not at all, the
/// lists first. A file that is new replaces nothing, but for a list that was made here and is as it
/// was left. Files keep their permissions, and links stay links.
/// @throws ApiError 412 if the disk is not as `old` any more, 409 if a new list's name is taken by
///         another content; InputError if a file leads out of the folder, is no list by its name,
///         or cannot be written.
void write_experiment(const Folder& folder, const std::optional<ExperimentDraft>& old,
                      const ExperimentDraft& draft, OwnLists& own);

}  // namespace manoscope::serve
