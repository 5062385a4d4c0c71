#include "manoscope/io/tiff_handle.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/open_file.hpp"

namespace manoscope::io {

struct TiffHandle::State {
  TIFF* tiff = nullptr;
  std::unique_ptr<const OpenFile> in;
  std::string* out = nullptr;
  std::uint64_t offset = 0;
  std::string complaint;

  std::uint64_t size() const { return out != nullptr ? out->size() : in->size(); }

  static int keep_complaint(TIFF* /*tiff*/, void* user, const char* /*module*/, const char* format,
                            va_list arguments) {
    auto* state = static_cast<State*>(user);
    if (!state->complaint.empty()) return 1;
    std::array<char, 200> text{};
    std::vsnprintf(text.data(), text.size(), format, arguments);
    state->complaint = text.data();
    return 1;
  }
  static int pass_over(TIFF* /*tiff*/, void* /*user*/, const char* /*module*/,
                       const char* /*format*/, va_list /*arguments*/) {
    return 1;
  }

  static tmsize_t read(thandle_t handle, void* to, tmsize_t n_bytes) {
    auto* state = static_cast<State*>(handle);
    if (state->offset >= state->size() || n_bytes <= 0) return 0;
    const std::uint64_t n =
        std::min(static_cast<std::uint64_t>(n_bytes), state->size() - state->offset);
    if (state->out != nullptr) {
      std::memcpy(to, state->out->data() + state->offset, n);
    } else {
      // No exception passes through libtiff.
      try {
        state->in->read(state->offset, static_cast<char*>(to), n);
      } catch (const InputError& error) {
        if (state->complaint.empty()) state->complaint = error.found();
        return -1;
      }
    }
    state->offset += n;
    return static_cast<tmsize_t>(n);
  }
  static tmsize_t write(thandle_t handle, void* from, tmsize_t n_bytes) {
    auto* state = static_cast<State*>(handle);
    if (state->out == nullptr || n_bytes <= 0) return 0;
    const auto n = static_cast<std::size_t>(n_bytes);
    if (state->out->size() < state->offset + n) state->out->resize(state->offset + n);
    std::memcpy(state->out->data() + state->offset, from, n);
    state->offset += n;
    return n_bytes;
  }
  static toff_t seek(thandle_t handle, toff_t offset, int whence) {
    auto* state = static_cast<State*>(handle);
    const std::uint64_t base = whence == SEEK_SET   ? 0
                               : whence == SEEK_CUR ? state->offset
                                                    : state->size();
    state->offset = base + offset;
    return state->offset;
  }
  static int close(thandle_t /*handle*/) { return 0; }
  static toff_t size_of(thandle_t handle) { return static_cast<State*>(handle)->size(); }

  void open(const char* mode, std::uint64_t most_memory) {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options, keep_complaint, this);
    TIFFOpenOptionsSetWarningHandlerExtR(options, pass_over, this);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, static_cast<tmsize_t>(most_memory));
    tiff = TIFFClientOpenExt("map", mode, this, read, write, seek, close, size_of, nullptr, nullptr,
                             options);
    TIFFOpenOptionsFree(options);
  }
};

TiffHandle::TiffHandle(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
  state_->in = std::make_unique<const OpenFile>(path);
  // Tables of a packer take 128 KiB; a strip or tile is no larger than the file.
  constexpr std::uint64_t kSmall = std::uint64_t{256} << 10;
  state_->open("rm", std::max<std::uint64_t>(kSmall, 2 * state_->size()));
  if (state_->tiff == nullptr) {
    throw InputError(path.string(), "is not a whole TIFF file: " + excerpt(state_->complaint),
                     "The file is incomplete or damaged; copy or export it again");
  }
}

TiffHandle::TiffHandle(std::string* bytes, bool big, const std::string& where)
    : state_(std::make_unique<State>()) {
  state_->out = bytes;
  state_->open(big ? "w8" : "wl", std::numeric_limits<std::int32_t>::max());
  if (state_->tiff == nullptr) {
    throw InputError(where, "cannot be written as TIFF: " + excerpt(state_->complaint),
                     "Write the map as .nc");
  }
}

TiffHandle::~TiffHandle() {
  if (state_->tiff != nullptr) TIFFClose(state_->tiff);
}

TIFF* TiffHandle::get() const { return state_->tiff; }

std::string TiffHandle::complaint() const {
  std::string text;
  std::swap(text, state_->complaint);
  return excerpt(text);
}

}  // namespace manoscope::io
