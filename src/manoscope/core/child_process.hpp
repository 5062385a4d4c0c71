#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace manoscope {

/// How a child process ended.
struct ChildEnd {
  int exit_code = -1;      ///< -1 if a signal ended it
  int signal = 0;          ///< 0 if it ended by itself
  bool timed_out = false;  ///< stopped by us, for its time was up

  bool succeeded() const { return exit_code == 0 && !timed_out; }
};

/// A program that runs beside this one and whose standard output is read here.
///
/// It is started by posix_spawn, which is safe in a program with threads: nothing of this process
/// is copied, and no descriptor but the three standard ones is handed on. It gets a process group
/// of its own, so that a Ctrl-C at the terminal reaches only the parent; whatever is left of the
/// group is killed when the object goes.
class ChildProcess {
 public:
  struct Options {
    double wall_seconds = 60.0;            ///< from the start; then the group is killed
    bool messages_too = false;             ///< read its standard error as well, else drop it
    std::vector<std::string> environment;  ///< "NAME=value", beside what is inherited
    std::function<bool()> stop_requested;  ///< asked when a signal comes; true ends the child
    /// From SIGTERM to SIGKILL, for a child that ends others itself (mpirun's are in groups of
    /// their own); 0: SIGKILL at once.
    double grace_seconds = 0.0;
  };

  /// Starts `words[0]`, a path or a program to be found on PATH.
  /// @return nullopt if there is no such program, or it cannot be run.
  /// @throws InternalError if the system refuses to start anything.
  static std::optional<ChildProcess> start(const std::vector<std::string>& words,
                                           const Options& options);
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  int id() const { return id_; }
  /// Reads at most `size` bytes, and at least one unless the output has ended, the time is up or a
  /// stop was requested.
  /// @return The number of bytes; 0 at the end.
  std::size_t read(char* into, std::size_t size);
  /// As much as there is, at most `most` bytes; more ends the child.
  std::string read_all(std::size_t most);
  /// Waits for the end of the child, at most until its time is up. Its number stays its own.
  void await_end();
  /// The same, and how it ended. From here on its number may be another process's.
  ChildEnd wait();
  /// Ends the child and its group, after Options::grace_seconds at the latest.
  void kill();

 private:
  ChildProcess() = default;
  int milliseconds_left() const;
  bool has_ended() const;

  int id_ = -1;
  int output_ = -1;
  long long deadline_ms_ = 0;  // of the steady clock
  double grace_seconds_ = 0.0;
  std::function<bool()> stop_requested_;
  bool timed_out_ = false;
  bool ended_ = false;
  ChildEnd end_;
};

/// An entry of Options::environment that lets a program which calls end_with_parent() end with the
/// thread that starts it, however that goes.
std::string variable_of_parent();
/// Has SIGINT sent to this program when the thread that started it is gone, if that asked for it.
/// To be called before there are threads.
void end_with_parent();

/// A program's path on PATH, nullopt if none is there that can be run.
std::optional<std::string> find_program(const std::string& name);

}  // namespace manoscope
