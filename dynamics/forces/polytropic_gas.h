#pragma once

namespace sprung::dynamics {

/// A gas whose pressure follows its density, p = p_a (ρ/ρ_a)^n, and never its temperature. The density is
/// given as x = ρ/ρ_a, relative to that at ambient pressure p_a.                            (forces, eq. 24)
class PolytropicGas {
 public:
  /// Air that has `temperature` [K] at the pressure `pressure`.
  /// @param exponent          n ≥ 1; 1: isothermal
  /// @param pressure          absolute, > 0 [Pa]
  /// @param ambient_pressure  absolute, > 0 [Pa]
  PolytropicGas(double exponent, double pressure, double ambient_pressure, double temperature);

  double exponent() const { return exponent_; }
  double ambient_pressure() const { return ambient_pressure_; }
  double ambient_density() const { return ambient_density_; }  ///< ρ_a [kg/m³]

  double density_at(double pressure) const;  ///< x at an absolute pressure [Pa]
  double pressure(double x) const;           ///< absolute [Pa]
  /// Work that a unit of mass can do while it expands to ambient pressure [J/kg].
  double energy(double x) const;
  /// That work with the work of being pushed along, h − h_a [J/kg].
  double enthalpy(double x) const;
  /// Flow through an orifice from a place of density x_1 to one of x_2 [kg/s].              (forces, eq. 27)
  /// @param area  opening times discharge coefficient [m²]
  double mass_flow(double area, double x_1, double x_2) const;
  /// Factor G of the flow G w that has the least mean square error where w = ln(x_1/x_2) has a normal
  /// distribution about 0 [kg/s].                                                           (forces, eq. 30)
  /// @param sigma  root mean square of w, > 0
  double calc_mean_gain(double area, double x_1, double sigma) const;

 private:
  double relative_energy(double x) const;
  double exponent_, ambient_pressure_, ambient_density_;
};

}  // namespace sprung::dynamics
