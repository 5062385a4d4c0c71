#include "fuzz/hdf5_seeds.hpp"

#include <hdf5.h>

#include <cstddef>
#include <fstream>

#include "manoscope/core/error.hpp"
#include "manoscope/io/test_bytes.hpp"

namespace manoscope::fuzz {
namespace {

/// Identifiers of the library are numbers; a negative one is a failure.
hid_t sound(hid_t id) {
  if (id < 0) throw InternalError("HDF5 makes no sound file");
  return id;
}

/// An HDF5 file that is being written.
class NewFile {
 public:
  /// @param user_block  bytes left free in front.
  NewFile(const std::filesystem::path& path, hsize_t user_block = 0) {
    const hid_t creation = sound(H5Pcreate(H5P_FILE_CREATE));
    H5Pset_userblock(creation, user_block);
    file_ = sound(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT));
    H5Pclose(creation);
  }
  ~NewFile() { H5Fclose(file_); }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Values 0, 1, 2 ...; packed in one chunk by deflate where `packed` says so.
  void array(const char* path, std::vector<hsize_t> shape, bool packed = false) const {
    const hid_t links = sound(H5Pcreate(H5P_LINK_CREATE));
    H5Pset_create_intermediate_group(links, 1);
    const hid_t layout = sound(H5Pcreate(H5P_DATASET_CREATE));
    if (packed) {
      H5Pset_chunk(layout, static_cast<int>(shape.size()), shape.data());
      H5Pset_deflate(layout, 6);
    }
    std::size_t n = 1;
    for (const hsize_t length : shape) n *= length;
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = static_cast<double>(i);
    const hid_t space =
        sound(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr));
    const hid_t set =
        sound(H5Dcreate(file_, path, H5T_IEEE_F64LE, space, links, layout, H5P_DEFAULT));
    sound(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(layout);
    H5Pclose(links);
  }
  void text(const char* object, const char* name, const std::string& value) const {
    const hid_t type = sound(H5Tcopy(H5T_C_S1));
    H5Tset_size(type, value.size());
    const hid_t space = sound(H5Screate(H5S_SCALAR));
    attribute(object, name, type, space, value.data());
    H5Sclose(space);
    H5Tclose(type);
  }
  void number(const char* object, const char* name, double value) const {
    const hsize_t one = 1;
    const hid_t space = sound(H5Screate_simple(1, &one, nullptr));
    attribute(object, name, H5T_NATIVE_DOUBLE, space, &value);
    H5Sclose(space);
  }
  /// A pitch as Zygo Mx writes it: two texts and a list in one compound.
  void converter(const char* object, const char* name, double pitch) const {
    struct Converter {
      const char* category;
      const char* unit;
      hvl_t parameters;
    };
    double parameters[2] = {0.0, pitch};
    const Converter value{"LateralCat", "Pixels", {2, parameters}};
    const hid_t text = sound(H5Tcopy(H5T_C_S1)), list = sound(H5Tvlen_create(H5T_NATIVE_DOUBLE));
    H5Tset_size(text, H5T_VARIABLE);
    const hid_t type = sound(H5Tcreate(H5T_COMPOUND, sizeof(Converter)));
    H5Tinsert(type, "Category", offsetof(Converter, category), text);
    H5Tinsert(type, "BaseUnit", offsetof(Converter, unit), text);
    H5Tinsert(type, "Parameters", offsetof(Converter, parameters), list);
    const hsize_t one = 1;
    const hid_t space = sound(H5Screate_simple(1, &one, nullptr));
    attribute(object, name, type, space, &value);
    H5Sclose(space);
    for (const hid_t id : {type, list, text}) H5Tclose(id);
  }

 private:
  void attribute(const char* object, const char* name, hid_t type, hid_t space,
                 const void* value) const {
    const hid_t made = sound(
        H5Acreate_by_name(file_, object, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    sound(H5Awrite(made, type, value));
    H5Aclose(made);
  }

  hid_t file_ = -1;
};

void write_datx(const std::filesystem::path& path) {
  const NewFile file(path);
  const char* surface = "/Data/Surface/{A}";
  file.array(surface, {12, 20});
  file.text(surface, "Unit", "Fringes");
  file.number(surface, "No Data", 235.0);
  file.number(surface, "Wavelength", 632.8e-9);
  file.number(surface, "Interferometric Scale Factor", 0.5);
  file.number(surface, "Obliquity Factor", 1.1);
  file.converter(surface, "X Converter", 1.5e-6);
  file.converter(surface, "Y Converter", 2e-6);
  file.array("/Data/Intensity/{B}", {12, 20});
}

void write_matlab(const std::filesystem::path& path) {
  constexpr hsize_t kUserBlock = 512;
  {
    const NewFile file(path, kUserBlock);
    file.array("/z", {20, 12});
    file.text("/z", "MATLAB_class", "double");
    file.array("/scan/k", {2, 20, 12});
    file.text("/scan/k", "MATLAB_class", "double");
  }
  std::string head = io::testing::padded("MATLAB 7.3 MAT-file, by hand", 124, ' ');
  head += std::string("\0\x02IM", 4);
  std::fstream bytes(path, std::ios::binary | std::ios::in | std::ios::out);
  bytes.write(head.data(), static_cast<std::streamsize>(head.size()));
}

void write_plain(const std::filesystem::path& path, bool packed) {
  const NewFile file(path);
  file.array("/scan/height", {12, 20}, packed);
  file.text("/scan/height", "units", "nm");
  file.number("/scan/height", "_FillValue", 3.0);
  file.array("/scan/x", {20});
  file.text("/scan/x", "units", "um");
  file.array("/scan/y", {12});
  file.text("/scan/y", "units", "um");
  if (packed) file.array("/frames", {3, 12, 20}, true);
}

}  // namespace

std::vector<std::pair<std::string, std::filesystem::path>> write_hdf5_seeds(
    const std::filesystem::path& scratch) {
  write_datx(scratch / "map.datx");
  write_matlab(scratch / "map73.mat");
  write_plain(scratch / "map.h5", false);
  write_plain(scratch / "packed.h5", true);
  return {{"zygo-datx", scratch / "map.datx"},
          {"matlab", scratch / "map73.mat"},
          {"hdf5", scratch / "map.h5"},
          {"hdf5", scratch / "packed.h5"}};
}

}  // namespace manoscope::fuzz
