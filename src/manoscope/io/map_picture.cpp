#include "manoscope/io/map_picture.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"

namespace manoscope::io {
namespace {

constexpr Rgb kGrey{128, 128, 128};
constexpr int kShortest = 8;

/// Mean of the good values of a block; NaN if there is none.
double block_mean(const Array2& values, Index row, Index n_rows, Index column, Index n_columns) {
  double sum = 0.0;
  Index n = 0;
  for (Index iy = row; iy < row + n_rows; ++iy) {
    for (Index ix = column; ix < column + n_columns; ++ix) {
      const double value = values(iy, ix);
      if (!std::isfinite(value)) continue;
      sum += value;
      ++n;
    }
  }
  return n == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(n);
}

double percentile(std::vector<double>& sorted, double part) {
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::round(part * last))];
}

}  // namespace

Array2 picture_means(const CameraGrid& grid, const Array2& values, int longest) {
  MANO_ASSERT(values.size() > 0 && longest >= kShortest);
  const bool scaled = grid.pitch_x > Length{} && grid.pitch_y > Length{};
  const double wide = static_cast<double>(values.cols()) * (scaled ? grid.pitch_x.si() : 1.0);
  const double high = static_cast<double>(values.rows()) * (scaled ? grid.pitch_y.si() : 1.0);
  const double unit = static_cast<double>(longest) / std::max(wide, high);
  const auto n_columns_shown = std::max<Index>(kShortest, std::lround(wide * unit));
  const auto n_rows_shown = std::max<Index>(kShortest, std::lround(high * unit));

  const auto block = [](Index i, Index n, Index n_pixels) {
    const Index begin = i * n_pixels / n;
    return std::pair{begin, std::max<Index>(1, (i + 1) * n_pixels / n - begin)};
  };
  Array2 means(n_rows_shown, n_columns_shown);
  for (Index iy = 0; iy < n_rows_shown; ++iy) {
    const auto [row, n_rows] = block(iy, n_rows_shown, values.rows());
    for (Index ix = 0; ix < n_columns_shown; ++ix) {
      const auto [column, n_columns] = block(ix, n_columns_shown, values.cols());
      means(iy, ix) = block_mean(values, row, n_rows, column, n_columns);
    }
  }
  return means;
}

std::pair<double, double> colour_ends(const Array2& means) {
  std::vector<double> sorted;
  std::copy_if(means.data(), means.data() + means.size(), std::back_inserter(sorted),
               [](double mean) { return std::isfinite(mean); });
  if (sorted.empty()) return {0.0, 0.0};
  std::sort(sorted.begin(), sorted.end());
  return {percentile(sorted, 0.005), percentile(sorted, 0.995)};
}

MapPicture picture_of(const CameraGrid& grid, const Array2& values, int longest) {
  const Array2 means = picture_means(grid, values, longest);
  MapPicture picture;
  picture.width = static_cast<int>(means.cols());
  picture.height = static_cast<int>(means.rows());
  const auto [low, end] = colour_ends(means);
  const double range = end - low;
  for (const double mean : means.reshaped<Eigen::RowMajor>()) {
    const bool good = std::isfinite(mean);
    picture.pixels.push_back(good ? viridis(range > 0.0 ? (mean - low) / range : 0.5) : kGrey);
  }
  return picture;
}

void write_png(const std::filesystem::path& path, const MapPicture& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = bytes.size();
  const int done =
      png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.pixels.data(), 0, nullptr);
  if (done == 0) {
    throw InputError(path.string(), fmt::format("cannot be made: {}", image.message),
                     "Leave out --preview");
  }
  bytes.resize(size);
  write_file_atomically(path, bytes);
}

std::string terminal_text(const MapPicture& picture) {
  std::string text;
  const auto at = [&](int iy, int ix) {
    return picture.pixels[static_cast<std::size_t>(iy) * static_cast<std::size_t>(picture.width) +
                          static_cast<std::size_t>(ix)];
  };
  for (int iy = 0; iy < picture.height; iy += 2) {
    for (int ix = 0; ix < picture.width; ++ix) {
      const Rgb upper = at(iy, ix);
      text += fmt::format("\x1b[38;2;{};{};{}m", upper[0], upper[1], upper[2]);
      if (iy + 1 < picture.height) {
        const Rgb lower = at(iy + 1, ix);
        text += fmt::format("\x1b[48;2;{};{};{}m", lower[0], lower[1], lower[2]);
      }
      text += "\xE2\x96\x80";  // upper half block
    }
    text += "\x1b[0m\n";
  }
  return text;
}

}  // namespace manoscope::io
