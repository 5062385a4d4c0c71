#include "manoscope/serve/app.hpp"

#include <nlohmann/json.hpp>

#include "manoscope/serve/job_api.hpp"
#include "manoscope/serve/json.hpp"
#include "manoscope/serve/map_api.hpp"
#include "manoscope/serve/pages.hpp"
#include "manoscope/serve/place_api.hpp"
#include "manoscope/serve/result_api.hpp"

namespace manoscope::serve {

using nlohmann::json;

App::App(const std::filesystem::path& folder, std::string program, Jobs::Publish publish)
    : folder_(folder),
      program_(std::move(program)),
      state_(folder_),
      experiments_(folder_),
      jobs_(std::move(publish)) {}

Reply App::answer(const Route& route, const Request& request, const Monitor& monitor) noexcept {
  try {
    return dispatch(route, request, monitor);
  } catch (...) {
    return reply_to_exception();
  }
}

Reply App::dispatch(const Route& route, const Request& request, const Monitor& monitor) {
  switch (route.task) {
    case Task::page:
      return app_page(port_);
    case Task::script:
      return script_reply();
    case Task::style:
      return style_reply();
    case Task::state:
      return state_.state(jobs_.current());
    case Task::list_files:
      return state_.list(request.address);
    case Task::map:
      return map_reply(folder_, request.address);
    case Task::place:
      return place_reply(folder_, request.body);
    case Task::read_experiment:
      return experiments_.read(request);
    case Task::write_experiment:
      return experiments_.write(request);
    case Task::draft_experiment:
      return experiments_.draft(request);
    case Task::check:
      return experiments_.check(request, monitor);
    case Task::options:
      return options_reply();
    case Task::start_job:
      return json_reply(jobs_.start(order_from(folder_, program_, request.body)), 202);
    case Task::current_job:
      return json_reply({{"job", jobs_.current()}});
    case Task::cancel_job:
      return json_reply(jobs_.cancel(), 202);
    case Task::result_file:
      return result_file_reply(folder_, request.address);
    case Task::result:
      return result_reply(folder_, request.address);
    case Task::upload:
    case Task::events:
      break;  // streams: the session's own business
  }
  throw InternalError("a route without an answer");
}

bool App::reads_maps(const Route& route, const Request& request) const {
  return route.task == Task::check && request.body.find("\"maps\"") != std::string::npos;
}

std::unique_ptr<Upload> App::begin_upload(const Address& address) const {
  return std::make_unique<Upload>(
      folder_, std::vector<std::string>(address.parts.begin() + 2, address.parts.end()));
}

Reply upload_reply(const Upload& upload) {
  return json_reply({{"file", upload.file()}, {"size", upload.size()}}, 201);
}

void App::greet(const std::function<void(std::string)>& say) const {
  jobs_.look([&](const json& job) {
    say(json{{"type", "hello"}, {"job", job}}.dump(-1, ' ', false, json::error_handler_t::replace));
  });
}

std::string App::file_event() {
  constexpr std::size_t kMost = 100;
  std::vector<std::string> changed = state_.changes();
  if (changed.empty()) return "";
  if (changed.size() > kMost) changed.resize(kMost);
  return json{{"type", "files"}, {"changed", changed}}.dump(-1, ' ', false,
                                                            json::error_handler_t::replace);
}

}  // namespace manoscope::serve
