#include "manoscope/flow/section_family.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

constexpr const char* kWhere = "table of sections";

/// Chebyshev-Lobatto nodes of [from, to], ascending.
Array1 lobatto(double from, double to, Index n) {
  Array1 nodes(n);
  for (Index k = 0; k < n; ++k) {
    const double s =
        std::sin(0.5 * std::numbers::pi * static_cast<double>(2 * k - (n - 1)) / double(n - 1));
    nodes(k) = 0.5 * (from + to) + 0.5 * (to - from) * s;
  }
  return nodes;
}

/// Barycentric interpolation through every `stride`-th of the Lobatto nodes.
template <class Table>
auto interpolate(const Array1& nodes, const Table& table, Index stride, double at) {
  Eigen::Array<double, 1, Table::ColsAtCompileTime> top = table.row(0) * 0.0;
  double bottom = 0.0;
  const Index last = nodes.size() - 1;
  for (Index k = 0; k <= last; k += stride) {
    const double distance = at - nodes(k);
    if (distance == 0.0) return decltype(top)(table.row(k));
    const double sign = (k / stride) % 2 == 0 ? 1.0 : -1.0;
    const double weight = sign * (k == 0 || k == last ? 0.5 : 1.0) / distance;
    top += weight * table.row(k);
    bottom += weight;
  }
  return decltype(top)(top / bottom);
}

}  // namespace

void SectionFamilyOptions::validate() const {
  if (!(tolerance > 1e-12 && tolerance < 0.1)) {
    throw InputError(kWhere, fmt::format("tolerance is {:g}", tolerance),
                     "Give a tolerance from 1e-12 to 0.1");
  }
  if (most_nodes < 5 || most_nodes > 1000) {
    throw InputError(kWhere, fmt::format("most_nodes is {}", most_nodes), "Give 5 to 1000");
  }
}

SectionFamily::SectionFamily(const Channel& channel, WallShape shape, Length least, Length greatest,
                             const SectionFamilyOptions& options)
    : channel_(channel), shape_(std::move(shape)), least_(least.si()), greatest_(greatest.si()) {
  channel_.validate(kWhere);
  options.validate();
  if (!(least_ < greatest_) || !std::isfinite(least_) || !std::isfinite(greatest_)) {
    throw InputError(
        kWhere, fmt::format("deflections from {:.4g} to {:.4g} um", least_ * 1e6, greatest_ * 1e6),
        "Give a range of deflections, the smaller first");
  }
  double least_gap = channel_.height.si();
  for (const double zeta : {least_, greatest_}) {
    for (int k = 0; k <= 40; ++k) {
      least_gap = std::min(least_gap, channel_.height.si() + zeta * shape_.value(k / 40.0));
    }
  }
  // A gap that closes is refused by solve() below.
  degrees_.degree_across = degree_for_gap(channel_.width.si() / std::max(least_gap, 1e-12));
  for (Index n = 5;; n = 2 * n - 1) {
    const Array1 finer = lobatto(least_, greatest_, n);
    Table table(n, kQuantities);
    for (Index k = 0; k < n; ++k) {  // every other node is one of the nodes before
      const bool known = nodes_.size() > 0 && k % 2 == 0;
      table.row(k) = known ? Row(table_.row(k / 2)) : solve(finer(k));
    }
    nodes_ = finer;
    table_ = table;
    error_ = 0.0;
    for (Index k = 1; k < n; k += 2) {
      const Row from_rest = interpolate(nodes_, table_, 2, nodes_(k));
      error_ = std::max(error_, (from_rest / table_.row(k) - 1.0).abs().maxCoeff());
    }
    if (error_ <= options.tolerance || 2 * n - 1 > options.most_nodes) return;
  }
}

