#include "manoscope/report/figures.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/report/gnuplot.hpp"
#include "manoscope/report/html_text.hpp"

namespace manoscope::report {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (auto place = text.find(from); place != std::string::npos;
       place = text.find(from, place + to.size())) {
    text.replace(place, from.size(), to);
  }
}

/// Cairo dates its PDF files; the same figure must give the same bytes.
void remove_date(std::string& pdf) {
  const std::string_view key = "/CreationDate (D:";
  const auto start = pdf.find(key);
  if (start == std::string::npos) return;
  for (auto i = start + key.size(); i < pdf.size() && pdf[i] >= '0' && pdf[i] <= '9'; ++i)
    pdf[i] = '0';
}

}  // namespace

std::vector<Figure> figures(const results::Measurement& measurement) {
  std::vector<Figure> list;
  for (const auto make :
       {&pressure_at_highest_flow, &pressure_at_lowest_flow, &pressure_of_all_runs, &flow_profiles,
        &drop_agreement, &flow_corrections, &pressure_drop, &wall_shear, &static_profiles,
        &profiles_overlaid, &crest_deflection, &channel_place, &levels_left_out, &cross_sections,
        &worst_cross_section}) {
    if (auto figure = make(measurement)) list.push_back(std::move(*figure));
  }
  return list;
}

std::optional<DrawnFigure> draw(const Figure& figure, bool pdf) {
  const auto output = run_gnuplot(
      fmt::format("set terminal svg size {},{} font 'Helvetica,14' background '#ffffff'\n",
                  figure.width, figure.height) +
      figure.script);
  if (!output) return std::nullopt;
  if (!output->succeeded) {
    throw InternalError("gnuplot refused figure " + figure.name + ": " + output->messages);
  }
  DrawnFigure drawn;
  drawn.svg = output->bytes;
  replace_all(drawn.svg, "<title>Gnuplot</title>",
              "<title>" + escape_html(figure.title) + "</title>");
  replace_all(drawn.svg, "font-family=\"Helvetica\"",
              "font-family=\"Helvetica, Arial, sans-serif\"");
  if (pdf) {
    const auto printed = run_gnuplot(
        fmt::format("set terminal pdfcairo size {:.3f}in,{:.3f}in font 'Helvetica,10.5'\n",
                    figure.width / 96.0, figure.height / 96.0) +
        figure.script);
    if (printed && printed->succeeded) {
      drawn.pdf = printed->bytes;
      remove_date(drawn.pdf);
    }
  }
  return drawn;
}

std::string inline_svg(const std::string& svg, const std::string& name) {
  const auto start = svg.find("<svg");
  if (start == std::string::npos) return {};
  std::string element = svg.substr(start);
  for (const std::string_view mark : {"id=\"", "id='", "href='#", "href=\"#", "url(#"}) {
    replace_all(element, mark, std::string(mark) + name + "-");
  }
  element.insert(4, " role=\"img\"");
  return element;
}

}  // namespace manoscope::report
