#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace manoscope::io {

/// An HDF5 file, open for reading: every failure is an InputError naming the file.
///
/// For the process that reads HDF5 alone (one thread). What lies outside of the file (external
/// storage, virtual datasets, external and soft links) is not followed: a map names no other file.
class Hdf5File {
 public:
  struct Dataset {
    std::string path;                  ///< without the leading '/'
    std::vector<std::uint64_t> shape;  ///< slowest index first
    bool numeric = false;              ///< integers or floats
    bool compressed = false;           ///< by any filter; the file may be smaller than its values
    bool elsewhere = false;            ///< values lie in another file or dataset
    std::size_t bytes_per_value = 0;
  };
  /// How Zygo's program turns stored numbers to a quantity.
  struct Converter {
    std::string category, unit;
    std::vector<double> parameters;
  };

  explicit Hdf5File(const std::filesystem::path& path);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  const std::string& where() const { return where_; }
  /// Every dataset, sorted by path.
  const std::vector<Dataset>& datasets() const { return datasets_; }
  /// Every group, without the leading '/'; the root is "".
  const std::vector<std::string>& groups() const { return groups_; }

  // Attributes of a group or dataset; absent, or of another kind: nullopt.
  std::optional<std::string> text_attribute(const std::string& object,
                                            const std::string& name) const;
  std::optional<double> number_attribute(const std::string& object, const std::string& name) const;
  std::optional<Converter> converter(const std::string& object, const std::string& name) const;
  /// A number in a compound attribute.
  std::optional<double> member(const std::string& object, const std::string& attribute,
                               const std::string& name) const;
  std::vector<std::string> attribute_names(const std::string& object) const;
  /// Attributes that are one text or one number, as settings.
  std::vector<std::pair<std::string, std::string>> settings(const std::string& object) const;

  /// All values, or those of one index of the first dimension; NaN become quiet.
  /// @throws InputError if the dataset announces more than the file can hold, or is `elsewhere`.
  void read(const Dataset& dataset, std::optional<std::uint64_t> index, double* values) const;

 private:
  void visit();
  Dataset describe(const std::string& path) const;
  void check_room(const Dataset& dataset) const;

  std::string where_;
  std::uintmax_t file_size_ = 0;
  std::int64_t file_ = -1;
  std::vector<Dataset> datasets_;
  std::vector<std::string> groups_;
};

}  // namespace manoscope::io
