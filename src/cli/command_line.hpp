#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/core/options.hpp"
#include "screen.hpp"

namespace manoscope::cli {

/// What every command may use.
struct Context {
  bool json = false;
  bool quiet = false;
  bool progress = false;  ///< as lines for a program, wherever standard error goes
  int threads = 0;        ///< 0 = all the machine has
  std::uint64_t seed = 1;
  Monitor monitor;  ///< progress on a terminal, Ctrl-C
  Screen screen;    ///< of standard output
};

/// One command of the program while it is being described; keeps CLI11 in one source file.
class Command {
 public:
  struct Impl;
  explicit Command(std::unique_ptr<Impl> impl);
  Command(Command&&) noexcept;
  ~Command();

  void positional(const std::string& name, std::filesystem::path& value, const std::string& help);
  void positional(const std::string& name, std::vector<std::filesystem::path>& value,
                  const std::string& help);
  void positional(const std::string& name, std::string& value, const std::string& help);
  /// A word that may be left out.
  void optional_positional(const std::string& name, std::string& value, const std::string& help);
  /// A text option, e.g. "-o,--output".
  void option(const std::string& names, std::filesystem::path& value, const std::string& help,
              bool required);
  void option(const std::string& names, std::string& value, const std::string& help, bool required);
  /// A text option that may be given several times, or once with commas.
  void option(const std::string& names, std::vector<std::string>& values, const std::string& help,
              bool required);
  void flag(const std::string& names, bool& value, const std::string& help);

  /// Every option of a struct with describe(), under "--name".
  template <class Options>
  void options(Options& options, const std::string& group) {
    for (const OptionInfo& info : list_options(options)) {
      described(info, group, [&options, name = info.name](const std::string& text) {
        set_option(options, name, text, "--" + name);
      });
    }
  }
  /// Names without dashes of the options that the command line gives; to be asked in the action.
  std::function<std::vector<std::string>()> given() const;
  /// What to do once the words are understood.
  void action(std::function<void(const Context&)> run);

 private:
  void described(const OptionInfo& info, const std::string& group,
                 const std::function<void(const std::string&)>& set);
  std::unique_ptr<Impl> impl_;
};

/// The whole program: its commands and its exit codes.
class Program {
 public:
  Program();
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  Command command(const std::string& name, const std::string& help);
  /// Parses, runs, reports errors on stderr. @return exit code: 0 done, 1 our fault, 2 the user's,
  /// 130 interrupted.
  int run(int argc, char** argv);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  friend class Command;
};

/// Writes to standard output, checking that it arrived.
/// @throws InputError if it cannot be written (closed pipe, full disk).
void print(const std::string& text);
/// A remark on standard error, unless --quiet.
void remark(const Context& context, const std::string& text);

}  // namespace manoscope::cli
