#include "manoscope/wall/wall_laws.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstddef>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

constexpr std::array<const char*, 7> kNames = {
    "long_membrane",     "plate_strip",  "elastomer_strip", "circular_plate",
    "circular_membrane", "square_plate", "square_membrane"};
static_assert(kNames.size() == std::variant_size_v<AnyWallLaw>);

static_assert(WallLaw<LongMembrane> && WallLaw<PlateStrip> && WallLaw<ElastomerStrip>);
static_assert(WallLaw<CircularPlate> && WallLaw<CircularMembrane>);
static_assert(WallLaw<SquarePlate> && WallLaw<SquareMembrane>);

template <class Law>
double compliance_of(const Law& law, Pressure pressure) {
  // The mean of all laws but the plate strip's is a constant share of the crest.
  return law.mean_over_crest(Length{}) * law.crest_compliance(law.crest(pressure));
}

double compliance_of(const PlateStrip& law, Pressure pressure) {
  return law.deflection_compliance(pressure);
}

}  // namespace

const char* name(LawKind kind) { return kNames.at(static_cast<std::size_t>(kind)); }

LawKind law_kind(const std::string& name) {
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    if (name == kNames[k]) return static_cast<LawKind>(k);
  }
  throw InputError("wall law", fmt::format("there is no law \"{}\"", name),
                   fmt::format("Choose one of {}", fmt::join(kNames, ", ")));
}

AnyWallLaw make_wall_law(LawKind kind, const WallSection& section) {
  switch (kind) {
    case LawKind::long_membrane:
      return LongMembrane(section);
    case LawKind::plate_strip:
      return PlateStrip(section);
    case LawKind::elastomer_strip:
      return ElastomerStrip(section);
    case LawKind::circular_plate:
      return CircularPlate(section);
    case LawKind::circular_membrane:
      return CircularMembrane(section);
    case LawKind::square_plate:
      return SquarePlate(section);
    case LawKind::square_membrane:
      return SquareMembrane(section);
  }
  throw InternalError("unknown wall law");
}

Length deflection(const AnyWallLaw& law, Pressure pressure) {
  return std::visit([&](const auto& one) { return one.deflection(pressure); }, law);
}

double deflection_compliance(const AnyWallLaw& law, Pressure pressure) {
  return std::visit([&](const auto& one) { return compliance_of(one, pressure); }, law);
}

}  // namespace manoscope::wall
