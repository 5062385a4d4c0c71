#include "manoscope/io/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "manoscope/core/error.hpp"
#include "manoscope/io/byte_cursor.hpp"
#include "manoscope/io/file_text.hpp"

namespace manoscope::io {
namespace {

constexpr const char* kMend = "The file is incomplete or damaged; copy or export it again";
constexpr std::size_t kMostObjects = 20'000, kLongestText = 1000;

/// An identifier of the library that is given back.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_t get() const { return id_; }
  bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  Close close_;
};

std::string rooted(const std::string& path) { return "/" + path; }

/// What a visit of the whole file collects; the library calls back from C, which no exception may
/// cross.
struct Found {
  std::vector<std::string> groups, datasets;
  bool too_many = false;
};

herr_t note_object(hid_t, const char* name, const H5O_info_t* info, void* data) {
  auto& found = *static_cast<Found*>(data);
  if (found.groups.size() + found.datasets.size() >= kMostObjects) {
    found.too_many = true;
    return 1;
  }
  try {
    const std::string path = std::string(name) == "." ? std::string() : std::string(name);
    if (info->type == H5O_TYPE_GROUP) found.groups.push_back(path);
    if (info->type == H5O_TYPE_DATASET) found.datasets.push_back(path);
  } catch (...) {
    return -1;
  }
  return 0;
}

herr_t note_attribute(hid_t, const char* name, const H5A_info_t*, void* data) {
  auto& names = *static_cast<std::vector<std::string>*>(data);
  constexpr std::size_t kMostAttributes = 500;
  if (names.size() >= kMostAttributes) return 1;
  try {
    names.emplace_back(name);
  } catch (...) {
    return -1;
  }
  return 0;
}

/// An attribute of an object, with its type and the number of its values.
struct Attribute {
  Handle attribute, type, space;
  Attribute(hid_t file, const std::string& object, const std::string& name)
      : attribute(H5Aexists_by_name(file, rooted(object).c_str(), name.c_str(), H5P_DEFAULT) > 0
                      ? H5Aopen_by_name(file, rooted(object).c_str(), name.c_str(), H5P_DEFAULT,
                                        H5P_DEFAULT)
                      : -1,
                  &H5Aclose),
        type(attribute.good() ? H5Aget_type(attribute.get()) : -1, &H5Tclose),
        space(attribute.good() ? H5Aget_space(attribute.get()) : -1, &H5Sclose) {}
  bool good() const { return attribute.good() && type.good() && space.good(); }
  hssize_t n_values() const { return good() ? H5Sget_simple_extent_npoints(space.get()) : -1; }
  H5T_class_t kind() const { return good() ? H5Tget_class(type.get()) : H5T_NO_CLASS; }
};

double quiet(double value) { return double_from_f64_bits(std::bit_cast<std::uint64_t>(value)); }

/// A text of one value, read by `read(memory type, room)`.
template <class Read>
std::optional<std::string> text_value(hid_t type, const Read& read) {
  if (H5Tget_class(type) != H5T_STRING) return std::nullopt;
  if (H5Tis_variable_str(type) > 0) {
    const Handle memory(H5Tcopy(H5T_C_S1), &H5Tclose);
    H5Tset_size(memory.get(), H5T_VARIABLE);
    H5Tset_cset(memory.get(), H5Tget_cset(type));
    char* text = nullptr;
    if (read(memory.get(), static_cast<void*>(&text)) < 0 || text == nullptr) return std::nullopt;
    std::string copy(text, ::strnlen(text, kLongestText));
    H5free_memory(text);
    return copy;
  }
  const std::size_t size = H5Tget_size(type);
  constexpr std::size_t kLargest = 1 << 20;
  if (size == 0 || size > kLargest) return std::nullopt;
  std::string text(size, '\0');
  if (read(type, static_cast<void*>(text.data())) < 0) return std::nullopt;
  text.resize(std::min(::strnlen(text.c_str(), size), kLongestText));
  return text;
}

/// Reads one member of a compound attribute into `room`, as `memory` describes it.
bool read_member(const Attribute& attribute, const std::string& name, hid_t memory, void* room,
                 std::size_t size) {
  const Handle compound(H5Tcreate(H5T_COMPOUND, size), &H5Tclose);
  return compound.good() && H5Tinsert(compound.get(), name.c_str(), 0, memory) >= 0 &&
         H5Aread(attribute.attribute.get(), compound.get(), room) >= 0;
}

}  // namespace

