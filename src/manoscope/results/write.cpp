#include "manoscope/results/write.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/results/map_pictures.hpp"
#include "manoscope/results/netcdf.hpp"
#include "manoscope/results/publication.hpp"
#include "manoscope/results/tables.hpp"

namespace manoscope::results {
namespace {

namespace fs = std::filesystem;

const char* const kResultFile = "result.nc";
const char* const kMapsFile = "maps.nc";

/// True for a name that stays inside the folder: relative, without "..".
bool stays_inside(const fs::path& name) {
  return !name.empty() && name.is_relative() &&
         std::find(name.begin(), name.end(), fs::path("..")) == name.end();
}

/// What an earlier result left: the files it names itself, and those every result has.
std::vector<fs::path> earlier_files(const fs::path& folder) {
  std::vector<fs::path> names{kResultFile, "pressure.csv", "drops.csv", kMapsFile, "report.html"};
  for (const std::string& name : published_files(folder / kResultFile)) {
    if (stays_inside(name) &&
        std::find(names.begin(), names.end(), fs::path(name)) == names.end()) {
      names.emplace_back(name);
    }
  }
  return names;
}

}  // namespace

void write_result(const fs::path& folder, const Measurement& measurement,
                  const std::vector<ExtraFile>& extra_files) {
  std::vector<std::string> names{"pressure.csv", "drops.csv"};
  for (const ExtraFile& extra : extra_files) {
    if (!stays_inside(extra.name)) {
      throw InternalError(
          fmt::format("{} is no name inside the result folder", extra.name.string()));
    }
    names.push_back(extra.name.generic_string());
  }
  if (!measurement.map_picture.empty()) names.emplace_back(kMapsFile);
  names.emplace_back(kResultFile);

  Publication publication(folder);
  publication.add("pressure.csv", pressure_table(measurement));
  publication.add("drops.csv", drops_table(measurement));
  for (const ExtraFile& extra : extra_files) publication.add(extra.name, extra.bytes);
  if (!measurement.map_picture.empty()) {
    publication.add(kMapsFile, [&](const fs::path& path) {
      write_map_pictures(path, folder / kMapsFile, measurement);
    });
  }
  // Added last, published last: where result.nc is, the rest is there already.
  publication.add(kResultFile, [&](const fs::path& path) {
    write_netcdf(path, folder / kResultFile, measurement, names);
  });
  publication.publish(earlier_files(folder));
}

bool check_destination(const fs::path& folder, const std::string& title, bool overwrite) {
  const fs::path file = folder / kResultFile;
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error))) {
    for (const char* name : {"pressure.csv", "drops.csv", "report.html"}) {
      if (overwrite || !fs::exists(fs::symlink_status(folder / name, error))) continue;
      throw InputError((folder / name).string(), "it is there already, and no result beside it",
                       "Choose another folder, or give --overwrite to replace it");
    }
    return false;
  }
  if (overwrite) return true;
  const auto earlier = title_in(file);
  if (earlier == title) return true;
  throw InputError(file.string(),
                   earlier
                       ? fmt::format("another experiment's result stands there, \"{}\"", *earlier)
                       : "a file that is no readable result stands there",
                   "Choose another folder, or give --overwrite to replace it");
}

Measurement read_result(const fs::path& folder_or_file) {
  std::error_code ignored;
  const bool folder = fs::is_directory(folder_or_file, ignored);
  const fs::path file = folder ? folder_or_file / kResultFile : folder_or_file;
  if (folder && !fs::exists(file, ignored)) {
    throw InputError(folder_or_file.string(), "holds no result.nc",
                     "Give the folder that a finished measurement wrote");
  }
  return read_netcdf(file);
}

std::vector<MapPicture> read_maps(const fs::path& folder_or_file, const Measurement& measurement) {
  std::error_code ignored;
  const fs::path folder =
      fs::is_directory(folder_or_file, ignored) ? folder_or_file : folder_or_file.parent_path();
  return read_map_pictures(folder / kMapsFile, measurement);
}

}  // namespace manoscope::results