SectionFamily SectionFamily::of(const Channel& channel, WallShape shape, const Array1& zeta,
                                const SectionFamilyOptions& options) {
  if (zeta.size() == 0 || !zeta.isFinite().all()) {
    throw InputError(kWhere, "no deflections, or one that is not finite",
                     "Give the deflection of every station");
  }
  // Room of a tenth of the range, at least a thousandth of the height, but never a closed gap.
  const double low = zeta.minCoeff(), high = zeta.maxCoeff();
  const double room = std::max(0.1 * (high - low), 1e-3 * channel.height.si());
  double from = low - room;
  for (const double s : {0.0, 1.0}) {
    const double g = shape.value(s);
    if (g > 0.0 && channel.height.si() + from * g <= 0.0) from = low;
  }
  return SectionFamily(channel, std::move(shape), Length::from_si(from),
                       Length::from_si(high + room), options);
}

SectionFamily::Row SectionFamily::solve(double mean_deflection) const {
  const CrossSection section = solve_cross_section(
      bulged_roof(channel_.width, channel_.height, Length::from_si(mean_deflection), shape_),
      degrees_);
  const double gap = section.mean_gap;
  Row row;
  row << section.flow_factor(), section.momentum_factor, section.energy_factor,
      section.floor_shear / gap, section.roof_shear / gap, section.side_shear / gap,
      section.roof_length / channel_.width.si();
  return row;
}

CrossSection SectionFamily::at(Length mean_deflection) const {
  const double zeta = mean_deflection.si();
  if (!(zeta >= least_ && zeta <= greatest_)) {
    throw InputError(kWhere,
                     fmt::format("deflection {:.4g} um, but the table runs from {:.4g} to {:.4g}",
                                 zeta * 1e6, least_ * 1e6, greatest_ * 1e6),
                     "Make the table for the whole range of deflections");
  }
  const Row row = interpolate(nodes_, table_, 1, zeta);
  const double width = channel_.width.si();
  CrossSection section;
  section.mean_gap = channel_.height.si() + zeta;
  section.area = width * section.mean_gap;
  section.conductance = row(0) * section.area * section.mean_gap * section.mean_gap / 12.0;
  section.momentum_factor = row(1);
  section.energy_factor = row(2);
  section.floor_shear = row(3) * section.mean_gap;
  section.roof_shear = row(4) * section.mean_gap;
  section.side_shear = row(5) * section.mean_gap;
  section.roof_length = row(6) * width;
  section.side_height = 2.0 * (channel_.height.si() + zeta * shape_.value(1.0));
  section.perimeter = width + section.roof_length + section.side_height;
  return section;
}

SectionsAlong sections_along(const SectionFamily& family, const Array1& x, const Array1& zeta) {
  std::vector<CrossSection> sections;
  sections.reserve(static_cast<std::size_t>(zeta.size()));
  for (const double deflection : zeta) sections.push_back(family.at(Length::from_si(deflection)));
  return sections_along(x, sections);
}

SectionsAlong sections_along(const Array1& x, const std::vector<CrossSection>& sections) {
  const Index n = x.size();
  if (n < 2 || static_cast<Index>(sections.size()) != n) {
    throw InputError("sections along the channel",
                     fmt::format("{} sections at {} stations", sections.size(), n),
                     "Give one a station, at two stations or more");
  }
  SectionsAlong along{x,         Array1(n), Array1(n), Array1(n), Array1(n),
                      Array1(n), Array1(n), Array1(n), Array1(n)};
  for (Index i = 0; i < n; ++i) {
    if (!std::isfinite(x(i)) || (i > 0 && x(i) <= x(i - 1))) {
      throw InputError("sections along the channel",
                       fmt::format("station {} at x = {:.6g} mm does not follow the one before it",
                                   i, x(i) * 1e3),
                       "Sort the stations along the flow and drop duplicates");
    }
    const CrossSection& section = sections[static_cast<std::size_t>(i)];
    along.area(i) = section.area;
    along.mean_gap(i) = section.mean_gap;
    along.conductance(i) = section.conductance;
    along.momentum_factor(i) = section.momentum_factor;
    along.energy_factor(i) = section.energy_factor;
    along.hydraulic_diameter(i) = section.hydraulic_diameter();
    along.roof_shear(i) = section.roof_shear;
    along.floor_shear(i) = section.floor_shear;
  }
  return along;
}

}  // namespace manoscope::flow
