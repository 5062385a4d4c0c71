#include "manoscope/io/vca_items.hpp"

#include <fmt/format.h>

#include <cmath>

namespace manoscope::io {
namespace {

constexpr const char* kCopyAgain = "The file is damaged; copy or export it again";
constexpr std::uint64_t kLeastItem = 4 + 1 + 1;

std::string_view counted_bytes(ByteCursor& cursor) {
  const std::uint32_t n_bytes = cursor.u32(Endian::little);
  return cursor.bytes(n_bytes);
}

/// A length of 1, 2 or 4 bytes, after a byte that says how many.
std::uint64_t length(ByteCursor& cursor) {
  const std::uint8_t n_bytes = cursor.u8();
  switch (n_bytes) {
    case 1:
      return cursor.u8();
    case 2:
      return cursor.u16(Endian::little);
    case 4:
      return cursor.u32(Endian::little);
    default:
      cursor.fail(fmt::format("a length of {} bytes; known are 1, 2 and 4", n_bytes), kCopyAgain);
  }
}

/// How many bytes the value has that begins at the cursor; nothing if the type is not known.
std::optional<std::uint64_t> value_bytes(ByteCursor& cursor, VcaType type) {
  switch (type) {
    case VcaType::boolean:
      return 1;
    case VcaType::i16:
    case VcaType::u16:
      return 2;
    case VcaType::i32:
    case VcaType::u32:
    case VcaType::f32:
      return 4;
    case VcaType::i64:
    case VcaType::u64:
    case VcaType::f64:
      return 8;
    case VcaType::time_stamp:
      return 9;
    case VcaType::text:
    case VcaType::quantity:
    case VcaType::units:
    case VcaType::raw_data:
    case VcaType::raw_data_2d:
    case VcaType::container:
      return length(cursor);
    case VcaType::named_matrix:
      counted_bytes(cursor);  // name of its type
      cursor.skip(4);
      counted_bytes(cursor);
      return length(cursor);
    case VcaType::type_id:
    case VcaType::f64_array:
    case VcaType::text_list:
    case VcaType::matrix:
    case VcaType::positions:
      counted_bytes(cursor);  // name of its type
      return length(cursor);
    case VcaType::terminator:
      break;
  }
  return std::nullopt;
}

}  // namespace

std::optional<VcaItem> next_vca_item(ByteCursor& cursor, std::uint64_t end) {
  if (cursor.offset() >= end || end - cursor.offset() < kLeastItem) return std::nullopt;
  VcaItem item;
  item.name = counted_bytes(cursor);
  item.type = static_cast<VcaType>(cursor.u8());
  const auto size = value_bytes(cursor, item.type);
  if (!size) return std::nullopt;
  item.offset = cursor.offset();
  item.size = *size;
  if (item.offset > end || item.size > end - item.offset) {
    cursor.fail(fmt::format("an item of {} bytes reaches beyond the {} of its container", item.size,
                            end - std::min(item.offset, end)),
                kCopyAgain);
  }
  cursor.skip(item.size);
  return item;
}

std::optional<VcaItem> find_vca_item(ByteCursor& cursor, const VcaItem& container,
                                     std::string_view name) {
  std::uint64_t offset = container.offset;
  while (true) {
    cursor.seek(offset);
    const auto item = next_vca_item(cursor, container.offset + container.size);
    if (!item || item->name == name) return item;
    offset = cursor.offset();
  }
}

std::optional<double> vca_number(ByteCursor& cursor, const VcaItem& item) {
  cursor.seek(item.offset);
  switch (item.type) {
    case VcaType::boolean:
      return cursor.u8();
    case VcaType::i16:
      return cursor.i16(Endian::little);
    case VcaType::u16:
      return cursor.u16(Endian::little);
    case VcaType::i32:
      return cursor.i32(Endian::little);
    case VcaType::u32:
      return cursor.u32(Endian::little);
    case VcaType::i64:
      return static_cast<double>(cursor.i64(Endian::little));
    case VcaType::u64:
      return static_cast<double>(cursor.u64(Endian::little));
    case VcaType::f32:
      return cursor.f32(Endian::little);
    case VcaType::f64:
      return cursor.f64(Endian::little);
    default:
      return std::nullopt;
  }
}

std::optional<VcaQuantity> vca_quantity(ByteCursor& cursor, const VcaItem& item) {
  if (item.type != VcaType::quantity) return std::nullopt;
  cursor.seek(item.offset);
  VcaQuantity quantity;
  quantity.value = cursor.f64(Endian::little);
  counted_bytes(cursor);  // the unit's full name
  quantity.unit = std::string(counted_bytes(cursor));
  return quantity;
}

std::string vca_text(ByteCursor& cursor, const VcaItem& item) {
  if (item.type == VcaType::text) {
    cursor.seek(item.offset);
    return std::string(cursor.bytes(item.size));
  }
  if (const auto number = vca_number(cursor, item)) {
    return std::isfinite(*number) ? fmt::format("{:.10g}", *number) : std::string();
  }
  if (const auto quantity = vca_quantity(cursor, item)) {
    if (!std::isfinite(quantity->value)) return {};
    return fmt::format("{:.10g}{}{}", quantity->value, quantity->unit.empty() ? "" : " ",
                       quantity->unit);
  }
  return {};
}

}  // namespace manoscope::io
