#include "manoscope/io/netcdf_handle.hpp"

#include <fmt/format.h>
#include <netcdf.h>
#include <netcdf_filter.h>

#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/byte_cursor.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/netcdf_classic.hpp"

namespace manoscope::io {
namespace {

/// The NetCDF library keeps its open files in globals: one lock for all who use it.
std::recursive_mutex& library_lock() {
  static std::recursive_mutex lock;
  return lock;
}

/// An absolute name is never taken for an internet address.
std::string plain_name(const std::filesystem::path& path) {
  return std::filesystem::absolute(path).string();
}

bool is_number(nc_type type) { return type >= NC_BYTE && type <= NC_UINT64 && type != NC_CHAR; }

/// Deflate shrinks by 1032 at most; other filters of the library do no better on noise.
constexpr std::uintmax_t kMostCompression = 1032;

}  // namespace

NetcdfFile::NetcdfFile(std::filesystem::path shown_as, bool writing)
    : lock_(library_lock()), shown_as_(std::move(shown_as)), writing_(writing) {}

NetcdfFile::NetcdfFile(NetcdfFile&& other) noexcept
    : lock_(std::move(other.lock_)),
      shown_as_(std::move(other.shown_as_)),
      file_size_(other.file_size_),
      writing_(other.writing_),
      id_(std::exchange(other.id_, -1)) {}

NetcdfFile::~NetcdfFile() {
  if (id_ >= 0) nc_close(id_);
}

NetcdfFile NetcdfFile::create(const std::filesystem::path& path,
                              const std::filesystem::path& shown_as) {
  NetcdfFile file(shown_as.empty() ? path : shown_as, true);
  int id = -1;
  file.check(nc_create(plain_name(path).c_str(), NC_NETCDF4 | NC_CLOBBER, &id), "create");
  file.id_ = id;
  return file;
}

NetcdfFile NetcdfFile::open(const std::filesystem::path& path) {
  NetcdfFile file(path, false);
  {
    const std::string bytes = read_file(path);
    file.file_size_ = bytes.size();
    if (is_classic_netcdf(bytes)) {
      check_classic_netcdf(bytes, path.string());
    } else if (!bytes.starts_with("\x89HDF\r\n\x1a\n")) {
      throw InputError(path.string(), "is not a NetCDF file",
                       "Give a classic NetCDF or a NetCDF-4 file");
    }
  }
  int id = -1;
  file.check(nc_open(plain_name(path).c_str(), NC_NOWRITE, &id), "open");
  file.id_ = id;
  return file;
}

void NetcdfFile::check(int status, std::string_view subject) const {
  if (status == NC_NOERR) return;
  throw InputError(shown_as_.string(),
                   fmt::format("cannot be {} ({}): {}", writing_ ? "written" : "read", subject,
                               nc_strerror(status)),
                   writing_ ? "Check the free space and the permissions of its folder"
                            : "The file is damaged or not NetCDF; copy or export it again");
}

void NetcdfFile::close() {
  if (id_ >= 0) check(nc_close(std::exchange(id_, -1)), "close");
}

int NetcdfFile::define_dimension(const std::string& name, std::size_t size) {
  int dimension = -1;
  // A length of 0 would mean an unlimited dimension.
  MANO_ASSERT(size > 0);
  check(nc_def_dim(id_, name.c_str(), size, &dimension), name);
  return dimension;
}

namespace {
int define(const NetcdfFile& file, const std::string& name, nc_type type,
           const std::vector<int>& dimensions) {
  int variable = -1;
  file.check(nc_def_var(file.id(), name.c_str(), type, static_cast<int>(dimensions.size()),
                        dimensions.data(), &variable),
             name);
  return variable;
}
}  // namespace

int NetcdfFile::define_double(const std::string& name, const std::vector<int>& dimensions) {
  return define(*this, name, NC_DOUBLE, dimensions);
}
int NetcdfFile::define_int(const std::string& name, const std::vector<int>& dimensions) {
  return define(*this, name, NC_INT, dimensions);
}
int NetcdfFile::define_ubyte(const std::string& name, const std::vector<int>& dimensions) {
  return define(*this, name, NC_UBYTE, dimensions);
}
int NetcdfFile::define_string(const std::string& name, const std::vector<int>& dimensions) {
  return define(*this, name, NC_STRING, dimensions);
}

void NetcdfFile::fill_with_nan(int variable) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  check(nc_def_var_fill(id_, variable, NC_FILL, &nan), "fill value");
}

