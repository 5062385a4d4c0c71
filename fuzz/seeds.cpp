#include "fuzz/seeds.hpp"

#include <zip.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "fuzz/hdf5_seeds.hpp"
#include "fuzz/trial.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/test_bytes.hpp"
#include "manoscope/io/test_classic_netcdf.hpp"
#include "manoscope/io/test_confocal_files.hpp"
#include "manoscope/io/test_gwy.hpp"
#include "manoscope/io/test_instrument_files.hpp"
#include "manoscope/io/test_matlab.hpp"
#include "manoscope/io/test_sdf.hpp"
#include "manoscope/io/test_text.hpp"
#include "manoscope/io/test_tiff.hpp"
#include "manoscope/io/test_zip.hpp"
#include "manoscope/io/writer.hpp"
#include "manoscope/io/x3p_test_files.hpp"

namespace manoscope::fuzz {
namespace {

namespace own = io::testing;
using Parts = std::vector<std::pair<std::string, std::string>>;

const io::Reader& reader_named(std::string_view name) {
  for (const io::Reader* reader : io::readers()) {
    if (reader->name() == name) return *reader;
  }
  throw InternalError("no reader is named " + std::string(name));
}

/// The files of a zip archive; none if it is no whole one.
Parts unpacked(const std::string& bytes) {
  Parts parts;
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  zip_t* archive = source == nullptr ? nullptr : zip_open_from_source(source, ZIP_RDONLY, &error);
  if (archive == nullptr) return parts;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive, 0); ++i) {
    zip_stat_t status;
    const auto which = static_cast<zip_uint64_t>(i);
    if (zip_stat_index(archive, which, 0, &status) != 0) continue;
    std::string content(status.size, '\0');
    zip_file_t* file = zip_fopen_index(archive, which, 0);
    if (file == nullptr) continue;
    if (zip_fread(file, content.data(), content.size()) ==
        static_cast<zip_int64_t>(content.size())) {
      parts.emplace_back(status.name, content);
    }
    zip_fclose(file);
  }
  zip_discard(archive);
  return parts;
}

/// A zlib stream as a writer of the format would make it.
std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string zipped(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(zipped.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 6) != Z_OK) {
    throw InternalError("zlib packs nothing");
  }
  zipped.resize(size);
  return zipped;
}

/// Content of all parts but the first, each as a stream of zlib with its lengths before it, behind
/// the first part: a packed Digital Surf object, whose head is the first part.
std::string packed_surf(const Parts& parts) {
  std::string lengths, streams;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::string zipped = deflated(parts[i].second);
    lengths += own::little(parts[i].second.size(), 4) + own::little(zipped.size(), 4);
    streams += zipped;
  }
  return parts[0].second + own::little(parts.size() - 1, 4) + lengths + streams;
}

/// A MATLAB file: its head, and each other part as a packed element.
std::string packed_matlab(const Parts& parts) {
  constexpr std::uint64_t kCompressed = 15;
  std::string bytes = parts[0].second;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::string zipped = deflated(parts[i].second);
    bytes += own::little(kCompressed, 4) + own::little(zipped.size(), 4) + zipped;
  }
  return bytes;
}

class Collection {
 public:
  explicit Collection(std::filesystem::path scratch) : scratch_(std::move(scratch)) {}

  void add(std::string_view reader, const std::string& name, const std::string& bytes) {
    Seed seed;
    seed.reader = &reader_named(reader);
    seed.name = name;
    seed.bytes = bytes;
    seed.by_worker = is_hdf5(bytes);
    seeds_.push_back(std::move(seed));
  }
  void add_archive(std::string_view reader, const std::string& name, const Parts& parts,
                   const std::string& prefix = {}) {
    Seed seed;
    seed.reader = &reader_named(reader);
    seed.name = name;
    seed.parts = parts;
    seed.prefix = prefix;
    seed.bytes = seed.with(parts);
    seeds_.push_back(std::move(seed));
  }
  /// A file that `pack` makes of its parts.
  void add_packed(std::string_view reader, const std::string& name, const Parts& parts,
                  std::string (*pack)(const Parts&)) {
    Seed seed;
    seed.reader = &reader_named(reader);
    seed.name = name;
    seed.parts = parts;
    seed.pack = pack;
    seed.bytes = seed.with(parts);
    seeds_.push_back(std::move(seed));
  }
  /// A file of our own writer for that extension.
  void add_written(std::string_view reader, const std::string& name) {
    Array2 height(24, 32);
    for (Index i = 0; i < height.size(); ++i) {
      height.data()[i] = 1e-6 * std::sin(0.3 * static_cast<double>(i));
    }
    io::write_map(scratch_ / name, HeightMap(CameraGrid{32, 24, 1.5 * um, 2.0 * um}, height), "a");
    add(reader, name, own::bytes_of(scratch_ / name));
  }
  void add_folder(const std::filesystem::path& maps) {
    constexpr std::uintmax_t kLargest = std::uintmax_t{4} << 20;
    std::error_code absent;
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(maps, absent)) {
      if (entry.is_regular_file() && entry.file_size() <= kLargest) paths.push_back(entry.path());
    }
    std::sort(paths.begin(), paths.end());
    for (const auto& path : paths) {
      const std::string extension = path.extension().string();
      if (extension == ".md" || path.filename() == "expected.csv") continue;
      const std::string bytes = own::bytes_of(path);
      const std::string name = path.filename().string();
      const std::size_t n_before = seeds_.size();
      const io::Reader& reader = io::find_reader(path);
      add(reader.name(), name, bytes);
      if (bytes.starts_with("PK")) add_archive(reader.name(), name, unpacked(bytes));
      // Some are there to be refused.
      for (std::size_t i = n_before; i < seeds_.size(); ++i) seeds_[i].made_here = false;
    }
  }

  std::vector<Seed> seeds_;

 private:
  std::filesystem::path scratch_;
};

