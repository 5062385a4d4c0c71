#include "manoscope/io/gwyddion_fallback.hpp"

#include <fmt/format.h>
#include <stdlib.h>
#include <sys/resource.h>

#include <system_error>

#include "manoscope/core/child_process.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/formats.hpp"

namespace manoscope::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVariable = "MANOSCOPE_GWYDDION";
constexpr double kWallSeconds = 120.0;
constexpr std::size_t kMostMessages = 4096;

/// A folder of its own, gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "manoscope-gwyddion-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw InputError(name, "no temporary folder can be made",
                       "Check the free space and the permissions there, or set TMPDIR");
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void limit(const ChildProcess& child, __rlimit_resource what, std::uintmax_t value) {
  const rlimit both{value, value};
  static_cast<void>(::prlimit(child.id(), what, &both, nullptr));
}

/// "Gwyddion 2.62", or "Gwyddion" if it does not say.
std::string version_of(const std::string& program) {
  ChildProcess::Options options;
  options.wall_seconds = 10.0;
  auto child = ChildProcess::start({program, "--version"}, options);
  const std::string text = child ? child->read_all(kMostMessages) : std::string();
  const std::string first = excerpt(text.substr(0, text.find('\n')));
  return first.starts_with("Gwyddion") ? first : std::string("Gwyddion");
}

void convert(const std::string& program, const fs::path& in, const fs::path& out) {
  constexpr std::uintmax_t kMemory = std::uintmax_t{4} << 30U;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(in, error);
  ChildProcess::Options options;
  options.wall_seconds = kWallSeconds;
  options.messages_too = true;
  options.environment = {"LC_ALL=C.UTF-8"};
  // An absolute name is never taken for an option.
  auto child = ChildProcess::start(
      {program, "--convert-to-gwy=" + out.string(), fs::absolute(in).string()}, options);
  if (!child) throw InputError(program, "cannot be started", "Check its permissions");
  limit(*child, RLIMIT_CORE, 0);
  limit(*child, RLIMIT_AS, kMemory + 32 * size);
  limit(*child, RLIMIT_FSIZE, kMemory);
  const std::string messages = child->read_all(kMostMessages);
  const ChildEnd end = child->wait();
  if (end.succeeded() && fs::exists(out, error)) return;
  std::string why = excerpt(messages.substr(0, messages.find('\n')));
  while (why.ends_with('.')) why.pop_back();
  if (end.timed_out) why = fmt::format("it did not finish in {:g} s", kWallSeconds);
  if (!end.timed_out && end.signal != 0) why = fmt::format("it failed (signal {})", end.signal);
  throw InputError(in.string(),
                   fmt::format("is of no format known here, and Gwyddion cannot read it either{}{}",
                               why.empty() ? "" : ": ", why),
                   "Export the map in a format that `manoscope formats` lists");
}

class GwyddionFallback final : public Reader {
 public:
  std::string_view name() const override { return "gwyddion"; }
  std::string_view description() const override { return "any other, by the program Gwyddion"; }
  std::vector<std::string> extensions() const override { return {}; }
  std::string_view orientation() const override {
    return "as Gwyddion imports the file, which this program does not know itself";
  }
  int score(const Probe&) const override { return 0; }

  std::vector<Channel> read(const fs::path& path, const ReadOptions& options) const override {
    const auto program = find_gwyddion();
    if (!program) {
      throw InputError(path.string(), "is of no known format", gwyddion_absence(options));
    }
    const TemporaryFolder folder;
    const fs::path converted = folder.path() / "map.gwy";
    convert(*program, path, converted);
    std::vector<Channel> channels;
    try {
      channels = gwy_reader().read(converted, options);
    } catch (const InputError& error) {
      throw InputError(path.string(), "as converted by Gwyddion: " + error.found(),
                       "Open the file in Gwyddion and save the height channel as .gwy");
    }
    const std::string version = version_of(*program);
    for (Channel& channel : channels) {
      channel.settings.emplace_back("read by", version);
      channel.warnings.push_back(
          fmt::format("read by {}, as no reader here knows the format: scale, sign and missing "
                      "pixels are as it imports them",
                      version));
    }
    return channels;
  }
};

}  // namespace

std::optional<std::string> find_gwyddion() {
  const char* named = ::getenv(kVariable);
  const std::string word = named == nullptr ? "" : named;
  if (word == "off") return std::nullopt;
  if (word.find('/') != std::string::npos) return word;
  return find_program(word.empty() ? "gwyddion" : word);
}

std::string gwyddion_absence(const ReadOptions& options) {
  const char* named = ::getenv(kVariable);
  if (!options.gwyddion) return "Gwyddion, which reads many more, is switched off (--gwyddion)";
  if (named != nullptr && std::string_view(named) == "off") {
    return fmt::format("Gwyddion, which reads many more, is switched off ({})", kVariable);
  }
  return "Gwyddion, which reads many more, is not installed: `apt install gwyddion`, and it is "
         "used "
         "by itself";
}

const Reader& gwyddion_fallback() {
  static const GwyddionFallback reader;
  return reader;
}

}  // namespace manoscope::io
