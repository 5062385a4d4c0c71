#include "manoscope/serve/jobs.hpp"

#include <signal.h>

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>

#include "manoscope/serve/api_error.hpp"

namespace manoscope::serve {
namespace {

using nlohmann::json;

constexpr std::size_t kMostLines = 400, kLongestLine = 2000;
constexpr double kProgressEvery = 0.1;  // s
constexpr auto kPatience = std::chrono::seconds(5);

double now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Calls `take` with every line of a child's output.
template <class Take>
void each_line(ChildProcess& child, const Take& take) {
  std::string line;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = child.read(buffer.data(), buffer.size())) {
    for (const char letter : std::string_view(buffer.data(), n)) {
      if (letter != '\n') {
        if (line.size() < kLongestLine) line += letter;
        continue;
      }
      take(line);
      line.clear();
    }
  }
  if (!line.empty()) take(line);
}

}  // namespace

Jobs::Jobs(Publish publish) : publish_(std::move(publish)) {}

Jobs::~Jobs() {
  try {
    cancel();
  } catch (const ApiError&) {
    // nothing runs
  }
  if (runner_.joinable()) runner_.join();
  if (ender_.joinable()) ender_.join();
}

json Jobs::json_of(const Job& job) const {
  constexpr const char* kStates[] = {"running", "done", "failed", "cancelled"};
  const bool runs = job.state == State::running;
  return {{"id", job.id},
          {"experiment", job.order.experiment},
          {"output", job.order.output},
          {"command", job.order.words},
          {"state", kStates[static_cast<int>(job.state)]},
          {"stage", job.stage},
          {"fraction", job.fraction},
          {"log", job.log},
          {"started", job.started},
          {"seconds", runs ? now() - job.started : job.seconds},
          {"exit_code", job.exit_code ? json(*job.exit_code) : json(nullptr)},
          {"signal", job.signal ? json(*job.signal) : json(nullptr)}};
}

json Jobs::current() const {
  json job;
  look([&](const json& told) { job = told; });
  return job;
}

void Jobs::look(const std::function<void(const json& job)>& see) const {
  const std::scoped_lock lock(mutex_);
  see(job_ ? json_of(*job_) : json(nullptr));
}

json Jobs::start(const JobOrder& order) {
  std::unique_lock lock(mutex_);
  if (job_ && job_->state == State::running) {
    throw ApiError(409, job_->order.experiment, "a measurement is running",
                   "Wait for its end, or cancel it");
  }
  // The last one's threads have nothing left to do; they need the lock to say so.
  std::thread runner = std::move(runner_), ender = std::move(ender_);
  const int id = job_ ? job_->id + 1 : 1;
  job_ = Job{};
  job_->id = id;
  job_->order = order;
  job_->order.words.front() = "manoscope";
  job_->started = now();
  cancelled_ = false;
  alive_ = true;
  last_progress_ = 0.0;
  json told = json_of(*job_);
  lock.unlock();
  if (runner.joinable()) runner.join();
  if (ender.joinable()) ender.join();
  lock.lock();
  publish_({{"type", "start"}, {"job", told}});
  runner_ = std::thread([this, order] { run(order); });
  return told;
}

/// Starts the process, tells its lines and waits for it.
void Jobs::measure(const JobOrder& order, ChildEnd& end) {
  constexpr double kLongest = 7.0 * 24.0 * 3600.0;  // s: what runs longer hangs
  ChildProcess::Options options;
  options.wall_seconds = kLongest;
  options.messages_too = true;
  options.environment = {variable_of_parent()};
  auto child = ChildProcess::start(order.words, options);
  if (!child) return take_line("the program cannot be started: " + order.words.front());
  {
    const std::scoped_lock lock(mutex_);
    process_ = child->id();
    if (cancelled_) ::kill(process_, SIGINT);
  }
  // Nothing of the process may end the server, and it can be cancelled until it is gone.
  std::exception_ptr failure;
  try {
    each_line(*child, [this](const std::string& line) { take_line(line); });
    child->await_end();
  } catch (...) {
    failure = std::current_exception();
  }
  {
    const std::scoped_lock lock(mutex_);
    process_ = 0;
  }
  if (failure) std::rethrow_exception(failure);
  end = child->wait();
}

void Jobs::run(const JobOrder& order) {
  ChildEnd end;
  try {
    measure(order, end);
  } catch (const std::exception& error) {
    take_line(error.what());
  }
  const std::scoped_lock lock(mutex_);
  alive_ = false;
  changed_.notify_all();
  Job& job = *job_;
  job.state = end.succeeded() ? State::done : cancelled_ ? State::cancelled : State::failed;
  job.seconds = now() - job.started;
  if (end.signal != 0) {
    job.signal = end.signal;
  } else {
    job.exit_code = end.exit_code;
  }
  if (job.state == State::done) job.fraction = 1.0;
  publish_({{"type", "end"}, {"job", json_of(job)}});
}

/// @return Whether the line told progress; the lock is held.
bool Jobs::take_progress(const std::string& line) {
  if (!line.starts_with("{\"progress\"")) return false;
  const json told = json::parse(line, nullptr, false);
  const auto progress = told.is_object() ? told.find("progress") : told.end();
  if (progress == told.end() || !progress->is_object()) return false;
  const auto stage = progress->find("stage"), fraction = progress->find("fraction");
  if (stage == progress->end() || !stage->is_string() || fraction == progress->end() ||
      !fraction->is_number()) {
    return false;
  }
  Job& job = *job_;
  job.stage = stage->get<std::string>();
  job.fraction = fraction->get<double>();
  if (now() - last_progress_ < kProgressEvery && job.fraction < 1.0) return true;
  last_progress_ = now();
  publish_(
      {{"type", "progress"}, {"job", job.id}, {"stage", job.stage}, {"fraction", job.fraction}});
  return true;
}

void Jobs::take_line(const std::string& line) {
  const std::scoped_lock lock(mutex_);
  if (take_progress(line)) return;
  Job& job = *job_;
  job.log.push_back(line);
  if (job.log.size() > kMostLines) job.log.pop_front();
  publish_({{"type", "log"}, {"job", job.id}, {"line", line}});
}

json Jobs::cancel() {
  const std::scoped_lock lock(mutex_);
  if (!job_ || job_->state != State::running) {
    throw ApiError(409, "", "no measurement is running", "Start one");
  }
  if (!cancelled_) {
    cancelled_ = true;
    if (process_ > 0) ::kill(process_, SIGINT);
    ender_ = std::thread([this] {
      std::unique_lock waiting(mutex_);
      const bool ended = changed_.wait_for(waiting, kPatience, [this] { return !alive_; });
      if (!ended && process_ > 0) ::kill(-process_, SIGKILL);
    });
  }
  return json_of(*job_);
}

}  // namespace manoscope::serve
