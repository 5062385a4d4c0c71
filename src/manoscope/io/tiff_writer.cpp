// Maps as TIFF of 32-bit floats, with the description that ImageJ and Fiji read.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/tiff_handle.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {

void write_tiff_map(const std::filesystem::path& path, const HeightMap& map,
                    const std::string& title) {
  const CameraGrid& grid = map.grid();
  // The resolution tags hold 32-bit floats; the description keeps every digit.
  const std::string description =
      fmt::format("ImageJ=1.53\nunit=um\nvunit=m\npitch_x_m={}\npitch_y_m={}\ntitle={}\n",
                  grid.pitch_x.si(), grid.pitch_y.si(), one_line(title));
  std::string bytes;
  {
    constexpr double kLargestClassic = 4e9;
    const bool big = 4.0 * static_cast<double>(map.height().size()) > kLargestClassic;
    const TiffHandle handle(&bytes, big, path.string());
    TIFF* tiff = handle.get();
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(grid.nx));
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(grid.ny));
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 1.0 / grid.pitch_x.in(um));
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 1.0 / grid.pitch_y.in(um));
    TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, description.c_str());
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
    std::vector<float> row(static_cast<std::size_t>(grid.nx));
    bool written = true;
    for (Index iy = 0; iy < grid.ny; ++iy) {
      for (Index ix = 0; ix < grid.nx; ++ix) {
        const double height = map.height()(iy, ix);
        if (std::abs(height) > std::numeric_limits<float>::max()) {
          throw InputError(path.string(),
                           fmt::format("a height of {:.3g} m has no 32-bit float", height),
                           "Write the map as .nc");
        }
        row[static_cast<std::size_t>(ix)] = map.flags()(iy, ix) == 0
                                                ? static_cast<float>(height)
                                                : std::numeric_limits<float>::quiet_NaN();
      }
      written =
          written && TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(iy), 0) == 1;
    }
    written = written && TIFFFlush(tiff) == 1;
    if (!written) {
      throw InputError(path.string(), "cannot be written as TIFF: " + handle.complaint(),
                       "Write the map as .nc");
    }
  }
  write_file_atomically(path, bytes);
}

}  // namespace manoscope::io
