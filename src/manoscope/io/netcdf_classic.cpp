#include "manoscope/io/netcdf_classic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "manoscope/io/byte_cursor.hpp"

namespace manoscope::io {
namespace {

constexpr const char* kMend = "The file is incomplete or damaged; copy or export it again";
constexpr std::uint32_t kDimensionTag = 10, kVariableTag = 11, kAttributeTag = 12;
constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

std::uint64_t saturating_product(std::uint64_t a, std::uint64_t b) {
  return a != 0 && b > kMost / a ? kMost : a * b;
}
std::uint64_t saturating_sum(std::uint64_t a, std::uint64_t b) {
  return b > kMost - a ? kMost : a + b;
}
std::uint64_t padded(std::uint64_t n_bytes) {
  return n_bytes > kMost - 3 ? kMost : (n_bytes + 3) / 4 * 4;
}

struct Placed {
  std::string name;
  std::uint64_t begin = 0;
  std::uint64_t bytes = 0;  ///< of the whole variable, or of one record
  bool records = false;
};

class Walk {
 public:
  Walk(std::string_view bytes, const std::string& where) : cursor_(bytes, where) {}

  void run() {
    cursor_.skip(3);
    version_ = cursor_.u8();
    const std::uint64_t n_records = count();
    dimensions();
    attributes();
    variables();
    data(n_records);
  }

 private:
  std::uint64_t count() {
    return version_ == 5 ? cursor_.u64(Endian::big) : cursor_.u32(Endian::big);
  }

  /// Number of items of a list; each takes at least `least_bytes`.
  std::uint64_t list(std::uint32_t wanted_tag, std::uint64_t least_bytes, std::string_view what) {
    const std::uint32_t tag = cursor_.u32(Endian::big);
    const std::uint64_t n = count();
    if (tag != wanted_tag && !(tag == 0 && n == 0)) {
      cursor_.fail(fmt::format("has tag {} where the list of {} begins", tag, what), kMend);
    }
    cursor_.require(n, least_bytes, what);
    return n;
  }

  std::string name() {
    const std::uint64_t length = count();
    cursor_.require(length, 1, "letters of a name");
    if (length == 0) cursor_.fail("has a name without letters", kMend);
    std::string text(cursor_.bytes(length));
    cursor_.align(4);
    return text;
  }

  std::uint64_t value_bytes() {
    const std::uint32_t type = cursor_.u32(Endian::big);
    // NC_BYTE, CHAR, SHORT, INT, FLOAT, DOUBLE; CDF-5 adds UBYTE, USHORT, UINT, INT64, UINT64.
    constexpr std::uint64_t kBytes[] = {1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    if (type < 1 || type > (version_ == 5 ? 11U : 6U)) {
      cursor_.fail(fmt::format("has a value of unknown type {}", type), kMend);
    }
    return kBytes[type - 1];
  }

  void dimensions() {
    const std::uint64_t n = list(kDimensionTag, 12, "dimensions");
    for (std::uint64_t i = 0; i < n; ++i) {
      static_cast<void>(name());
      lengths_.push_back(count());
    }
    if (std::count(lengths_.begin(), lengths_.end(), std::uint64_t{0}) > 1) {
      cursor_.fail("has more than one unlimited dimension", kMend);
    }
  }

  void attributes() {
    const std::uint64_t n = list(kAttributeTag, 16, "attributes");
    for (std::uint64_t i = 0; i < n; ++i) {
      static_cast<void>(name());
      const std::uint64_t item = value_bytes();
      const std::uint64_t n_values = count();
      cursor_.require(n_values, item, "attribute values");
      cursor_.skip(n_values * item);
      cursor_.align(4);
    }
  }

  void variables() {
    const std::uint64_t n = list(kVariableTag, 32, "variables");
    for (std::uint64_t i = 0; i < n; ++i) {
      Placed variable;
      variable.name = name();
      const std::uint64_t n_dimensions = count();
      cursor_.require(n_dimensions, 4, "dimensions of a variable");
      std::uint64_t n_values = 1;
      for (std::uint64_t d = 0; d < n_dimensions; ++d) {
        const std::uint64_t id = count();
        if (id >= lengths_.size()) {
          cursor_.fail(fmt::format("names dimension {} of {}", id, lengths_.size()), kMend);
        }
        if (lengths_[id] == 0) {
          if (d != 0) cursor_.fail("has its unlimited dimension in an inner place", kMend);
          variable.records = true;
        } else {
          n_values = saturating_product(n_values, lengths_[id]);
        }
      }
      attributes();
      variable.bytes = saturating_product(n_values, value_bytes());
      static_cast<void>(count());  // vsize: redundant, and too small for what is large
      variable.begin = version_ == 1 ? cursor_.u32(Endian::big) : cursor_.u64(Endian::big);
      variables_.push_back(std::move(variable));
    }
  }

  void data(std::uint64_t n_records) {
    std::uint64_t record = 0, n_record_variables = 0;
    for (const Placed& variable : variables_) {
      if (!variable.records) continue;
      record = saturating_sum(record, padded(variable.bytes));
      ++n_record_variables;
    }
    for (const Placed& variable : variables_) {
      std::uint64_t end = saturating_sum(variable.begin, variable.bytes);
      if (variable.records) {
        if (n_records == 0) continue;
        // A lone record variable is stored without padding.
        const std::uint64_t stride = n_record_variables == 1 ? variable.bytes : record;
        end = saturating_sum(end, saturating_product(n_records - 1, stride));
      }
      if (variable.begin < cursor_.offset() || end > cursor_.size()) {
        throw InputError(
            cursor_.where(),
            fmt::format("its variable \"{}\" should lie in bytes {} to {}, but the file has {}",
                        variable.name, variable.begin, end, cursor_.size()),
            kMend);
      }
    }
  }

  ByteCursor cursor_;
  unsigned version_ = 0;
  std::vector<std::uint64_t> lengths_;
  std::vector<Placed> variables_;
};

}  // namespace

bool is_classic_netcdf(std::string_view bytes) {
  return bytes.size() >= 4 && bytes.starts_with("CDF") &&
         (bytes[3] == 1 || bytes[3] == 2 || bytes[3] == 5);
}

void check_classic_netcdf(std::string_view bytes, const std::string& where) {
  MANO_ASSERT(is_classic_netcdf(bytes));
  Walk(bytes, where).run();
}

}  // namespace manoscope::io
