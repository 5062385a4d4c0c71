#include "manoscope/core/monitor.hpp"

#include "manoscope/core/error.hpp"

namespace manoscope {

void Monitor::checkpoint() const {
  if (stop_requested && stop_requested()) throw Interrupted();
}

}  // namespace manoscope
