#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace manoscope::io {

/// An open NetCDF file: closes itself, and turns every failure into an InputError naming the file.
///
/// A thin layer: identifiers are the library's own integers, so that a caller who includes
/// <netcdf.h> may use `check(nc_...(file.id(), ...), "what")` for whatever is missing here.
/// The NetCDF library is not thread-safe: each object holds one common lock while it lives.
class NetcdfFile {
 public:
  static constexpr int kGlobal = -1;  ///< as variable: the file's own attributes (NC_GLOBAL)

  /// Makes a new NetCDF-4 file, replacing one that exists; the bytes hold no time stamp.
  /// Where the file is published under another name later, messages name that one: `shown_as`.
  static NetcdfFile create(const std::filesystem::path& path,
                           const std::filesystem::path& shown_as = {});
  /// Opens an existing file (classic or NetCDF-4) for reading.
  static NetcdfFile open(const std::filesystem::path& path);
  ~NetcdfFile();
  NetcdfFile(NetcdfFile&& other) noexcept;
  NetcdfFile& operator=(NetcdfFile&&) = delete;

  int id() const { return id_; }
  /// Throws InputError(file, "cannot be read|written (<subject>): <the library's words>") unless
  /// `status` is NC_NOERR.
  void check(int status, std::string_view subject) const;
  /// Flushes and closes; errors that a destructor would have to swallow are met here.
  void close();

  // Writing. Definitions and data may alternate freely (NetCDF-4).
  int define_dimension(const std::string& name, std::size_t size);
  int define_double(const std::string& name, const std::vector<int>& dimensions);
  int define_int(const std::string& name, const std::vector<int>& dimensions);
  int define_ubyte(const std::string& name, const std::vector<int>& dimensions);
  int define_string(const std::string& name, const std::vector<int>& dimensions);
  /// Sets the fill value of a double variable to NaN; before any data are written.
  void fill_with_nan(int variable);
  /// Shuffle + deflate: smaller files, same values.
  void compress(int variable);
  void put_attribute(int variable, const std::string& name, const std::string& text);
  void put_attribute(int variable, const std::string& name, double value);
  void put_attribute(int variable, const std::string& name, const std::vector<unsigned char>& bits);
  /// Whole variables, row-major; the caller vouches for the number of values.
  void write(int variable, const double* values);
  void write(int variable, const int* values);
  void write(int variable, const unsigned char* values);
  void write(int variable, const std::vector<std::string>& values);

  // Reading.
  struct Variable {
    int id = 0;
    std::string name;
    bool numeric = false;             ///< integers or floats, not text
    std::size_t bytes_per_value = 0;  ///< as stored
    bool compressed = false;          ///< by any filter; the file may be smaller than its values
    std::vector<std::string> dimensions;  ///< names, slowest first
    std::vector<std::size_t> shape;
    /// Number of values, saturating at the largest size_t.
    std::size_t size() const;
  };
  /// The variables of the root group, in the file's order.
  std::vector<Variable> variables() const;
  /// The variable of that name, nullopt if there is none.
  std::optional<Variable> variable(const std::string& name) const;
  /// Text of an attribute (char or one string), nullopt if absent or not text.
  std::optional<std::string> text_attribute(int variable, const std::string& name) const;
  /// First number of an attribute, nullopt if absent or not numeric.
  std::optional<double> number_attribute(int variable, const std::string& name) const;
  /// @throws InputError if the variable announces more than the file can hold.
  void check_room(const Variable& variable) const;
  /// Every value, converted to double, into room for `variable.size()`; signalling NaN become
  /// quiet. This and the following call check_room() first.
  void read(const Variable& variable, double* values) const;
  /// As read(), of one index of the first dimension.
  void read_slice(const Variable& variable, std::size_t index, double* values) const;
  std::vector<double> read_doubles(const Variable& variable) const;
  std::vector<int> read_ints(const Variable& variable) const;
  std::vector<std::string> read_strings(const Variable& variable) const;

 private:
  NetcdfFile(std::filesystem::path shown_as, bool writing);
  Variable describe(int variable) const;
  void read_block(const Variable& variable, const std::vector<std::size_t>& start,
                  const std::vector<std::size_t>& count, double* values) const;

  std::unique_lock<std::recursive_mutex> lock_;
  std::filesystem::path shown_as_;
  std::uintmax_t file_size_ = 0;  // of a file that was opened
  bool writing_ = false;
  int id_ = -1;
};

}  // namespace manoscope::io
