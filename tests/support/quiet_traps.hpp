#pragma once

#include <cfenv>

namespace manoscope::test {

/// Lets NaN be compared while it lives: for tests that hand one in on purpose.
class QuietTraps {
 public:
  QuietTraps() : before_(fedisableexcept(FE_INVALID)) {}
  ~QuietTraps() {
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(before_);
  }
  QuietTraps(const QuietTraps&) = delete;
  QuietTraps& operator=(const QuietTraps&) = delete;

 private:
  int before_;
};

}  // namespace manoscope::test
