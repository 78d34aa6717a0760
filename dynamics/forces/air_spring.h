#pragma once

#include <array>
#include <optional>

#include "dynamics/forces/force_element.h"
#include "dynamics/forces/polytropic_gas.h"
#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// An air spring along the line between two markers, or two equal ones whose gas is coupled by a line
/// (forces, eqs. 24–30). Each bellows may have an auxiliary volume behind an orifice. A levelling valve may
/// fill and vent the first bellows.
///
/// Its chambers are the first bellows, its auxiliary volume, the second bellows, its auxiliary volume.
/// Internal states: ln(ρ_i/ρ_0) of each chamber i behind the first; with a valve also ln(M/M_0) of the mass
/// of all gas, and the deflection that the valve has followed. Branch: the piece of the valve's opening.
/// Switches: the ends of this piece.
class AirSpring final : public ForceElement {
 public:
  struct Levelling {
    double dead_band = 0.0;        ///< deflection that leaves the valve closed, > 0 [m]
    double full_opening = 0.0;     ///< deflection at which it is open, > dead_band [m]
    double delay = 1.0;            ///< time constant with which it follows, > 0 [s]
    double supply_pressure = 0.0;  ///< absolute [Pa]
    double area = 0.0;             ///< of its orifice, times the discharge coefficient [m²]
  };
  struct Parameters {
    std::array<int, 4> markers{};        ///< a, b, and those of the second bellows
    bool is_coupled = false;             ///< there is a second bellows
    double multiplicity = 1.0;           ///< number of them side by side, > 0
    double design_height = 1.0;          ///< > 0 [m]
    double volume = 0.0;                 ///< of a bellows at that height, > 0 [m³]
    PiecewisePolynomial effective_area;  ///< over the height, > 0 [m²]
    double pressure = 0.0;               ///< of all gas at rest at that height, absolute [Pa]
    double exponent = 1.3;               ///< n ≥ 1
    double ambient_pressure = 101325.0;  ///< absolute [Pa]
    double temperature = 293.15;         ///< [K]
    double auxiliary_volume = 0.0;       ///< of each bellows; 0: none [m³]
    double auxiliary_area = 0.0;         ///< of its orifice, times the discharge coefficient [m²]
    double line_area = 0.0;              ///< of the line between two bellows, the same [m²]
    std::optional<Levelling> levelling = {};
  };
  AirSpring(std::string element_name, Parameters parameters);

  const Parameters& parameters() const { return parameters_; }
  std::string_view kind() const override { return "air-spring"; }
  std::vector<int> markers() const override;
  ElementDescription describe() const override;
  Power add_wrenches(const Instant& instant, std::span<const int> branches,
                     std::span<Wrench> wrenches) const override;
  double calc_stored_energy(const Instant& instant, std::span<const int> branches) const override;
  std::vector<InternalState> internal_states() const override;
  void calc_state_rates(const Instant& instant, std::span<const int> branches,
                        std::span<double> rates) const override;
  RandomLaws linearise_for_random_motion(const Instant& at_rest, std::span<const int> branches,
                                         std::span<const double> rms) const override;

  int num_branches() const override { return parameters_.levelling ? 1 : 0; }
  void choose_branches(const Instant& instant, std::span<int> branches) const override;
  int num_switches() const override;
  void calc_switches(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

  std::span<const Channel> channels() const override { return channels_; }
  void calc_channels(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

 private:
  static constexpr std::size_t kMostChambers = 4;
  struct Chamber {
    int bellows = -1;     // −1: an auxiliary volume
    double volume = 0.0;  // at the design height
    double offset = 0.0;  // of a bellows: V(h) = offset + ∫₀ʰ A
  };
  struct Passage {  // an orifice or a line
    std::size_t from = 0, to = 0;
    double area = 0.0;
    std::size_t channel = 0;  // with the difference of pressures
  };
  struct Motion;
  struct Gas;
  std::size_t num_bellows() const { return parameters_.is_coupled ? 2 : 1; }
  Motion calc_motion(const Instant& instant, std::size_t bellows) const;
  Gas calc_gas(const Instant& instant, std::span<const int> branches) const;
  double calc_followed(const Instant& instant) const;  // the deflection that the valve has followed
  void add_channels();

  Parameters parameters_;
  PolytropicGas gas_;
  std::vector<Chamber> chambers_;
  std::vector<Passage> passages_;
  std::vector<double> state_factors_;  // a state is this times the logarithm, or the deflection [J^0.5, /m]
  double mass_ = 0.0;                  // of the gas at rest at the design height, of one of the springs [kg]
  PiecewisePolynomial opening_;        // of the valve, over the deflection that it has followed
  std::vector<Channel> channels_;
};

}  // namespace sprung::dynamics
