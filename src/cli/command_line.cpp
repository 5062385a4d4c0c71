#include "command_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <string_view>

#include "manoscope/core/child_process.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/suggest.hpp"
#include "progress_bar.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

volatile std::sig_atomic_t stop_signal = 0;

/// A first Ctrl-C, or the end of the terminal, stops the work at its next checkpoint; a second
/// Ctrl-C ends the program at once. A terminal that ends tells so more than once.
extern "C" void on_stop(int signal) {
  if (stop_signal == 0 || signal == SIGHUP) {
    stop_signal = signal;
    return;
  }
  ProgressBar::clear_at_signal();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// There is one terminal, and all that is written passes by here.
ProgressBar& progress_bar() {
  static ProgressBar bar;
  return bar;
}

/// Lines that end with a word on a terminal; whole elsewhere, where a line is what is searched for.
void write_remark(const std::string& text) {
  progress_bar().clear();
  const Screen screen = screen_of(STDERR_FILENO);
  const std::string lines = screen.terminal ? wrapped(text, screen.columns) : text + '\n';
  std::fputs(lines.c_str(), stderr);
}

/// Progress for a program: a line of JSON a per cent.
class ProgressLines {
 public:
  /// @param stage  its name holds nothing that JSON would escape.
  void tell(std::string_view stage, double fraction) {
    const std::scoped_lock guard(mutex_);
    const int percent = static_cast<int>(fraction * 100.0);
    if (percent == last_percent_ && stage == last_stage_) return;
    last_percent_ = percent;
    last_stage_ = stage;
    const std::string line = fmt::format(
        "{{\"progress\": {{\"stage\": \"{}\", \"fraction\": {:.4f}}}}}\n", stage, fraction);
    std::fwrite(line.data(), 1, line.size(), stderr);
  }

 private:
  std::mutex mutex_;
  int last_percent_ = -1;
  std::string last_stage_;
};

void say(const std::string& kind, const std::string& text) {
  write_remark(fmt::format("manoscope: {}: {}", kind, text));
}

}  // namespace

struct Command::Impl {
  CLI::App* app = nullptr;
  Context* context = nullptr;
};

struct Program::Impl {
  CLI::App app{"Pressure inside micro-channels, read off the deflection of their wall"};
  Context context;
};