void add_texts(Collection& seeds) {
  std::string german = "# Breite: 12,34 \xC2\xB5m\n# H\xC3\xB6he: 5 \xC2\xB5m\nunit = nm\n";
  for (int row = 0; row < 12; ++row) german += "1,5;2,25;;-3,0e-2;Bad\r\n";
  std::string points = "x [um],y [um],Height [nm]\n", utf16 = "\xff\xfe";
  for (int i = 0; i < 30; ++i) {
    points += std::to_string(i % 5) + "," + std::to_string(i / 5) + "," + std::to_string(i) + "\n";
  }
  for (const char letter : std::string("# pitch: 1.5 um\n1 2 3\n4 5 nan\n")) {
    utf16 += std::string{letter, '\0'};
  }
  std::string hfm = "X;Y;valid\n[mm];[um];[1/0]\n", dektak = "Scan Parameters\nStylus,2 um\n";
  dektak += "Scan Data\n\nLateral um,Raw Micrometer,\n";
  for (int i = 0; i < 30; ++i) {
    hfm += std::to_string(i) + ";1.25;1\n";
    dektak += std::to_string(i) + ",-2e-3,,\r\n";
  }
  seeds.add("text", "map.txt", german);
  seeds.add("text", "points.csv", points);
  seeds.add("text", "map.txt", utf16);
  seeds.add_written("text", "map.csv");
  seeds.add("stylus-profile", "map.hfm", hfm);
  seeds.add("stylus-profile", "map.csv", dektak);
  seeds.add("zygo-xyz", "map.xyz", own::zygo_text());
  seeds.add("wyko-ascii", "map.asc", own::wyko_text(0));
  seeds.add("wyko-ascii", "map.asc", own::wyko_text(1));
  seeds.add("sdf", "map.sdf", own::text_sdf("aISO-1.0", "1 2.5 BAD\n-4 5 6e0\n*\n"));
}

void add_netcdf(Collection& seeds) {
  own::ClassicNetcdf file;
  file.dimensions = {{"y", 12}, {"x", 20}};
  std::vector<double> x, y, heights;
  for (int i = 0; i < 20; ++i) x.push_back(1e-6 * i);
  for (int i = 0; i < 12; ++i) y.push_back(2e-6 * i);
  for (int i = 0; i < 240; ++i) heights.push_back(1e-9 * i);
  file.variables = {{"y", {0}, {{"units", "m"}}, {}, own::ClassicNetcdf::doubles(y)},
                    {"x", {1}, {{"units", "m"}}, {}, own::ClassicNetcdf::doubles(x)},
                    {"height",
                     {0, 1},
                     {{"units", "m"}},
                     {{"scale_factor", 2.0}, {"_FillValue", -1.0}},
                     own::ClassicNetcdf::doubles(heights)}};
  for (const int version : {1, 2, 5}) seeds.add("netcdf", "map.nc", file.bytes(version));
  seeds.add_written("netcdf", "map4.nc");
}

