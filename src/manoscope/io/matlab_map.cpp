// MATLAB files (.mat): level 5 (versions 5 to 7.2) here, version 7.3 through the process that reads
// HDF5.
//
// Source: MathWorks, "MAT-File Format", chapter 1, "MAT-File Level 5 File Format". A header of 128
// bytes, then elements: a type, a number of bytes, the bytes, padded to 8; short ones in one word.
// A matrix is an element of elements: flags with its class, dimensions, name, values by columns,
// which may be stored as a smaller type than the class. A compressed element is a zlib stream that
// unpacks to one element. Structs of one element are looked into; cells, objects, texts, sparse and
// complex matrices are passed over.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <numeric>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/array_maps.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/hdf5_worker.hpp"
#include "manoscope/io/sample_block.hpp"
#include "manoscope/io/zlib_stream.hpp"

namespace manoscope::io {
namespace {

constexpr const char* kSaveAgain = "Save it again in MATLAB: save('map.mat', 'height')";
constexpr std::string_view kLevel5 = "MATLAB 5.0 MAT-file", kLevel73 = "MATLAB 7.3 MAT-file";
constexpr std::uint64_t kHeaderBytes = 128;
constexpr std::size_t kMostArrays = 10'000;
constexpr int kDeepestStruct = 4;

enum ElementType : std::uint32_t {
  mi_int8 = 1,
  mi_uint8 = 2,
  mi_int16 = 3,
  mi_uint16 = 4,
  mi_int32 = 5,
  mi_uint32 = 6,
  mi_single = 7,
  mi_double = 9,
  mi_int64 = 12,
  mi_uint64 = 13,
  mi_matrix = 14,
  mi_compressed = 15,
};

constexpr unsigned kStructClass = 2, kDoubleClass = 6, kUint8Class = 9, kInt8Class = 8,
                   kUint64Class = 15;
constexpr unsigned kComplexFlag = 0x08, kLogicalFlag = 0x02;

struct Element {
  std::uint32_t type = 0;
  std::string_view bytes;
};

/// The next element; the cursor then stands before the one that follows.
Element next_element(ByteCursor& cursor, Endian order) {
  const std::uint32_t word = cursor.u32(order);
  Element element;
  if (word >> 16U != 0) {  // up to four bytes in the word of the count
    const std::uint32_t n_bytes = word >> 16U;
    element.type = word & 0xffffU;
    const std::string_view room = cursor.bytes(4);
    if (n_bytes > 4)
      cursor.fail(fmt::format("has a short element of {} bytes", n_bytes), kSaveAgain);
    element.bytes = room.substr(0, n_bytes);
    return element;
  }
  element.type = word;
  const std::uint32_t n_bytes = cursor.u32(order);
  element.bytes = cursor.bytes(n_bytes);
  // A compressed element is not padded; what a file ends with need not be.
  if (element.type != mi_compressed) {
    const std::uint64_t padding = (8 - n_bytes % 8) % 8;
    cursor.skip(std::min<std::uint64_t>(padding, cursor.remaining()));
  }
  return element;
}

std::uint64_t item_bytes(std::uint32_t type) {
  switch (type) {
    case mi_int8:
    case mi_uint8:
      return 1;
    case mi_int16:
    case mi_uint16:
      return 2;
    case mi_int32:
    case mi_uint32:
    case mi_single:
      return 4;
    case mi_double:
    case mi_int64:
    case mi_uint64:
      return 8;
    default:
      return 0;
  }
}

double item(ByteCursor& cursor, std::uint32_t type, Endian order) {
  switch (type) {
    case mi_int8:
      return cursor.i8();
    case mi_uint8:
      return cursor.u8();
    case mi_int16:
      return cursor.i16(order);
    case mi_uint16:
      return cursor.u16(order);
    case mi_int32:
      return cursor.i32(order);
    case mi_uint32:
      return cursor.u32(order);
    case mi_single:
      return cursor.f32(order);
    case mi_int64:
      return static_cast<double>(cursor.i64(order));
    case mi_uint64:
      return static_cast<double>(cursor.u64(order));
    default:
      return cursor.f64(order);
  }
}

class MatlabFile {
 public:
  MatlabFile(std::string bytes, std::string where) : where_(std::move(where)) {
    texts_.push_back(std::move(bytes));
    ByteCursor cursor(texts_.front(), where_);
    cursor.seek(std::min<std::uint64_t>(kHeaderBytes - 4, cursor.size()));
    const std::string_view mark = cursor.bytes(4).substr(2);
    if (mark != "IM" && mark != "MI") {
      cursor.fail("has no mark of its byte order at the end of its header", kSaveAgain);
    }
    order_ = mark == "IM" ? Endian::little : Endian::big;
    while (cursor.remaining() >= 8) {
      const Element element = next_element(cursor, order_);
      if (element.type == mi_matrix) matrix(element.bytes, "", 0);
      if (element.type == mi_compressed) compressed(element.bytes);
    }
  }

  const std::vector<NamedArray>& arrays() const { return arrays_; }

 private:
  void compressed(std::string_view zipped) {
    // The element inside tells its own length in the first eight bytes.
    const std::string head = unzip_head(zipped, 8, where_);
    ByteCursor cursor(head, where_);
    const std::uint32_t type = cursor.u32(order_), n_bytes = cursor.u32(order_);
    if (type != mi_matrix) return;
    ZlibOutput output(std::uint64_t{n_bytes} + 8, zipped.size(), where_);
    output.append(zipped, std::uint64_t{n_bytes} + 8);
    texts_.push_back(output.take());
    matrix(std::string_view(texts_.back()).substr(8), "", 0);
  }

