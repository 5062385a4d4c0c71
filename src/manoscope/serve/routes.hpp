#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

/// What the server can be asked for.
enum class Task {
  page,
  script,
  style,
  state,
  list_files,
  upload,
  map,
  place,
  read_experiment,
  write_experiment,
  draft_experiment,
  check,
  options,
  start_job,
  current_job,
  cancel_job,
  events,
  result_file,
  result,
};

enum class Body { none, json, upload };

struct Route {
  Task task = Task::page;
  Method method = Method::get;
  Body body = Body::none;
  bool heavy = false;  ///< may take seconds: not on the threads that answer the rest
};

/// A route, or why there is none: 404 or 405.
struct Found {
  std::optional<Route> route;
  unsigned status = 404;
};
Found find_route(Method method, const std::vector<std::string>& parts);

}  // namespace manoscope::serve