void add_archives(Collection& seeds) {
  const std::string points(48, '\1');
  own::X3pParts list, integers, layers;
  list.points = "<ListDimension>6</ListDimension><DataList>";
  for (int i = 0; i < 6; ++i) {
    list.points +=
        "<Datum>" + std::to_string(i % 3) + "e-6;" + std::to_string(i / 3) + "e-6;1e-9</Datum>";
  }
  list.points += "</DataList>";
  list.xy_kind = 'A';
  integers.z_type = 'I';
  integers.z_kind = 'I';
  integers.z_increment = "1e-9";
  layers.n_layers = 2;
  layers.z_type = 'F';
  seeds.add_written("x3p", "map.x3p");
  seeds.add_archive("x3p", "map.x3p",
                    {{"main.xml", own::x3p_main({})}, {"bindata/data.bin", points}});
  seeds.add_archive("x3p", "map.x3p", {{"main.xml", own::x3p_main(list)}});
  seeds.add_archive(
      "x3p", "map.x3p",
      {{"main.xml", own::x3p_main(integers)}, {"bindata/data.bin", points.substr(0, 12)}});
  seeds.add_archive("x3p", "map.x3p",
                    {{"main.xml", own::x3p_main(layers)}, {"bindata/data.bin", points}});
  seeds.add_archive(
      "plux", "map.plux",
      {{"index.xml",
        "<xml><GENERAL><FOV_X>0.645</FOV_X><FOV_Y>0.5</FOV_Y><IMAGE_SIZE_X>3</IMAGE_SIZE_X>"
        "<IMAGE_SIZE_Y>2</IMAGE_SIZE_Y></GENERAL><LAYER_0><FILENAME_Z>LAYER_0.raw</FILENAME_Z>"
        "</LAYER_0></xml>"},
       {"LAYER_0.raw", points.substr(0, 24)}});
  own::KeyenceVk4 narrow;
  narrow.height_bits = 16;
  seeds.add("keyence-vk", "map.vk4", own::KeyenceVk4().bytes());
  seeds.add("keyence-vk", "map.vk4", narrow.bytes());
  seeds.add_archive("keyence-vk", "map.vk6", {{"Vk4File", narrow.bytes()}}, "VK6.....");
}

void add_tiff(Collection& seeds) {
  own::TiffPage page, packed, integers;
  page.data = own::tiff_floats(1.0F);
  page.description = "ImageJ=1.53t\nunit=um\nvunit=nm\ncf=0\nc0=0\nc1=2\n";
  page.per_unit_x = page.per_unit_y = 0.5;
  packed.compression = 32773;  // 24 bytes by PackBits: 24 literal ones
  packed.data = std::string(1, '\x17') + own::tiff_floats(2.0F);
  packed.nx = 6;
  packed.ny = 1;
  own::TiffPage lzw = packed, deflate = packed, wide = page;
  lzw.compression = 5;
  lzw.data = own::literal_lzw(own::tiff_floats(2.0F));
  deflate.compression = 8;
  deflate.data = deflated(own::tiff_floats(2.0F));
  wide.bits = 64;
  wide.data += wide.data;
  own::TiffPage packed_tiles = own::tiled_page(20, 18);
  packed_tiles.compression = 8;
  for (std::string& tile : packed_tiles.tiles) tile = deflated(tile);
  own::TiffPage stack = page;
  stack.description += "images=3\n";
  stack.data = own::tiff_floats(1.0F) + own::tiff_floats(2.0F) + own::tiff_floats(3.0F);
  for (const own::TiffPage& each : {lzw, deflate, wide, own::tiled_page(20, 18), packed_tiles}) {
    seeds.add("tiff", "map.tif", own::tiff_file({each}));
    seeds.add("tiff", "map.tif", own::tiff_file({each}, true, true));
  }
  seeds.add("tiff", "map.tif", own::tiff_file({page}, false, true));
  seeds.add("tiff", "map.tif", own::tiff_file({stack}));
  integers.bits = 16;
  integers.format = 2;
  integers.data = std::string(12, '\3');
  seeds.add("tiff", "map.tif", own::tiff_file({page}));
  seeds.add("tiff", "map.tif", own::tiff_file({page, page}, false));
  seeds.add("tiff", "map.tif", own::tiff_file({page, packed}));
  seeds.add("tiff", "map.tif", own::tiff_file({integers}));
  seeds.add_written("tiff", "map.tif");
}