void NetcdfFile::compress(int variable) {
  constexpr int kLevel = 4;
  check(nc_def_var_deflate(id_, variable, 1, 1, kLevel), "compression");
}

void NetcdfFile::put_attribute(int variable, const std::string& name, const std::string& text) {
  check(nc_put_att_text(id_, variable, name.c_str(), text.size(), text.data()), name);
}
void NetcdfFile::put_attribute(int variable, const std::string& name, double value) {
  check(nc_put_att_double(id_, variable, name.c_str(), NC_DOUBLE, 1, &value), name);
}
void NetcdfFile::put_attribute(int variable, const std::string& name,
                               const std::vector<unsigned char>& bits) {
  check(nc_put_att_uchar(id_, variable, name.c_str(), NC_UBYTE, bits.size(), bits.data()), name);
}

void NetcdfFile::write(int variable, const double* values) {
  check(nc_put_var_double(id_, variable, values), "values");
}
void NetcdfFile::write(int variable, const int* values) {
  check(nc_put_var_int(id_, variable, values), "values");
}
void NetcdfFile::write(int variable, const unsigned char* values) {
  check(nc_put_var_uchar(id_, variable, values), "values");
}
void NetcdfFile::write(int variable, const std::vector<std::string>& values) {
  std::vector<const char*> pointers;
  pointers.reserve(values.size());
  for (const std::string& value : values) pointers.push_back(value.c_str());
  check(nc_put_var_string(id_, variable, pointers.data()), "values");
}

std::size_t NetcdfFile::Variable::size() const {
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  std::size_t product = 1;
  for (const std::size_t length : shape) {
    if (length != 0 && product > kMost / length) return kMost;
    product *= length;
  }
  return product;
}

NetcdfFile::Variable NetcdfFile::describe(int id) const {
  Variable variable;
  variable.id = id;
  std::array<char, NC_MAX_NAME + 1> name{};
  nc_type type = NC_NAT;
  int n_dimensions = 0;
  check(nc_inq_var(id_, id, name.data(), &type, &n_dimensions, nullptr, nullptr), "variable");
  variable.name = name.data();
  variable.numeric = is_number(type);
  check(nc_inq_type(id_, type, nullptr, &variable.bytes_per_value), variable.name);
  std::vector<int> dimensions(static_cast<std::size_t>(n_dimensions));
  check(nc_inq_vardimid(id_, id, dimensions.data()), variable.name);
  for (const int dimension : dimensions) {
    std::size_t length = 0;
    check(nc_inq_dim(id_, dimension, name.data(), &length), variable.name);
    variable.dimensions.emplace_back(name.data());
    variable.shape.push_back(length);
  }
  std::size_t n_filters = 0;  // classic files know no filters and answer with an error
  variable.compressed =
      nc_inq_var_filter_ids(id_, id, &n_filters, nullptr) == NC_NOERR && n_filters > 0;
  return variable;
}

std::vector<NetcdfFile::Variable> NetcdfFile::variables() const {
  int n = 0;
  check(nc_inq_nvars(id_, &n), "variables");
  std::vector<int> ids(static_cast<std::size_t>(n));
  check(nc_inq_varids(id_, &n, ids.data()), "variables");
  std::vector<Variable> found;
  found.reserve(ids.size());
  for (const int id : ids) found.push_back(describe(id));
  return found;
}

std::optional<NetcdfFile::Variable> NetcdfFile::variable(const std::string& name) const {
  int id = -1;
  const int status = nc_inq_varid(id_, name.c_str(), &id);
  if (status == NC_ENOTVAR) return std::nullopt;
  check(status, name);
  return describe(id);
}

std::optional<std::string> NetcdfFile::text_attribute(int variable, const std::string& name) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(id_, variable, name.c_str(), &type, &length) != NC_NOERR) return std::nullopt;
  if (type == NC_CHAR) {
    std::string text(length, '\0');
    check(nc_get_att_text(id_, variable, name.c_str(), text.data()), name);
    while (text.ends_with('\0')) text.pop_back();
    return text;
  }
  if (type == NC_STRING && length == 1) {
    char* text = nullptr;
    check(nc_get_att_string(id_, variable, name.c_str(), &text), name);
    std::string copy = text == nullptr ? "" : text;
    nc_free_string(1, &text);
    return copy;
  }
  return std::nullopt;
}

