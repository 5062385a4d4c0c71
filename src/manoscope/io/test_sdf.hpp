#pragma once

// For the tests of this folder only: surface data files of 3 x 2 points, 1.5 um by 2 um, in nm.

#include <string>

#include "manoscope/io/test_bytes.hpp"

namespace manoscope::io::testing {

inline std::string text_sdf(const std::string& version, const std::string& heights) {
  return version +
         "\r\nManufacID = Maker\r\nCreateDate = 040120100853\r\nModDate = 050320101353\r\n"
         "NumPoints = 3\r\nNumProfiles = 2\r\nXscale = 1.5E-6\r\nYscale = 2.0E-6\r\nZscale = "
         "1e-9\r\n"
         "Zresolution = -1\r\nCompression = 0\r\nDataType = 7\r\nCheckType = 0\r\n*\r\n" +
         heights;
}

inline std::string binary_sdf(const std::string& version, int type, const std::string& heights,
                              int compression = 0) {
  const int n_bytes = version == "bISO-2.0" ? 4 : 2;
  return version + "Maker     " + "040120100853" + "050320101353" + little(3, n_bytes) +
         little(2, n_bytes) + little(1.5e-6) + little(2e-6) + little(1e-9) + little(-1.0) +
         static_cast<char>(compression) + static_cast<char>(type) + '\0' + heights;
}

}  // namespace manoscope::io::testing