  /// @param name  of the struct's field; a matrix of its own brings its name along.
  void matrix(std::string_view bytes, const std::string& field, int depth) {
    if (bytes.empty()) return;  // an empty field
    ByteCursor cursor(bytes, where_);
    const Element flags = next_element(cursor, order_);
    if (flags.type != mi_uint32 || flags.bytes.size() < 8) {
      cursor.fail("has a matrix without its flags", kSaveAgain);
    }
    const std::uint32_t word = ByteCursor(flags.bytes, where_).u32(order_);
    const unsigned kind = word & 0xffU, marks = word >> 8U & 0xffU;
    constexpr unsigned kOpaqueClass = 17;  // of another build, without dimensions
    if (kind >= kOpaqueClass) return;
    const std::vector<std::uint64_t> shape = dimensions(next_element(cursor, order_));
    const Element written_name = next_element(cursor, order_);
    const std::string name =
        field.empty() ? one_line(std::string_view(written_name.bytes).substr(0, 200)) : field;
    if (kind == kStructClass) return structure(cursor, shape, name, depth);
    if (kind < kDoubleClass || kind > kUint64Class || (marks & (kComplexFlag | kLogicalFlag)) != 0)
      return;
    if (kind == kInt8Class || kind == kUint8Class) return;  // a picture or a mask
    values(next_element(cursor, order_), shape, name);
  }

  std::vector<std::uint64_t> dimensions(const Element& element) const {
    constexpr std::size_t kMostDimensions = 32;
    if (element.type != mi_int32 || element.bytes.size() / 4 > kMostDimensions) {
      throw InputError(where_, "has a matrix without its dimensions", kSaveAgain);
    }
    ByteCursor cursor(element.bytes, where_);
    std::vector<std::uint64_t> shape;
    while (cursor.remaining() >= 4) {
      const std::int32_t length = cursor.i32(order_);
      if (length < 0) throw InputError(where_, "has a matrix of negative size", kSaveAgain);
      shape.push_back(static_cast<std::uint64_t>(length));
    }
    return shape;
  }

  void structure(ByteCursor& cursor, const std::vector<std::uint64_t>& shape,
                 const std::string& name, int depth) {
    const double n = std::accumulate(
        shape.begin(), shape.end(), 1.0,
        [](double product, std::uint64_t length) { return product * static_cast<double>(length); });
    if (n != 1.0 || depth == kDeepestStruct) return;
    const Element width = next_element(cursor, order_);
    if (width.type != mi_int32 || width.bytes.size() != 4) return;
    const std::int32_t letters = ByteCursor(width.bytes, where_).i32(order_);
    const Element names = next_element(cursor, order_);
    if (letters < 1 || names.bytes.size() % static_cast<std::uint32_t>(letters) != 0) {
      cursor.fail("has a struct whose field names do not add up", kSaveAgain);
    }
    ByteCursor field_names(names.bytes, where_);
    while (field_names.remaining() > 0) {
      const std::string field = one_line(field_names.text(static_cast<std::uint64_t>(letters)));
      const Element value = next_element(cursor, order_);
      if (value.type == mi_matrix)
        matrix(value.bytes, fmt::format("{}/{}", name, field), depth + 1);
    }
  }

  void values(const Element& element, const std::vector<std::uint64_t>& shape,
              const std::string& name) {
    const std::uint64_t size = item_bytes(element.type);
    if (size == 0) {
      throw InputError(
          where_, fmt::format("\"{}\" has values of unknown type {}", excerpt(name), element.type),
          kSaveAgain);
    }
    double n = 1.0;
    for (const std::uint64_t length : shape) n *= static_cast<double>(length);
    if (n * static_cast<double>(size) != static_cast<double>(element.bytes.size())) {
      throw InputError(
          where_,
          fmt::format("\"{}\" announces {} values of {} bytes, {} bytes are there", excerpt(name),
                      fmt::join(shape, " x "), size, element.bytes.size()),
          kSaveAgain);
    }
    if (arrays_.size() == kMostArrays) {
      throw InputError(where_, fmt::format("holds more than {} arrays", kMostArrays), kSaveAgain);
    }
    NamedArray array;
    array.name = name;
    array.shape.assign(shape.rbegin(), shape.rend());  // MATLAB's first index runs fastest
    array.by_columns = true;
    array.read = [element, order = order_, where = where_, size, shape](
                     std::optional<std::uint64_t> frame, double* into) {
      std::uint64_t n_values = element.bytes.size() / size;
      ByteCursor cursor(element.bytes, where);
      if (frame) {
        n_values /= shape.back();
        cursor.seek(*frame * n_values * size);
      }
      for (std::uint64_t i = 0; i < n_values; ++i) into[i] = item(cursor, element.type, order);
    };
    arrays_.push_back(std::move(array));
  }

  std::string where_;
  std::list<std::string> texts_;  // the file, and what was unpacked; elements are views of them
  Endian order_ = Endian::little;
  std::vector<NamedArray> arrays_;
};

class MatlabReader final : public Reader {
 public:
  std::string_view name() const override { return "matlab"; }
  std::string_view description() const override { return "MATLAB"; }
  std::vector<std::string> extensions() const override { return {".mat"}; }
  std::string_view orientation() const override {
    return "row 1 on top, as imagesc shows a matrix; heights positive upwards, as the file has "
           "them";
  }
  int score(const Probe& probe) const override {
    return probe.head.starts_with(kLevel5) || probe.head.starts_with(kLevel73) ? 100 : 0;
  }
  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    std::string bytes = read_file(path);
    if (bytes.starts_with(kLevel73)) return read_in_worker(name(), path, options);
    const MatlabFile file(std::move(bytes), path.string());
    return array_channels(file.arrays(), options, path.string());
  }
};

}  // namespace

const Reader& matlab_reader() {
  static const MatlabReader reader;
  return reader;
}

}  // namespace manoscope::io