std::optional<double> NetcdfFile::number_attribute(int variable, const std::string& name) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(id_, variable, name.c_str(), &type, &length) != NC_NOERR) return std::nullopt;
  if (!is_number(type) || length == 0) return std::nullopt;
  if (type == NC_FLOAT) {
    std::vector<float> values(length);
    check(nc_get_att_float(id_, variable, name.c_str(), values.data()), name);
    return double_from_f32_bits(std::bit_cast<std::uint32_t>(values.front()));
  }
  std::vector<double> values(length);
  check(nc_get_att_double(id_, variable, name.c_str(), values.data()), name);
  return double_from_f64_bits(std::bit_cast<std::uint64_t>(values.front()));
}

void NetcdfFile::check_room(const Variable& variable) const {
  const std::uintmax_t most = variable.compressed ? kMostCompression * file_size_ : file_size_;
  if (variable.bytes_per_value > 0 && variable.size() <= most / variable.bytes_per_value) return;
  throw InputError(
      shown_as_.string(),
      fmt::format("its variable \"{}\" announces {} values of {} bytes, in a file of {} bytes",
                  excerpt(variable.name), variable.size(), variable.bytes_per_value, file_size_),
      "The file is incomplete or damaged; copy or export it again");
}

void NetcdfFile::read(const Variable& variable, double* values) const {
  read_block(variable, std::vector<std::size_t>(variable.shape.size(), 0), variable.shape, values);
}

void NetcdfFile::read_slice(const Variable& variable, std::size_t index, double* values) const {
  MANO_ASSERT(!variable.shape.empty() && index < variable.shape[0]);
  std::vector<std::size_t> start(variable.shape.size(), 0), count = variable.shape;
  start[0] = index;
  count[0] = 1;
  read_block(variable, start, count, values);
}

void NetcdfFile::read_block(const Variable& variable, const std::vector<std::size_t>& start,
                            const std::vector<std::size_t>& count, double* values) const {
  check_room(variable);
  const std::string& name = variable.name;
  std::size_t size = 1;
  for (const std::size_t length : count) size *= length;
  nc_type type = NC_NAT;
  check(nc_inq_vartype(id_, variable.id, &type), name);
  if (!is_number(type)) {
    throw InputError(shown_as_.string(), fmt::format("its variable \"{}\" holds no numbers", name),
                     "Give a file written for this purpose");
  }
  if (type == NC_FLOAT) {
    std::vector<float> stored(size);
    check(nc_get_vara_float(id_, variable.id, start.data(), count.data(), stored.data()), name);
    for (std::size_t i = 0; i < size; ++i) {
      values[i] = double_from_f32_bits(std::bit_cast<std::uint32_t>(stored[i]));
    }
    return;
  }
  check(nc_get_vara_double(id_, variable.id, start.data(), count.data(), values), name);
  for (std::size_t i = 0; i < size; ++i) {
    values[i] = double_from_f64_bits(std::bit_cast<std::uint64_t>(values[i]));
  }
}

std::vector<double> NetcdfFile::read_doubles(const Variable& variable) const {
  check_room(variable);
  std::vector<double> values(variable.size());
  read(variable, values.data());
  return values;
}

std::vector<int> NetcdfFile::read_ints(const Variable& variable) const {
  check_room(variable);
  std::vector<int> values(variable.size());
  check(nc_get_var_int(id_, variable.id, values.data()), variable.name);
  return values;
}

std::vector<std::string> NetcdfFile::read_strings(const Variable& variable) const {
  check_room(variable);
  std::vector<char*> pointers(variable.size(), nullptr);
  check(nc_get_var_string(id_, variable.id, pointers.data()), variable.name);
  std::vector<std::string> values;
  values.reserve(pointers.size());
  for (const char* text : pointers) values.emplace_back(text == nullptr ? "" : text);
  nc_free_string(pointers.size(), pointers.data());
  return values;
}

}  // namespace manoscope::io