Hdf5File::Hdf5File(const std::filesystem::path& path) : where_(path.string()) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);  // no code from elsewhere, whatever filter a file names
  std::error_code error;
  file_size_ = std::filesystem::file_size(path, error);
  if (error) throw InputError(where_, error.message(), "Check the name of the file");
  file_ = H5Fopen(where_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) throw InputError(where_, "the HDF5 library cannot open it", kMend);
  try {
    visit();
  } catch (...) {
    H5Fclose(file_);
    throw;
  }
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::visit() {
  Found found;
  if (H5Ovisit2(file_, H5_INDEX_NAME, H5_ITER_INC, &note_object, &found, H5O_INFO_BASIC) < 0) {
    throw InputError(where_, "the HDF5 library cannot list what it holds", kMend);
  }
  if (found.too_many) {
    throw InputError(where_, fmt::format("holds more than {} groups and datasets", kMostObjects),
                     "Store the map in a file of its own");
  }
  groups_ = std::move(found.groups);
  std::sort(groups_.begin(), groups_.end());
  std::sort(found.datasets.begin(), found.datasets.end());
  for (const std::string& path : found.datasets) datasets_.push_back(describe(path));
}

Hdf5File::Dataset Hdf5File::describe(const std::string& path) const {
  const Handle set(H5Dopen2(file_, rooted(path).c_str(), H5P_DEFAULT), &H5Dclose);
  const Handle type(set.good() ? H5Dget_type(set.get()) : -1, &H5Tclose);
  const Handle space(set.good() ? H5Dget_space(set.get()) : -1, &H5Sclose);
  const Handle layout(set.good() ? H5Dget_create_plist(set.get()) : -1, &H5Pclose);
  if (!type.good() || !space.good() || !layout.good()) {
    throw InputError(where_, fmt::format("its dataset \"{}\" cannot be opened", excerpt(path)),
                     kMend);
  }
  Dataset dataset;
  dataset.path = path;
  const H5T_class_t kind = H5Tget_class(type.get());
  dataset.numeric = kind == H5T_INTEGER || kind == H5T_FLOAT;
  dataset.bytes_per_value = H5Tget_size(type.get());
  const int rank = H5Sget_simple_extent_ndims(space.get());
  std::array<hsize_t, H5S_MAX_RANK> lengths{};
  if (rank < 0 || H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr) < 0 ||
      H5Sget_simple_extent_type(space.get()) == H5S_NULL) {
    dataset.numeric = false;
    return dataset;
  }
  dataset.shape.assign(lengths.begin(), lengths.begin() + rank);
  dataset.compressed = H5Pget_nfilters(layout.get()) > 0;
  dataset.elsewhere =
      H5Pget_layout(layout.get()) == H5D_VIRTUAL || H5Pget_external_count(layout.get()) > 0;
  return dataset;
}

std::optional<std::string> Hdf5File::text_attribute(const std::string& object,
                                                    const std::string& name) const {
  const Attribute attribute(file_, object, name);
  if (attribute.n_values() != 1) return std::nullopt;
  return text_value(attribute.type.get(), [&](hid_t memory, void* room) {
    return H5Aread(attribute.attribute.get(), memory, room);
  });
}

std::optional<double> Hdf5File::number_attribute(const std::string& object,
                                                 const std::string& name) const {
  const Attribute attribute(file_, object, name);
  const H5T_class_t kind = attribute.kind();
  if (attribute.n_values() != 1 || (kind != H5T_INTEGER && kind != H5T_FLOAT)) return std::nullopt;
  double value = 0.0;
  if (H5Aread(attribute.attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0) return std::nullopt;
  return quiet(value);
}

std::optional<double> Hdf5File::member(const std::string& object, const std::string& attribute_name,
                                       const std::string& name) const {
  const Attribute attribute(file_, object, attribute_name);
  if (attribute.n_values() != 1 || attribute.kind() != H5T_COMPOUND) return std::nullopt;
  const int at = H5Tget_member_index(attribute.type.get(), name.c_str());
  if (at < 0) return std::nullopt;
  const H5T_class_t kind = H5Tget_member_class(attribute.type.get(), static_cast<unsigned>(at));
  double value = 0.0;
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) ||
      !read_member(attribute, name, H5T_NATIVE_DOUBLE, &value, sizeof(value))) {
    return std::nullopt;
  }
  return quiet(value);
}

