#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "manoscope/core/child_process.hpp"

namespace manoscope::serve {

/// What is to be measured, paths relative to the served folder.
struct JobOrder {
  std::string experiment, output;
  std::vector<std::string> words;  ///< the command, the program first
};

/// One measurement at a time, in a process of its own: what goes wrong there stays there.
///
/// Its lines are told as they come, to `publish`, as the events of docs/serve.md. Safe to call from
/// several threads; `publish` is called from a thread of its own.
class Jobs {
 public:
  using Publish = std::function<void(const nlohmann::json& event)>;

  explicit Jobs(Publish publish);
  /// Interrupts what runs and waits for it.
  ~Jobs();
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// @return the job. @throws ApiError 409 while one runs.
  nlohmann::json start(const JobOrder& order);
  /// Asks the process to stop, and ends it if it does not.
  /// @return the job. @throws ApiError 409 if none runs.
  nlohmann::json cancel();
  /// The one that runs, else the last; null if there was none.
  nlohmann::json current() const;
  /// The same for `see`, during which nothing is published: it is not to call anything of here.
  void look(const std::function<void(const nlohmann::json& job)>& see) const;

 private:
  enum class State { running, done, failed, cancelled };
  struct Job {
    int id = 0;
    JobOrder order;
    State state = State::running;
    std::string stage;
    double fraction = 0.0;
    std::deque<std::string> log;
    double started = 0.0, seconds = 0.0;  ///< Unix time, s; duration
    std::optional<int> exit_code, signal;
  };

  void run(const JobOrder& order);
  void measure(const JobOrder& order, ChildEnd& end);
  void take_line(const std::string& line);
  bool take_progress(const std::string& line);
  nlohmann::json json_of(const Job& job) const;

  Publish publish_;
  mutable std::mutex mutex_;  ///< guards all below
  std::condition_variable changed_;
  std::optional<Job> job_;
  int process_ = 0;  ///< while it is not waited for: until then the number is no other's
  bool alive_ = false, cancelled_ = false;
  double last_progress_ = 0.0;  ///< s
  std::thread runner_, ender_;
};

}  // namespace manoscope::serve
