#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "manoscope/io/byte_cursor.hpp"

namespace manoscope::io {

/// Kinds of items of a Bruker data set; what is not listed here has no use for a map.
enum class VcaType : std::uint8_t {
  named_matrix = 0x00,
  boolean = 0x01,
  i16 = 0x04,
  u16 = 0x05,
  i32 = 0x06,
  u32 = 0x07,
  i64 = 0x0a,
  u64 = 0x0b,
  f32 = 0x0c,
  f64 = 0x0d,
  type_id = 0x0e,
  text = 0x12,
  quantity = 0x13,
  time_stamp = 0x15,
  units = 0x18,
  f64_array = 0x40,
  text_list = 0x42,
  matrix = 0x45,
  raw_data = 0x46,
  raw_data_2d = 0x47,
  positions = 0x7c,
  container = 0x7d,
  terminator = 0x7f,
};

/// One item: a name, a type and the bytes [offset, offset + size) of the file that hold its value.
struct VcaItem {
  std::string_view name;
  VcaType type{};
  std::uint64_t offset = 0, size = 0;

  bool holds_items() const {
    return type == VcaType::container || type == VcaType::raw_data || type == VcaType::raw_data_2d;
  }
};

/// A number with its unit, as the file writes it.
struct VcaQuantity {
  double value = 0.0;
  std::string unit;
};

/// The item at the cursor, which moves behind it. Nothing at the end of a container, at one of the
/// types nobody has described, or where fewer than six bytes are left before `end`.
///
/// Source: the description in Gwyddion's import module dektakvca.
/// @throws InputError if the item reaches beyond `end`.
std::optional<VcaItem> next_vca_item(ByteCursor& cursor, std::uint64_t end);

/// The item of a container by its name. A container is read from its beginning each time: files
/// hold a few hundred items, and so no room is made for a damaged count.
std::optional<VcaItem> find_vca_item(ByteCursor& cursor, const VcaItem& container,
                                     std::string_view name);

/// Calls `each` for every item of a container.
template <class Each>
void for_each_vca_item(ByteCursor& cursor, const VcaItem& container, Each each) {
  std::uint64_t offset = container.offset;
  const std::uint64_t end = container.offset + container.size;
  while (true) {
    cursor.seek(offset);
    const auto item = next_vca_item(cursor, end);
    if (!item) return;
    offset = cursor.offset();
    each(*item);
  }
}

/// The value of an item of any numeric type; nothing for others.
std::optional<double> vca_number(ByteCursor& cursor, const VcaItem& item);

/// The value of a quantity; nothing for others.
std::optional<VcaQuantity> vca_quantity(ByteCursor& cursor, const VcaItem& item);

/// The value of a text, a number or a quantity in words; "" for others, and for what is not finite.
std::string vca_text(ByteCursor& cursor, const VcaItem& item);

}  // namespace manoscope::io