Command::Command(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Command::Command(Command&&) noexcept = default;
Command::~Command() = default;

void Command::positional(const std::string& name, std::filesystem::path& value,
                         const std::string& help) {
  impl_->app->add_option(name, value, help)->required()->type_name("");
}

void Command::positional(const std::string& name, std::string& value, const std::string& help) {
  impl_->app->add_option(name, value, help)->required()->type_name("");
}

void Command::optional_positional(const std::string& name, std::string& value,
                                  const std::string& help) {
  impl_->app->add_option(name, value, help)->type_name("");
}

void Command::positional(const std::string& name, std::vector<std::filesystem::path>& value,
                         const std::string& help) {
  impl_->app->add_option(name, value, help)->required()->type_name("");
}

void Command::option(const std::string& names, std::filesystem::path& value,
                     const std::string& help, bool required) {
  impl_->app->add_option(names, value, help)->required(required)->type_name("PATH");
}

void Command::option(const std::string& names, std::string& value, const std::string& help,
                     bool required) {
  impl_->app->add_option(names, value, help)->required(required)->type_name("TEXT");
}

void Command::option(const std::string& names, std::vector<std::string>& values,
                     const std::string& help, bool required) {
  impl_->app->add_option(names, values, help)
      ->required(required)
      ->allow_extra_args(false)
      ->delimiter(',')
      ->type_name("TEXT");
}

void Command::flag(const std::string& names, bool& value, const std::string& help) {
  impl_->app->add_flag(names, value, help);
}

void Command::described(const OptionInfo& info, const std::string& group,
                        const std::function<void(const std::string&)>& set) {
  impl_->app->add_option_function<std::string>("--" + info.name, set, info.help)
      ->type_name(info.kind)
      ->default_str(info.value)
      ->group(group);
}

std::function<std::vector<std::string>()> Command::given() const {
  return [app = impl_->app] {
    std::vector<std::string> names;
    for (const CLI::Option* option : app->get_options()) {
      if (option->count() > 0) names.push_back(option->get_single_name());
    }
    return names;
  };
}

void Command::action(std::function<void(const Context&)> run) {
  impl_->app->callback([run = std::move(run), context = impl_->context] { run(*context); });
}

Program::Program() : impl_(std::make_unique<Impl>()) {
  CLI::App& app = impl_->app;
  app.name("manoscope");
  app.require_subcommand(1);
  app.set_version_flag("--version",
                       fmt::format("manoscope {} ({})", program_version(), source_revision()));
  app.get_formatter()->column_width(34);
  app.footer(
      "Results go to standard output or files, progress and warnings to standard error.\n"
      "Exit codes: 0 done, 1 a fault of the program, 2 a fault of the input, 130 "
      "interrupted.");
}

Program::~Program() = default;

Command Program::command(const std::string& name, const std::string& help) {
  auto impl = std::make_unique<Command::Impl>();
  impl->app = impl_->app.add_subcommand(name, help);
  impl->context = &impl_->context;
  Context& context = impl_->context;
  constexpr const char* kGroup = "Common options";
  CLI::App& app = *impl->app;
  app.add_option("--threads", context.threads, "threads to use; 0 = all the machine has")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->group(kGroup);
  app.add_option("--seed", context.seed, "seed of everything that is drawn at random")
      ->type_name("N")
      ->group(kGroup);
  app.add_flag("--quiet", context.quiet, "no progress, no remarks, only the shortest tables")
      ->group(kGroup);
  app.add_flag("--progress", context.progress,
               "progress on standard error as lines of JSON, for programs")
      ->group(kGroup);
  app.add_flag("--json", context.json, "machine-readable output, SI units")->group(kGroup);
  return Command(std::move(impl));
}

int Program::run(int argc, char** argv) {
  std::signal(SIGINT, on_stop);
  std::signal(SIGTERM, on_stop);
  // The terminal was closed; not where the user said to go on without it (nohup).
  if (std::signal(SIGHUP, on_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  end_with_parent();
  std::signal(SIGPIPE, SIG_IGN);
  Impl& impl = *impl_;
  impl.context.monitor.stop_requested = [] { return stop_signal != 0; };
  impl.context.screen = screen_of(STDOUT_FILENO);
  impl.context.monitor.progress = [&impl, lines = std::make_shared<ProgressLines>(),
                                   moves = screen_of(STDERR_FILENO).moves](std::string_view stage,
                                                                           double fraction) {
    if (impl.context.progress) {
      lines->tell(stage, fraction);
    } else if (moves && !impl.context.quiet) {
      progress_bar().show(stage, fraction);
    }
  };
  constexpr int kOurFault = 1, kUsersFault = 2, kInterrupted = 130;
  if (argc < 2) {
    std::fputs(impl.app.help().c_str(), stderr);
    return kUsersFault;
  }
  try {
    impl.app.parse(argc, argv);
    progress_bar().clear();
    return 0;
  } catch (const CLI::CallForHelp& request) {
    return impl.app.exit(request);
  } catch (const CLI::CallForAllHelp& request) {
    return impl.app.exit(request);
  } catch (const CLI::CallForVersion& request) {
    return impl.app.exit(request);
  } catch (const CLI::ParseError& error) {
    std::vector<std::string> names;
    for (const CLI::App* known : impl.app.get_subcommands({})) names.push_back(known->get_name());
    const bool has_command = argc > 1 && argv[1][0] != '-';
    const bool known = has_command && std::find(names.begin(), names.end(), argv[1]) != names.end();
    if (has_command && !known) {
      say("error", fmt::format("there is no command \"{}\"{}. `manoscope --help` lists them.",
                               argv[1], did_you_mean(argv[1], names)));
    } else {
      say("error", fmt::format("{}. See `manoscope{} --help`.", error.what(),
                               known ? std::string(" ") + argv[1] : ""));
    }
    return kUsersFault;
  } catch (const InputErrors& errors) {
    for (const InputError& fault : errors.faults()) say("error", fault.what());
    return kUsersFault;
  } catch (const InputError& error) {
    say("error", error.what());
    return kUsersFault;
  } catch (const Interrupted&) {
    say("stopped", "interrupted; nothing was half-written");
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    say("error", "out of memory. Free some, or use fewer --threads.");
    return kOurFault;
  } catch (const std::exception& error) {
    say("fault of the program",
        fmt::format("{}. Please report it with the input that led here.", error.what()));
    return kOurFault;
  }
}

void print(const std::string& text) {
  progress_bar().clear();
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) {
    throw InputError("standard output", "cannot be written",
                     "Check the disk or the pipe it goes to");
  }
}

void remark(const Context& context, const std::string& text) {
  if (!context.quiet) write_remark(text);
}

}  // namespace manoscope::cli
