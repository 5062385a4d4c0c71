#pragma once

// For the tests of this folder only: a main.xml as ISO 25178-72 describes it.

#include <string>

namespace manoscope::io::testing {

struct X3pParts {
  std::string feature = "SUR";
  char xy_kind = 'I';
  std::string xy_increment = "1.5e-6";  ///< of x; y has 2e-6
  char z_kind = 'A', z_type = 'D';
  std::string z_increment = "1", z_offset = "0";
  long nx = 3, ny = 2, n_layers = 1;
  std::string link = "<PointDataLink>bindata/data.bin</PointDataLink>";
  std::string points;  ///< instead of matrix and link, if not empty
};

inline std::string x3p_main(const X3pParts& parts) {
  const auto axis = [](const char* name, char kind, char type, const std::string& increment,
                       const std::string& offset) {
    return std::string("<") + name + "><AxisType>" + kind + "</AxisType><DataType>" + type +
           "</DataType><Increment>" + increment + "</Increment><Offset>" + offset + "</Offset></" +
           name + ">";
  };
  const std::string points =
      !parts.points.empty()
          ? parts.points
          : "<MatrixDimension><SizeX>" + std::to_string(parts.nx) + "</SizeX><SizeY>" +
                std::to_string(parts.ny) + "</SizeY><SizeZ>" + std::to_string(parts.n_layers) +
                "</SizeZ></MatrixDimension><DataLink>" + parts.link + "</DataLink>";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<p:ISO5436_2 "
         "xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\">\n<Record1><Revision>ISO5436 - "
         "2000</Revision><FeatureType>" +
         parts.feature + "</FeatureType>\n<Axes>" +
         axis("CX", parts.xy_kind, 'D', parts.xy_increment, "0") +
         axis("CY", parts.xy_kind, 'D', "2e-6", "0") +
         axis("CZ", parts.z_kind, parts.z_type, parts.z_increment, parts.z_offset) +
         "</Axes></Record1>\n<Record2><Date>2024-05-06</Date><Instrument><Manufacturer>Maker"
         "</Manufacturer><Model>M 1</Model></Instrument></Record2>\n<Record3>" +
         points + "</Record3>\n<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4>\n" +
         "</p:ISO5436_2>\n";
}

}  // namespace manoscope::io::testing
