#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "manoscope/core/monitor.hpp"
#include "manoscope/serve/experiment_api.hpp"
#include "manoscope/serve/jobs.hpp"
#include "manoscope/serve/routes.hpp"
#include "manoscope/serve/state_api.hpp"
#include "manoscope/serve/upload.hpp"

namespace manoscope::serve {

/// All that is behind the guard, without a socket: requests in, answers out. Safe to call from
/// several threads.
class App {
 public:
  /// @param program  what is started to measure: this program.
  App(const std::filesystem::path& folder, std::string program, Jobs::Publish publish);

  void set_port(std::uint16_t port) { port_ = port; }
  /// Never throws: what goes wrong is an answer.
  Reply answer(const Route& route, const Request& request, const Monitor& monitor) noexcept;
  /// Whether a request takes as long as the maps of an experiment.
  bool reads_maps(const Route& route, const Request& request) const;
  /// @throws ApiError, InputError.
  std::unique_ptr<Upload> begin_upload(const Address& address) const;

  /// Hands over the first words to a page that listens to events: no event of the job comes
  /// between what they tell and the call.
  void greet(const std::function<void(std::string)>& say) const;
  /// An event if files changed since the last call, else "".
  std::string file_event();

 private:
  Reply dispatch(const Route& route, const Request& request, const Monitor& monitor);

  Folder folder_;
  std::string program_;
  std::uint16_t port_ = 0;
  StateApi state_;
  ExperimentApi experiments_;
  Jobs jobs_;
};

/// 201 with name and size.
Reply upload_reply(const Upload& upload);

}  // namespace manoscope::serve
