#include "manoscope/serve/jobs.hpp"

#include <signal.h>

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>

#include "manoscope/core/child_process.hpp"
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
  const std::scoped_lock lock(mutex_);
  return job_ ? json_of(*job_) : json(nullptr);
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

void Jobs::run(const JobOrder& order) {
  constexpr double kLongest = 7.0 * 24.0 * 3600.0;  // s: what runs longer hangs
  ChildProcess::Options options;
  options.wall_seconds = kLongest;
  options.messages_too = true;
  ChildEnd end;
  try {
    auto child = ChildProcess::start(order.words, options);
    if (child) {
      {
        const std::scoped_lock lock(mutex_);
        process_ = child->id();
        if (cancelled_) ::kill(process_, SIGINT);
      }
      each_line(*child, [this](const std::string& line) { take_line(line); });
      {
        // Once it is waited for, the number may be another process's.
        const std::scoped_lock lock(mutex_);
        process_ = 0;
      }
      end = child->wait();
    } else {
      take_line("the program cannot be started: " + order.words.front());
    }
  } catch (const InternalError& error) {
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

void Jobs::take_line(const std::string& line) {
  const std::scoped_lock lock(mutex_);
  Job& job = *job_;
  if (line.starts_with("{\"progress\"")) {
    const json told = json::parse(line, nullptr, false);
    const auto progress = told.is_object() ? told.find("progress") : told.end();
    if (progress != told.end() && progress->is_object()) {
      job.stage = progress->value("stage", "");
      job.fraction = progress->value("fraction", 0.0);
      if (now() - last_progress_ < kProgressEvery && job.fraction < 1.0) return;
      last_progress_ = now();
      publish_({{"type", "progress"},
                {"job", job.id},
                {"stage", job.stage},
                {"fraction", job.fraction}});
      return;
    }
  }
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
