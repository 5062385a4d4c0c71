#include "manoscope/serve/routes.hpp"

#include <algorithm>
#include <span>

namespace manoscope::serve {
namespace {

struct Entry {
  std::vector<std::string> parts;
  bool more;  ///< at least one part more: the name of a file
  Route route;
};

const std::vector<Entry>& table_of_routes() {
  using enum Task;
  static const std::vector<Entry> table{
      {{}, false, {page}},
      {{"app.js"}, false, {script}},
      {{"app.css"}, false, {style}},
      {{"api", "state"}, false, {state}},
      {{"api", "files"}, false, {list_files}},
      {{"api", "files"}, true, {upload, Method::put, Body::upload}},
      {{"api", "map"}, false, {map, Method::get, Body::none, true}},
      {{"api", "place"}, false, {place, Method::post, Body::json, true}},
      {{"api", "experiment"}, false, {read_experiment}},
      {{"api", "experiment"}, false, {write_experiment, Method::put, Body::json}},
      {{"api", "experiment", "draft"}, false, {draft_experiment, Method::post, Body::json, true}},
      {{"api", "check"}, false, {check, Method::post, Body::json}},
      {{"api", "options"}, false, {options}},
      {{"api", "jobs"}, false, {start_job, Method::post, Body::json}},
      {{"api", "jobs", "current"}, false, {current_job}},
      {{"api", "jobs", "current"}, false, {cancel_job, Method::del}},
      {{"api", "events"}, false, {events}},
      {{"api", "result"}, false, {result, Method::get, Body::none, true}},
      {{"results"}, true, {result_file}},
  };
  return table;
}

bool matches(const Entry& entry, const std::vector<std::string>& parts) {
  const std::size_t n = entry.parts.size();
  return (entry.more ? parts.size() > n : parts.size() == n) &&
         std::equal(entry.parts.begin(), entry.parts.end(), parts.begin());
}

}  // namespace

Found find_route(Method method, const std::vector<std::string>& parts) {
  Found found;
  for (const Entry& entry : table_of_routes()) {
    if (!matches(entry, parts)) continue;
    found.status = 405;
    if (entry.route.method != method) continue;
    found.route = entry.route;
    break;
  }
  return found;
}

}  // namespace manoscope::serve
