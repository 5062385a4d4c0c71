#pragma once

#include <functional>
#include <vector>

namespace manoscope::navier_stokes {

/// Developed velocity of one half of a duct, up to a factor: laplace u = -1, u = 0 on the walls.
///
/// Finite elements of degree `order` on the cells of the section, mapped to the roof by polynomials
/// of that degree, so that the answer is continuous and can stand on the face of a mesh with the
/// same edges. Source of the problem: e.g. H. Bruus, Theoretical Microfluidics (2008), ch. 3.
///
/// @param z_edges  from the plane of symmetry, z = 0, to the side wall; ascending.
/// @param t_edges  y/h from 0 to 1; ascending.
/// @param gap      h(z) > 0.
/// @param order    polynomial degree, >= 1.
/// @return u(t, z), in the square of the unit of length.
std::function<double(double t, double z)> duct_profile(const std::vector<double>& z_edges,
                                                       const std::vector<double>& t_edges,
                                                       const std::function<double(double z)>& gap,
                                                       int order);

}  // namespace manoscope::navier_stokes
