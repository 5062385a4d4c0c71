#pragma once

#include <unistd.h>

namespace manoscope::test_support {

/// Permissions do not bind the superuser: acts as nobody while it lives, where that is possible.
class AsOrdinaryUser {
 public:
  AsOrdinaryUser() : before_(::geteuid()) {
    if (before_ == 0) static_cast<void>(::seteuid(65534));
  }
  AsOrdinaryUser(const AsOrdinaryUser&) = delete;
  AsOrdinaryUser& operator=(const AsOrdinaryUser&) = delete;
  ~AsOrdinaryUser() { static_cast<void>(::seteuid(before_)); }

  /// Whether permissions bind while it lives.
  bool holds() const { return ::geteuid() != 0; }

 private:
  uid_t before_;
};

}  // namespace manoscope::test_support
