#pragma once

#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "manoscope/serve/message.hpp"
#include "manoscope/serve/scan.hpp"

namespace manoscope::serve {

/// What the served folder holds. Safe to call from several threads.
class StateApi {
 public:
  explicit StateApi(const Folder& folder) : folder_(&folder) {}

  Reply state(const nlohmann::json& job);
  Reply list(const Address& address) const;
  /// The files that changed since the last call; none at the first.
  std::vector<std::string> changes();

 private:
  struct Named {
    Scan::File file;
    std::string name;
  };
  std::string name_of(const std::string& file, const Scan::File& status);

  const Folder* folder_;
  std::mutex mutex_;
  std::map<std::string, Named> names_;  ///< of experiments, as last read
  Scan last_;
  bool scanned_ = false;
};

}  // namespace manoscope::serve
