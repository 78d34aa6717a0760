#pragma once

namespace sprung::fem {

/// Geometric properties of a cross section whose beam bends in the plane of its height.
struct SectionGeometry {
  double area = 0.0;               ///< A [m²]
  double second_moment = 0.0;      ///< I about the centroid's axis perpendicular to the height [m⁴]
  double shear_coefficient = 0.0;  ///< κ in the shear rigidity κGA [-]
  double section_modulus = 0.0;    ///< W = I / e, e from the centroid to the extreme fibre [m³]
};

/// Solid rectangle.
struct Rectangle {
  double width = 0.0;   ///< > 0 [m]
  double height = 0.0;  ///< > 0, in the plane of bending [m]
};

/// Hollow rectangle of uniform wall.
struct Box {
  double width = 0.0;   ///< outer, > 0 [m]
  double height = 0.0;  ///< outer, > 0, in the plane of bending [m]
  double wall = 0.0;    ///< 0 < wall < half of width and of height [m]
};

/// Hollow circle.
struct Tube {
  double outer_diameter = 0.0;  ///< > 0 [m]
  double wall = 0.0;            ///< 0 < wall ≤ outer_diameter / 2, the latter a solid bar [m]
};

/// I section of equal flanges, bent in the plane of its web.
struct ISection {
  double height = 0.0;            ///< over both flanges, > 0 [m]
  double flange_width = 0.0;      ///< > web_thickness [m]
  double flange_thickness = 0.0;  ///< 0 < flange_thickness < height / 2 [m]
  double web_thickness = 0.0;     ///< > 0 [m]
};

/// Area, second moment of area, shear coefficient and section modulus of a section.
///
/// All but the shear coefficient are exact for the dimensions given. The shear coefficient is Cowper's
/// (fem, eqs. 1–4): for the box and the I section the one of thin walls, taken with the dimensions
/// between the walls' middles; it is an approximation where the walls are thick.
///
/// @param poissons_ratio  ν, −1 < ν ≤ 0.5 [-]
/// @throws std::invalid_argument if a dimension is not positive or dimensions contradict each other (the
/// message
///         gives name and value)
/// Source: [Cowper 1966] — checked by tests/fem/section_shapes_test.cpp
SectionGeometry calc_section_geometry(const Rectangle& rectangle, double poissons_ratio);
SectionGeometry calc_section_geometry(const Box& box, double poissons_ratio);
SectionGeometry calc_section_geometry(const Tube& tube, double poissons_ratio);
SectionGeometry calc_section_geometry(const ISection& section, double poissons_ratio);

}  // namespace sprung::fem
