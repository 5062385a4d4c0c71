#pragma once

#include <string>
#include <variant>
#include <vector>

#include "manoscope/wall/bulge.hpp"
#include "manoscope/wall/circular_wall.hpp"
#include "manoscope/wall/elastomer_strip.hpp"
#include "manoscope/wall/plate_strip.hpp"
#include "manoscope/wall/square_wall.hpp"
#include "manoscope/wall/wall_law.hpp"

namespace manoscope::wall {

/// Every wall law, in the order of AnyWallLaw.
enum class LawKind {
  long_membrane,
  plate_strip,
  elastomer_strip,
  circular_plate,
  circular_membrane,
  square_plate,
  square_membrane,
};

using AnyWallLaw = std::variant<LongMembrane, PlateStrip, ElastomerStrip, CircularPlate,
                                CircularMembrane, SquarePlate, SquareMembrane>;

/// The enumerator's own name, as tables and files write it.
const char* name(LawKind kind);
/// The law of that name.
/// @throws InputError listing all names if there is none.
LawKind law_kind(const std::string& name);

/// The law of a kind for a wall.
/// @throws InputError where the law does not hold for it.
AnyWallLaw make_wall_law(LawKind kind, const WallSection& section);

/// Width-averaged deflection by any law, and its derivative by pressure (m/Pa).
Length deflection(const AnyWallLaw& law, Pressure pressure);
double deflection_compliance(const AnyWallLaw& law, Pressure pressure);

}  // namespace manoscope::wall
