#include "manoscope/report/gnuplot.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::report {
namespace {

constexpr int kSilenceMs = 60'000;

[[noreturn]] void fail(const std::string& step, int error) {
  throw InternalError("gnuplot: " + step + ": " +
                      std::error_code(error, std::generic_category()).message());
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    close();
    number_ = std::exchange(other.number_, -1);
    return *this;
  }
  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_ = -1;
};

struct Pipe {
  Descriptor read, write;
  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("no pipe", errno);
    read = Descriptor(ends[0]);
    write = Descriptor(ends[1]);
  }
};

/// The script as a file in memory: a reader that dies early cannot hurt the writer.
Descriptor file_in_memory(std::string_view text) {
  Descriptor file(::memfd_create("script", MFD_CLOEXEC));
  if (!file.is_open()) fail("no file in memory", errno);
  while (!text.empty()) {
    const ssize_t written = ::write(file.number(), text.data(), text.size());
    if (written < 0) fail("script", errno);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::lseek(file.number(), 0, SEEK_SET) != 0) fail("script", errno);
  return file;
}

/// Fixed locale; of the user's variables only those that say where things are.
std::vector<std::string> environment() {
  std::vector<std::string> variables{"LC_ALL=C.UTF-8"};
  for (const char* name : {"PATH", "HOME", "TMPDIR", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"}) {
    if (const char* value = std::getenv(name)) variables.push_back(std::string(name) + "=" + value);
  }
  return variables;
}

/// @return 0 if gnuplot is not there.
pid_t start(const Descriptor& input, const Descriptor& output, const Descriptor& messages) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.number(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.number(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, messages.number(), STDERR_FILENO);
  std::vector<std::string> variables = environment();
  std::vector<char*> pointers;
  for (std::string& variable : variables) pointers.push_back(variable.data());
  pointers.push_back(nullptr);
  // As a named file, unlike a bare standard input, the script ends gnuplot at its first error.
  std::array<std::string, 3> words{"gnuplot", "--default-settings", "/dev/stdin"};
  std::array<char*, 4> arguments{words[0].data(), words[1].data(), words[2].data(), nullptr};
  pid_t process = 0;
  const int error =
      ::posix_spawnp(&process, "gnuplot", &actions, nullptr, arguments.data(), pointers.data());
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT || error == EACCES || error == ENOTDIR) return 0;
  if (error != 0) fail("cannot be started", error);
  return process;
}

/// Reads both streams until they end; false after a long silence.
bool collect(Descriptor& output, std::string& bytes, Descriptor& messages, std::string& text) {
  std::vector<char> buffer(1 << 16);
  while (output.is_open() || messages.is_open()) {
    std::array<pollfd, 2> waiting{{{output.number(), POLLIN, 0}, {messages.number(), POLLIN, 0}}};
    const int ready = ::poll(waiting.data(), waiting.size(), kSilenceMs);
    if (ready == 0) return false;
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0) fail("poll", errno);
    for (const auto& [event, stream, into] :
         {std::tuple{waiting[0], &output, &bytes}, std::tuple{waiting[1], &messages, &text}}) {
      if (event.revents == 0) continue;
      const ssize_t n = ::read(stream->number(), buffer.data(), buffer.size());
      if (n < 0 && errno == EINTR) continue;
      if (n > 0) into->append(buffer.data(), static_cast<std::size_t>(n));
      if (n <= 0) stream->close();
    }
  }
  return true;
}

}  // namespace

std::optional<GnuplotOutput> run_gnuplot(const std::string& script) {
  const Descriptor input = file_in_memory(script);
  Pipe output, messages;
  const pid_t process = start(input, output.write, messages.write);
  output.write.close();
  messages.write.close();
  if (process == 0) return std::nullopt;
  GnuplotOutput result;
  const bool ended = collect(output.read, result.bytes, messages.read, result.messages);
  if (!ended) ::kill(process, SIGKILL);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (!ended) result.messages += "stopped after a minute of silence";
  result.succeeded = ended && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  return result;
}

}  // namespace manoscope::report
