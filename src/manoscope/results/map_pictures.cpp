#include "manoscope/results/map_pictures.hpp"

#include <fmt/format.h>
#include <netcdf.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/io/netcdf_handle.hpp"

namespace manoscope::results {
namespace {

using io::NetcdfFile;

const char* const kCounts = "deflection_counts";
const char* const kMend = "Measure again, or remove the file: the report then does without maps";

void require_one_grid(const Measurement& m) {
  const auto& pictures = m.map_picture;
  if (pictures.empty() || pictures.size() != m.map.size()) {
    throw InternalError(fmt::format("{} pictures of {} maps", pictures.size(), m.map.size()));
  }
  const auto& first = pictures.front();
  for (const MapPicture& picture : pictures) {
    const bool same = picture.x.size() == first.x.size() && picture.z.size() == first.z.size() &&
                      (picture.x == first.x).all() && (picture.z == first.z).all() &&
                      picture.counts.rows() == first.z.size() &&
                      picture.counts.cols() == first.x.size();
    if (!same) throw InternalError("the pictures of the maps are not of one grid");
  }
}

int define_counts(NetcdfFile& file, const std::vector<int>& dimensions, const MapPicture& first) {
  int id = 0;
  const auto check = [&](int status) { file.check(status, kCounts); };
  check(nc_def_var(file.id(), kCounts, NC_SHORT, 3, dimensions.data(), &id));
  const std::array<std::size_t, 3> chunk{1, static_cast<std::size_t>(first.z.size()),
                                         static_cast<std::size_t>(first.x.size())};
  check(nc_def_var_chunking(file.id(), id, NC_CHUNKED, chunk.data()));
  check(nc_def_var_fill(file.id(), id, NC_FILL, &MapPicture::kMissing));
  constexpr int kDeflateLevel = 1;  // of noise higher levels gain 3 %, at twice the time
  check(nc_def_var_deflate(file.id(), id, 1, 1, kDeflateLevel));
  file.put_attribute(id, "units", std::string("1"));
  file.put_attribute(id, "long_name",
                     std::string("deflection of the wall in multiples of step, positive away from "
                                 "the fluid"));
  return id;
}

int define_lengths(NetcdfFile& file, const std::string& name, int dimension,
                   const std::string& long_name) {
  const int id = file.define_double(name, {dimension});
  file.put_attribute(id, "units", std::string("m"));
  file.put_attribute(id, "long_name", long_name);
  return id;
}

NetcdfFile::Variable find(const NetcdfFile& file, const std::filesystem::path& path,
                          const std::string& name, const std::vector<std::string>& dimensions) {
  auto found = file.variable(name);
  if (!found) throw InputError(path.string(), fmt::format("has no variable {}", name), kMend);
  if (found->dimensions != dimensions || found->numeric == (name == "map")) {
    throw InputError(path.string(), fmt::format("variable {} is of another kind", name), kMend);
  }
  return *std::move(found);
}

Array1 as_array(const std::vector<double>& values) {
  return Eigen::Map<const Array1>(values.data(), static_cast<Index>(values.size()));
}

/// Refuses counts that no picture has, and grids without cells.
void require_picture(const MapPicture& picture, const std::filesystem::path& path) {
  const auto& counts = picture.counts;
  const bool fits = ((counts == MapPicture::kMissing) ||
                     (counts >= -MapPicture::kLargest && counts <= MapPicture::kLargest))
                        .all();
  const bool known = picture.x.isFinite().all() && picture.z.isFinite().all() && picture.step > 0.0;
  if (counts.size() > 0 && fits && known && std::isfinite(picture.step)) return;
  throw InputError(path.string(), "holds no pictures as manoscope writes them", kMend);
}

}  // namespace

void write_map_pictures(const std::filesystem::path& path, const std::filesystem::path& shown_as,
                        const Measurement& m) {
  require_one_grid(m);
  const MapPicture& first = m.map_picture.front();
  auto file = NetcdfFile::create(path, shown_as);
  file.put_attribute(NetcdfFile::kGlobal, "Conventions", std::string("CF-1.10"));
  file.put_attribute(NetcdfFile::kGlobal, "title", m.title);
  const int map = file.define_dimension("map", m.map.size());
  const int z = file.define_dimension("z", static_cast<std::size_t>(first.z.size()));
  const int x = file.define_dimension("x", static_cast<std::size_t>(first.x.size()));
  const int names = file.define_string("map", {map});
  file.put_attribute(names, "long_name", std::string("file name of the map"));
  const int along = define_lengths(file, "x", x, "distance from the inlet edge along the flow");
  const int across = define_lengths(file, "z", z, "distance from the centre line across the flow");
  const int step = define_lengths(file, "step", map, "deflection of one count");
  const int counts = define_counts(file, {map, z, x}, first);
  file.write(names, m.map);
  file.write(along, first.x.data());
  file.write(across, first.z.data());
  std::vector<double> steps;
  for (const MapPicture& picture : m.map_picture) steps.push_back(picture.step);
  file.write(step, steps.data());
  for (std::size_t i = 0; i < m.map_picture.size(); ++i) {
    const std::array<std::size_t, 3> start{i, 0, 0};
    const std::array<std::size_t, 3> count{1, static_cast<std::size_t>(first.z.size()),
                                           static_cast<std::size_t>(first.x.size())};
    file.check(nc_put_vara_short(file.id(), counts, start.data(), count.data(),
                                 m.map_picture[i].counts.data()),
               kCounts);
  }
  file.close();
}

std::vector<MapPicture> read_map_pictures(const std::filesystem::path& path, const Measurement& m) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {};
  const auto file = NetcdfFile::open(path);
  if (file.text_attribute(NetcdfFile::kGlobal, "title") != m.title ||
      file.read_strings(find(file, path, "map", {"map"})) != m.map) {
    return {};
  }
  const Array1 x = as_array(file.read_doubles(find(file, path, "x", {"x"})));
  const Array1 z = as_array(file.read_doubles(find(file, path, "z", {"z"})));
  const Array1 step = as_array(file.read_doubles(find(file, path, "step", {"map"})));
  const auto variable = find(file, path, kCounts, {"map", "z", "x"});
  file.check_room(variable);
  std::vector<MapPicture> pictures;
  for (std::size_t i = 0; i < m.map.size(); ++i) {
    MapPicture picture{x, z, step[static_cast<Index>(i)], Counts2(z.size(), x.size())};
    const std::array<std::size_t, 3> start{i, 0, 0};
    const std::array<std::size_t, 3> count{1, variable.shape[1], variable.shape[2]};
    file.check(nc_get_vara_short(file.id(), variable.id, start.data(), count.data(),
                                 picture.counts.data()),
               kCounts);
    require_picture(picture, path);
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace manoscope::results
