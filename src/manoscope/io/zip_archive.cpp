#include "manoscope/io/zip_archive.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <tuple>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/open_file.hpp"

namespace manoscope::io {
namespace {

/// Deflate cannot pack better than 1032 to 1.
constexpr std::uint64_t kBestPacking = 1032;

constexpr const char* kCopyAgain = "The file is incomplete or damaged; copy or export it again";

/// Small letters, '/' between folders, no "./" or "/" in front.
std::string plain_name(std::string_view name) {
  std::string plain = lower_case(name);
  std::replace(plain.begin(), plain.end(), '\\', '/');
  for (;;) {
    if (plain.starts_with("./")) {
      plain.erase(0, 2);
    } else if (plain.starts_with('/')) {
      plain.erase(0, 1);
    } else {
      return plain;
    }
  }
}

/// libzip makes room for every file that the end of the archive announces, before it looks for one.
void check_announced_files(const OpenFile& file, const std::string& where) {
  constexpr std::string_view kEnd = "PK\x05\x06", kEnd64 = "PK\x06\x06";
  constexpr std::uint64_t kMostFiles = 1000, kLongestEnd = 66000;
  std::string tail(std::min(file.size(), kLongestEnd), '\0');
  file.read(file.size() - tail.size(), tail.data(), tail.size());
  for (const auto& [mark, place, width] :
       {std::tuple{kEnd, std::size_t{10}, 2U}, std::tuple{kEnd64, std::size_t{32}, 8U}}) {
    for (auto at = tail.find(mark); at != std::string_view::npos; at = tail.find(mark, at + 1)) {
      if (tail.size() - at < place + width) break;
      std::uint64_t n_files = 0;
      for (unsigned i = width; i > 0; --i) {
        n_files = n_files << 8 | static_cast<unsigned char>(tail[at + place + i - 1]);
      }
      const bool see_other_end =
          n_files == 0xffff && width == 2 && tail.find(kEnd64) != std::string_view::npos;
      if (n_files <= kMostFiles || see_other_end) continue;
      throw InputError(
          where, fmt::format("its archive announces {} files, in {} bytes", n_files, file.size()),
          fmt::format("Archives of up to {} files are read; export the map again", kMostFiles));
    }
  }
}

}  // namespace

struct ZipArchive::Handle {
  zip_t* archive = nullptr;
  ~Handle() {
    if (archive != nullptr) zip_discard(archive);
  }
};

ZipArchive::ZipArchive(const std::filesystem::path& path, std::uint64_t offset)
    : where_(path.string()), handle_(std::make_unique<Handle>()) {
  {
    const OpenFile file(path);
    MANO_ASSERT(offset <= file.size());
    n_bytes_ = file.size() - offset;
    check_announced_files(file, where_);
  }
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source =
      zip_source_file_create(path.c_str(), offset, static_cast<zip_int64_t>(n_bytes_), &error);
  if (source != nullptr) {
    handle_->archive = zip_open_from_source(source, ZIP_RDONLY, &error);
    if (handle_->archive == nullptr) zip_source_free(source);
  }
  const std::string reason = zip_error_strerror(&error);
  zip_error_fini(&error);
  if (handle_->archive == nullptr) {
    throw InputError(where_, fmt::format("is not a whole zip archive: {}", excerpt(reason)),
                     kCopyAgain);
  }
  const zip_int64_t n_entries = zip_get_num_entries(handle_->archive, 0);
  for (zip_int64_t i = 0; i < n_entries; ++i) {
    const char* name = zip_get_name(handle_->archive, static_cast<zip_uint64_t>(i), 0);
    names_.push_back(name == nullptr ? std::string() : plain_name(name));
  }
}

ZipArchive::~ZipArchive() = default;

bool ZipArchive::enter_folder_of(std::string_view name) {
  const std::string wanted = plain_name(name), below = "/" + wanted;
  const std::string* found = nullptr;
  for (const std::string& candidate : names_) {
    if (candidate == wanted) {
      folder_.clear();
      return true;
    }
    // The one nearest to the top.
    if (candidate.ends_with(below) && (found == nullptr || candidate.size() < found->size())) {
      found = &candidate;
    }
  }
  if (found == nullptr) return false;
  folder_ = found->substr(0, found->size() - wanted.size());
  return true;
}

std::optional<ZipArchive::Entry> ZipArchive::find(std::string_view name) const {
  const std::string wanted = folder_ + plain_name(name);
  const auto found = std::find(names_.begin(), names_.end(), wanted);
  if (found == names_.end()) return std::nullopt;
  Entry entry;
  entry.index = static_cast<std::uint64_t>(found - names_.begin());
  zip_stat_t status;
  zip_stat_init(&status);
  if (zip_stat_index(handle_->archive, entry.index, 0, &status) != 0 ||
      (status.valid & ZIP_STAT_SIZE) == 0) {
    throw InputError(place(entry), "its size is not given", kCopyAgain);
  }
  entry.size = status.size;
  return entry;
}

std::string ZipArchive::place(const Entry& entry) const {
  return fmt::format("{}: {}", where_, excerpt(names_[entry.index]));
}

std::string ZipArchive::read(const Entry& entry, std::uint64_t largest) const {
  if (entry.size > largest) {
    throw InputError(
        place(entry),
        fmt::format("unpacks to {} bytes, where at most {} make sense", entry.size, largest),
        "The archive is damaged or not what it says; export the map again");
  }
  zip_stat_t status;
  zip_stat_init(&status);
  const zip_uint64_t needed =
      ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
  if (zip_stat_index(handle_->archive, entry.index, 0, &status) != 0 ||
      (status.valid & needed) != needed) {
    throw InputError(place(entry), "is not described in the archive", kCopyAgain);
  }
  if (status.encryption_method != ZIP_EM_NONE) {
    throw InputError(place(entry), "is encrypted", "Export the map without a password");
  }
  if (status.comp_method != ZIP_CM_STORE && status.comp_method != ZIP_CM_DEFLATE) {
    throw InputError(place(entry), fmt::format("is packed by method {}", status.comp_method),
                     "Pack it again by \"deflate\" or without packing");
  }
  const bool stored = status.comp_method == ZIP_CM_STORE;
  if (status.comp_size > n_bytes_ ||
      entry.size > (stored ? status.comp_size : kBestPacking * status.comp_size)) {
    throw InputError(place(entry),
                     fmt::format("is said to unpack to {} bytes from {}, which cannot be",
                                 entry.size, status.comp_size),
                     kCopyAgain);
  }
  zip_file_t* file = zip_fopen_index(handle_->archive, entry.index, 0);
  if (file == nullptr) {
    throw InputError(place(entry),
                     fmt::format("cannot be unpacked: {}", zip_strerror(handle_->archive)),
                     kCopyAgain);
  }
  // Room grows with what really unpacks: a declared size alone fills no memory.
  const std::uint64_t first_room = std::max(std::uint64_t{1} << 16, 2 * status.comp_size);
  std::string bytes;
  std::uint64_t n_read = 0;
  zip_int64_t step = 1;
  while (n_read < entry.size && step > 0) {
    if (n_read == bytes.size()) {
      bytes.resize(std::min(entry.size, std::max(first_room, 2 * n_read)));
    }
    step = zip_fread(file, bytes.data() + n_read, bytes.size() - n_read);
    if (step > 0) n_read += static_cast<std::uint64_t>(step);
  }
  // The CRC is compared when the end is met.
  char beyond = 0;
  if (entry.size == 0) step = 0;
  if (step >= 0 && n_read == entry.size) step = zip_fread(file, &beyond, 1);
  const std::string reason = step < 0 ? zip_file_strerror(file) : "its length is another";
  const bool whole = step == 0 && n_read == entry.size;
  zip_fclose(file);
  if (!whole) {
    throw InputError(place(entry), fmt::format("cannot be unpacked: {}", excerpt(reason)),
                     kCopyAgain);
  }
  return bytes;
}

bool looks_like_zip(std::string_view head) { return head.starts_with("PK\x03\x04"); }

bool zip_head_names(std::string_view head, std::string_view name) {
  return looks_like_zip(head) && lower_case(head).find(lower_case(name)) != std::string::npos;
}

}  // namespace manoscope::io
