#pragma once

#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "manoscope/core/monitor.hpp"
#include "manoscope/serve/experiment_files.hpp"
#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

/// The draft in a request: `form`, or `text` and `lists`.
/// @param old  what is on the disk, if anything is: a form is held against it.
/// @throws ApiError 400 if there is neither; InputError as apply_form().
ExperimentDraft draft_from(const Folder& folder, const std::string& file,
                           const std::optional<ExperimentDraft>& old,
                           const nlohmann::json& request);

/// Experiments as the page sees them; safe to call from several threads.
class ExperimentApi {
 public:
  explicit ExperimentApi(const Folder& folder) : folder_(&folder) {}

  Reply read(const Request& request) const;
  Reply write(const Request& request);
  Reply check(const Request& request, const Monitor& monitor) const;
  Reply draft(const Request& request);

 private:
  const Folder* folder_;
  std::mutex writing_;
  OwnLists own_lists_;  ///< guarded by `writing_`
};

}  // namespace manoscope::serve
