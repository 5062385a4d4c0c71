#include "manoscope/io/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace manoscope::io {

std::string Place::text() const {
  std::string text = file.string();
  if (line > 0) text += fmt::format(":{}", line);
  if (!key.empty()) text += ": " + key;
  return text;
}

void Faults::add(Place place, std::string found, std::string mend) {
  faults_.push_back({std::move(place), std::move(found), std::move(mend)});
}

void Faults::throw_if_any(const std::filesystem::path& first) const {
  if (faults_.empty()) return;
  std::vector<std::filesystem::path> files{first};
  const auto rank = [&](const Fault& fault) {
    return std::find(files.begin(), files.end(), fault.place.file) - files.begin();
  };
  for (const Fault& fault : faults_) {
    if (rank(fault) == static_cast<std::ptrdiff_t>(files.size())) files.push_back(fault.place.file);
  }
  std::vector<Fault> sorted = faults_;
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Fault& a, const Fault& b) {
    return std::pair(rank(a), a.place.line) < std::pair(rank(b), b.place.line);
  });
  std::vector<InputError> errors;
  errors.reserve(sorted.size());
  for (Fault& fault : sorted) {
    errors.emplace_back(fault.place.text(), std::move(fault.found), std::move(fault.mend));
  }
  throw InputErrors(std::move(errors));
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string shown(text.substr(0, kLongest));
  if (text.size() > kLongest) {
    // No half of a UTF-8 character.
    while (!shown.empty() && (static_cast<unsigned char>(shown.back()) & 0xC0) == 0x80) {
      shown.pop_back();
    }
    if (!shown.empty() && static_cast<unsigned char>(shown.back()) >= 0x80) shown.pop_back();
    shown += "...";
  }
  for (char& letter : shown) {
    if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7F) letter = '?';
  }
  return '"' + shown + '"';
}

}  // namespace manoscope::io