std::optional<Hdf5File::Converter> Hdf5File::converter(const std::string& object,
                                                       const std::string& name) const {
  const Attribute attribute(file_, object, name);
  if (attribute.n_values() != 1 || attribute.kind() != H5T_COMPOUND) return std::nullopt;
  Converter converter;
  for (const auto& [member_name, into] :
       {std::pair{"Category", &converter.category}, std::pair{"BaseUnit", &converter.unit}}) {
    const int at = H5Tget_member_index(attribute.type.get(), member_name);
    if (at < 0) return std::nullopt;
    const Handle type(H5Tget_member_type(attribute.type.get(), static_cast<unsigned>(at)),
                      &H5Tclose);
    const char* key = member_name;
    const auto text = text_value(type.get(), [&](hid_t memory, void* room) {
      return read_member(attribute, key, memory, room, H5Tget_size(memory)) ? 0 : -1;
    });
    *into = text.value_or("");
  }
  const Handle memory(H5Tvlen_create(H5T_NATIVE_DOUBLE), &H5Tclose);
  const int at = H5Tget_member_index(attribute.type.get(), "Parameters");
  if (at < 0 || H5Tget_member_class(attribute.type.get(), static_cast<unsigned>(at)) != H5T_VLEN) {
    return converter;
  }
  hvl_t list{};
  if (read_member(attribute, "Parameters", memory.get(), &list, sizeof(list))) {
    constexpr std::size_t kMostParameters = 64;
    const auto* values = static_cast<const double*>(list.p);
    const std::size_t n = values == nullptr ? 0 : std::min(list.len, kMostParameters);
    for (std::size_t i = 0; i < n; ++i) converter.parameters.push_back(quiet(values[i]));
    if (list.p != nullptr) H5free_memory(list.p);
  }
  return converter;
}

std::vector<std::string> Hdf5File::attribute_names(const std::string& object) const {
  std::vector<std::string> names;
  const Handle opened(H5Oopen(file_, rooted(object).c_str(), H5P_DEFAULT), &H5Oclose);
  if (!opened.good()) return names;
  hsize_t index = 0;
  H5Aiterate2(opened.get(), H5_INDEX_NAME, H5_ITER_INC, &index, &note_attribute, &names);
  return names;
}

std::vector<std::pair<std::string, std::string>> Hdf5File::settings(
    const std::string& object) const {
  std::vector<std::pair<std::string, std::string>> found;
  for (const std::string& name : attribute_names(object)) {
    std::string value;
    if (const auto text = text_attribute(object, name)) {
      value = *text;
    } else if (const auto number = number_attribute(object, name);
               number && std::isfinite(*number)) {
      value = fmt::format("{:.10g}", *number);
    }
    if (!value.empty()) found.emplace_back(one_line(name), one_line(value));
  }
  return found;
}

void Hdf5File::check_room(const Dataset& dataset) const {
  // Deflate shrinks by 1032 at most; the other filters of the library do no better on noise.
  constexpr double kMostCompression = 1032.0;
  auto n_bytes = static_cast<double>(dataset.bytes_per_value);
  for (const std::uint64_t length : dataset.shape) n_bytes *= static_cast<double>(length);
  const double most =
      static_cast<double>(file_size_) * (dataset.compressed ? kMostCompression : 1.0);
  if (n_bytes <= most) return;
  throw InputError(where_,
                   fmt::format("its dataset \"{}\" announces {} values of {} bytes, in a file of "
                               "{} bytes",
                               excerpt(dataset.path), fmt::join(dataset.shape, " x "),
                               dataset.bytes_per_value, file_size_),
                   kMend);
}

void Hdf5File::read(const Dataset& dataset, std::optional<std::uint64_t> index,
                    double* values) const {
  const std::string name = excerpt(dataset.path);
  if (dataset.elsewhere) {
    throw InputError(where_, fmt::format("the values of \"{}\" lie in another place", name),
                     "Store them in the file itself, as one dataset");
  }
  check_room(dataset);
  const Handle set(H5Dopen2(file_, rooted(dataset.path).c_str(), H5P_DEFAULT), &H5Dclose);
  const Handle in_file(set.good() ? H5Dget_space(set.get()) : -1, &H5Sclose);
  std::vector<hsize_t> start(dataset.shape.size(), 0);
  std::vector<hsize_t> count(dataset.shape.begin(), dataset.shape.end());
  if (index && !count.empty()) {
    start[0] = *index;
    count[0] = 1;
    if (!in_file.good() || H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr,
                                               count.data(), nullptr) < 0) {
      throw InputError(where_, fmt::format("its dataset \"{}\" has no frame {}", name, *index + 1),
                       kMend);
    }
  }
  std::size_t n = 1;
  for (const hsize_t length : count) n *= length;
  const hsize_t length = n;
  const Handle in_memory(H5Screate_simple(1, &length, nullptr), &H5Sclose);
  if (!in_file.good() || !in_memory.good() ||
      H5Sget_select_npoints(in_file.get()) != static_cast<hssize_t>(n) ||
      H5Dread(set.get(), H5T_NATIVE_DOUBLE, in_memory.get(), in_file.get(), H5P_DEFAULT, values) <
          0) {
    throw InputError(
        where_, fmt::format("the values of \"{}\" cannot be read", name),
        "The file is damaged, or packed by a filter that the HDF5 library lacks; store "
        "it anew without compression");
  }
  for (std::size_t i = 0; i < n; ++i) values[i] = quiet(values[i]);
}

}  // namespace manoscope::io
