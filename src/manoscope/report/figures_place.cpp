#include <fmt/format.h>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/figures.hpp"
#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {

std::optional<Figure> channel_place(const results::Measurement& m) {
  const Index n_x = m.response_x.size(), n_z = m.response_z.size();
  if (n_x < 2 || n_z < 2) return std::nullopt;
  const ReportUnits units = report_units(m);
  const DisplayUnit height = length_unit(largest_magnitude(m.wall_response));
  const Array1 x = m.response_x / units.x.si, z = m.response_z / units.x.si;
  PlotScript script;
  script.set(common_settings()).set("unset key").set(viridis_palette());
  script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  script.set(fmt::format("set ylabel '{{/:Italic z}} ({})'", units.x.name));
  script.set(fmt::format("set cblabel 'rise ({})'", height.name));
  const double half_x = 0.5 * (x[1] - x[0]), half_z = 0.5 * (z[1] - z[0]);
  script.set(fmt::format("set xrange [{}:{}]", plain(x[0] - half_x), plain(x[n_x - 1] + half_x)));
  script.set(fmt::format("set yrange [{}:{}]", plain(z[0] - half_z), plain(z[n_z - 1] + half_z)));
  const double length = m.channel_length / units.x.si, half = 0.5 * m.channel_width / units.x.si;
  script.set(fmt::format(
      "set object 1 rectangle from 0,{} to {},{} front fillstyle empty border rgb '{}' lw 1.6",
      plain(-half), plain(length), plain(half), kRed));
  script.set(
      fmt::format("set arrow 1 from {},0 to {},0 front lw 2 lc rgb '#ffffff' size screen "
                  "0.015,20 filled",
                  plain(0.44 * length), plain(0.56 * length)));
  script.draw(script.add_grid(x, z, m.wall_response / height.si), "using 1:2:3 with image");
  script.plot();
  return Figure{"channel_place",
                "Where the channel lies",
                "Rise of the wall from the lowest to the highest calibration pressure, in the "
                "channel's frame, with the rectangle that was taken as the channel and the "
                "direction of the flow. The wall must begin to move on the rectangle; outside it "
                "lies the rigid rim that deflections are counted from. x and z are drawn to "
                "different scales.",
                900,
                360,
                script.text()};
}

}  // namespace manoscope::report
