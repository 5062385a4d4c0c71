// The readers of files built on HDF5: they say what is theirs, and have another process parse it.
#include <algorithm>

#include "manoscope/io/file_text.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/hdf5_worker.hpp"

namespace manoscope::io {
namespace {

constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";

bool has_extension(const Probe& probe, const std::vector<std::string>& extensions) {
  const std::string extension = lower_case(probe.path.extension().string());
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

class ZygoDatxReader final : public Reader {
 public:
  std::string_view name() const override { return "zygo-datx"; }
  std::string_view description() const override { return "Zygo Mx"; }
  std::vector<std::string> extensions() const override { return {".datx"}; }
  int score(const Probe& probe) const override {
    return probe.head.starts_with(kSignature) && has_extension(probe, extensions()) ? 90 : 0;
  }
  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    return read_in_worker(name(), path, options);
  }
};

class Hdf5Reader final : public Reader {
 public:
  std::string_view name() const override { return "hdf5"; }
  std::string_view description() const override { return "HDF5"; }
  std::vector<std::string> extensions() const override { return {".h5", ".hdf5", ".hdf", ".he5"}; }
  int score(const Probe& probe) const override {
    if (!probe.head.starts_with(kSignature)) return 0;
    return has_extension(probe, extensions()) ? 60 : 30;
  }
  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    return read_in_worker(name(), path, options);
  }
};

}  // namespace

const Reader& zygo_datx_reader() {
  static const ZygoDatxReader reader;
  return reader;
}

const Reader& hdf5_reader() {
  static const Hdf5Reader reader;
  return reader;
}

}  // namespace manoscope::io
