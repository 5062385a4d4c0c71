#include "manoscope/core/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <system_error>
#include <thread>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope {
namespace {

/// A limit of time needs a clock; nothing of it enters a result.
long long now_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

[[noreturn]] void fail(const std::string& step, int error) {
  throw InternalError("child process: " + step + ": " +
                      std::error_code(error, std::generic_category()).message());
}

/// The inherited variables, without those that `added` names anew.
std::vector<std::string> variables_with(const std::vector<std::string>& added) {
  std::vector<std::string> variables = added;
  for (char** variable = environ; variable != nullptr && *variable != nullptr; ++variable) {
    const std::string text = *variable;
    const std::string name = text.substr(0, text.find('=') + 1);
    const bool named_anew = std::any_of(added.begin(), added.end(), [&](const std::string& other) {
      return !name.empty() && other.starts_with(name);
    });
    if (!named_anew) variables.push_back(text);
  }
  return variables;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Settings of one start; frees what the system keeps for them.
class SpawnSettings {
 public:
  SpawnSettings(int output, bool messages_too) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    if (messages_too) {
      posix_spawn_file_actions_adddup2(&actions_, output, STDERR_FILENO);
    } else {
      posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    }
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 34)
    posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
#endif
    posix_spawnattr_init(&attributes_);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(
        &attributes_,
        static_cast<short>(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP));
  }
  ~SpawnSettings() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&actions_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  const posix_spawn_file_actions_t* actions() const { return &actions_; }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace

std::optional<ChildProcess> ChildProcess::start(const std::vector<std::string>& words,
                                                const Options& options) {
  MANO_ASSERT(!words.empty());
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("no pipe", errno);
  // Fewer turns between the two processes; where the system says no, the usual 64 kB do.
  constexpr int kPipeBytes = 1 << 20;
  static_cast<void>(::fcntl(ends[0], F_SETPIPE_SZ, kPipeBytes));
  std::vector<std::string> arguments = words, variables = variables_with(options.environment);
  pid_t id = 0;
  int error = 0;
  {
    const SpawnSettings settings(ends[1], options.messages_too);
    error = ::posix_spawnp(&id, words[0].c_str(), settings.actions(), settings.attributes(),
                           pointers_to(arguments).data(), pointers_to(variables).data());
  }
  ::close(ends[1]);
  if (error != 0) {
    ::close(ends[0]);
    if (error == EAGAIN || error == ENOMEM) fail("cannot be started", error);
    return std::nullopt;
  }
  ChildProcess child;
  child.id_ = id;
  child.output_ = ends[0];
  child.stop_requested_ = options.stop_requested;
  child.grace_seconds_ = options.grace_seconds;
  child.deadline_ms_ = now_ms() + static_cast<long long>(options.wall_seconds * 1e3);
  return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : id_(std::exchange(other.id_, -1)),
      output_(std::exchange(other.output_, -1)),
      deadline_ms_(other.deadline_ms_),
      grace_seconds_(other.grace_seconds_),
      stop_requested_(std::move(other.stop_requested_)),
      timed_out_(other.timed_out_),
      ended_(other.ended_),
      end_(other.end_) {}

ChildProcess::~ChildProcess() {
  if (output_ >= 0) ::close(output_);
  if (id_ > 0 && !ended_) {
    kill();
    while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
}

int ChildProcess::milliseconds_left() const {
  return static_cast<int>(std::clamp<long long>(deadline_ms_ - now_ms(), 0, 1 << 30));
}

std::size_t ChildProcess::read(char* into, std::size_t size) {
  while (output_ >= 0 && !timed_out_) {
    pollfd waiting{output_, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, milliseconds_left());
    if (ready < 0 && errno == EINTR) {
      if (!stop_requested_ || !stop_requested_()) continue;
      kill();
      return 0;
    }
    if (ready < 0) fail("poll", errno);
    if (ready == 0) {
      timed_out_ = true;
      kill();
      return 0;
    }
    const ssize_t n = ::read(output_, into, size);
    if (n < 0 && errno == EINTR) continue;
    return n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  return 0;
}

std::string ChildProcess::read_all(std::size_t most) {
  std::string bytes;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = read(buffer.data(), buffer.size())) {
    bytes.append(buffer.data(), std::min(n, most - bytes.size()));
    if (bytes.size() == most) {
      kill();
      break;
    }
  }
  return bytes;
}

bool ChildProcess::has_ended() const {
  siginfo_t found{};  // its number stays taken till wait(): the group's is no stranger's
  return ::waitid(P_PID, static_cast<id_t>(id_), &found, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         found.si_pid == id_;
}

void ChildProcess::kill() {
  if (id_ <= 0 || ended_) return;
  if (grace_seconds_ > 0.0) {
    constexpr auto kPause = std::chrono::milliseconds(5);
    const long long last = now_ms() + static_cast<long long>(grace_seconds_ * 1e3);
    ::kill(-id_, SIGTERM);
    while (!has_ended() && now_ms() < last) std::this_thread::sleep_for(kPause);
  }
  ::kill(-id_, SIGKILL);
}

void ChildProcess::await_end() {
  // The end of the output is the end of nearly every child: polling is for those that linger.
  constexpr auto kPause = std::chrono::milliseconds(1);
  while (!ended_) {
    siginfo_t found{};
    const int kind = WEXITED | WNOWAIT | (timed_out_ ? 0 : WNOHANG);
    if (::waitid(P_PID, static_cast<id_t>(id_), &found, kind) != 0) {
      if (errno != EINTR) fail("wait", errno);
    } else if (found.si_pid == id_) {
      return;
    }
    if (!timed_out_ && milliseconds_left() == 0) {
      timed_out_ = true;
      kill();
    }
    std::this_thread::sleep_for(kPause);
  }
}

ChildEnd ChildProcess::wait() {
  if (ended_) return end_;
  await_end();
  int status = 0;
  while (::waitpid(id_, &status, 0) < 0) {
    if (errno != EINTR) fail("wait", errno);
  }
  ended_ = true;
  end_.timed_out = timed_out_;
  if (WIFEXITED(status)) end_.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end_.signal = WTERMSIG(status);
  return end_;
}

namespace {
constexpr const char* kParent = "MANOSCOPE_PARENT";
}

std::string variable_of_parent() { return std::string(kParent) + "=" + std::to_string(::getpid()); }

void end_with_parent() {
  const char* parent = std::getenv(kParent);
  if (parent == nullptr) return;
  const std::string wanted = parent;
  ::unsetenv(kParent);  // it is meant for this program, not for those that this one starts
  ::prctl(PR_SET_PDEATHSIG, SIGINT);
  if (std::to_string(::getppid()) != wanted) std::raise(SIGINT);  // gone already
}

std::optional<std::string> find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string folders = path == nullptr ? std::string() : path;
  while (!folders.empty()) {
    const auto colon = folders.find(':');
    const std::string folder = folders.substr(0, colon);
    folders.erase(0, colon == std::string::npos ? folders.size() : colon + 1);
    const std::string candidate = (folder.empty() ? std::string(".") : folder) + "/" + name;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return std::nullopt;
}

}  // namespace manoscope