void add_binaries(Collection& seeds) {
  own::ZygoDat inverted;
  inverted.sign = 1;
  inverted.phase_resolution = 2;
  seeds.add("zygo-dat", "map.dat", own::ZygoDat().bytes());
  seeds.add("zygo-dat", "map.dat", inverted.bytes());
  own::WykoOpd floats;
  floats.element_bytes = 4;
  seeds.add("wyko-opd", "map.opd", own::WykoOpd().bytes());
  seeds.add("wyko-opd", "map.opd", floats.bytes());
  own::SurfObject plain, compressed, colour;
  plain.special_points = true;
  compressed.compressed = true;
  compressed.type = 13;
  compressed.n_channels = 4;
  colour.type = 10;
  colour.bits = 16;
  seeds.add("digital-surf", "map.sur", plain.bytes());
  seeds.add("digital-surf", "map.sur",
            compressed.bytes() + colour.bytes() + colour.bytes() + colour.bytes());
  own::BrukerOpdx anonymous;
  anonymous.anonymous_matrix = anonymous.f64_samples = true;
  seeds.add("bruker-opdx", "map.opdx", own::BrukerOpdx().bytes());
  seeds.add("bruker-opdx", "map.opdx", anonymous.bytes());
  own::FrtMicroprof wide;
  wide.version = "1.01";
  wide.bits = 32;
  seeds.add("frt", "map.frt", own::FrtMicroprof().bytes());
  seeds.add("frt", "map.frt", wide.bytes());
  own::SensofarPlu layers;
  layers.n_layers = 3;
  seeds.add("sensofar-plu", "map.plu", own::SensofarPlu().bytes());
  seeds.add("sensofar-plu", "map.plu", layers.bytes());
  seeds.add("alicona-al3d", "map.al3d", own::AliconaAl3d().bytes());
  seeds.add("truemap-tmd", "map.tmd", own::TrueMapTmd().bytes());
  seeds.add("nanofocus-nms", "map.nms", own::NanoFocusNms().bytes());
  seeds.add("sdf", "map.sdf", own::binary_sdf("bISO-1.0", 5, std::string(12, '\2')));
  seeds.add("sdf", "map.sdf", own::binary_sdf("bISO-2.0", 7, std::string(48, '\2')));
  seeds.add("sdf", "map.sdf", own::binary_sdf("bISO-1.0", 3, std::string(24, '\2')));
  seeds.add_written("gsf", "map.gsf");
  using own::gwy_component;
  const std::vector<double> heights{1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6};
  const std::string meta =
      own::gwy_object("GwyContainer", gwy_component("a", 's', own::gwy_text("b")));
  seeds.add("gwy", "map.gwy",
            own::gwy_file(gwy_component("/0/data", 'o', own::gwy_field(heights, "m")) +
                          gwy_component("/0/data/title", 's', own::gwy_text("Topography")) +
                          gwy_component("/0/mask", 'o', own::gwy_field({0, 1, 0, 0, 0, 0}, "")) +
                          gwy_component("/0/meta", 'o', meta)));
}

void add_surf_streams(Collection& seeds) {
  own::SurfObject object;
  object.compressed = true;
  const std::string bytes = object.bytes();
  constexpr std::size_t kHead = 512 + 12;  // header, comment and private bytes
  std::string points;
  for (const int point : object.points) {
    points += own::little(static_cast<std::uint64_t>(point), 4);
  }
  seeds.add_packed("digital-surf", "map.sur",
                   {{"head", bytes.substr(0, kHead)},
                    {"points 1", points.substr(0, 10)},
                    {"points 2", points.substr(10)}},
                   packed_surf);
}

void add_matlab_streams(Collection& seeds) {
  const std::string bytes = own::matlab_file(false);
  constexpr std::size_t kHead = 128;
  const Parts parts{
      {"head", bytes.substr(0, kHead)}, {"z", bytes.substr(kHead)}, {"z", bytes.substr(kHead)}};
  seeds.add_packed("matlab", "map.mat", parts, packed_matlab);
  seeds.add("matlab", "map.mat", packed_matlab(parts));
}

}  // namespace

std::string Seed::with(const std::vector<std::pair<std::string, std::string>>& other_parts) const {
  return pack ? pack(other_parts) : prefix + own::stored_zip(other_parts);
}

std::vector<Seed> all_seeds(const std::filesystem::path& scratch,
                            const std::filesystem::path& maps) {
  Collection seeds(scratch);
  add_texts(seeds);
  add_netcdf(seeds);
  add_archives(seeds);
  add_tiff(seeds);
  add_binaries(seeds);
  add_surf_streams(seeds);
  seeds.add("matlab", "map.mat", own::matlab_file(false));
  seeds.add("matlab", "map.mat", own::matlab_file(true, 3));
  add_matlab_streams(seeds);
  for (const auto& [reader, path] : write_hdf5_seeds(scratch)) {
    seeds.add(reader, path.filename().string(), own::bytes_of(path));
  }
  seeds.add_folder(maps);
  for (const io::Reader* reader : io::readers()) {
    const bool has_one = std::any_of(seeds.seeds_.begin(), seeds.seeds_.end(),
                                     [&](const Seed& seed) { return seed.reader == reader; });
    if (!has_one) throw InternalError("no seed for the reader " + std::string(reader->name()));
  }
  return std::move(seeds.seeds_);
}

}  // namespace manoscope::fuzz
