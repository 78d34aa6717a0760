#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reduce/superelement/certificate.h"
#include "reduce/superelement/unit_loads.h"
#include "tools/support/hdf5/row_matrix.h"

namespace sprung::reduce {

/// Integrals of positions r = (x, y) and mode shapes φ over the mass of a body, in the body frame (reduce,
/// eqs. 10–17). They are all that a planar floating frame needs. They are those of the consistent mass, with
/// the rotary inertia of sections and point masses.
struct InertiaInvariants {
  double mass = 0.0;                                       ///< m = ∫dm [kg]
  Eigen::Vector2d first_moment = Eigen::Vector2d::Zero();  ///< S₀ = ∫r dm [kg·m]
  double second_moment = 0.0;  ///< J₀ = ∫(x² + y²) dm, about the body frame's origin [kg·m²]
  Eigen::Matrix2Xd P;          ///< ∫φ dm, 2×n; mode columns in m per unit modal coordinate
  Eigen::RowVectorXd c;        ///< ∫(x φ_y − y φ_x) dm, 1×n: momentum about the origin
  Eigen::RowVectorXd d;        ///< ∫(x φ_x + y φ_y) dm, 1×n
  Eigen::MatrixXd M_ff;        ///< ∫φᵀφ dm, n×n, symmetric (identity for modes of the held body)
  Eigen::MatrixXd B;           ///< ∫(φ_xᵀφ_y − φ_yᵀφ_x) dm, n×n, skew

  // The same integrals by component, without rotary inertia. Files of other programs can be made from them.
  Eigen::RowVectorXd x_phi_x, x_phi_y, y_phi_x, y_phi_y;  ///< 1×n each, ∫x φ_x dm …
  Eigen::MatrixXd phi_x_phi_x, phi_x_phi_y, phi_y_phi_y;  ///< n×n each, ∫φ_xᵀφ_x dm …
};

/// Geometric stiffness of the lowest m modes under reference loads. Each load causes axial forces in the body
/// held at its reference node, and these stiffen or soften bending (reduce, eqs. 19, 20). Each matrix is m×m
/// and symmetric. It also gives the displacement of second order (reduce, eq. 22).
struct GeometricStiffness {
  Eigen::MatrixXd centrifugal;           ///< K_ω, of turning at 1 rad/s about the body frame's origin [1]
  Eigen::MatrixXd angular_acceleration;  ///< K_α, of the inertia at 1 rad/s² [1]
  /// K_x, K_y, of the inertia at an acceleration of the frame of 1 m/s² along its axes [1/m]
  std::array<Eigen::MatrixXd, 2> acceleration;
  /// For each of the superelement's points: K of a force of 1 N on its node along x, along y [1/(kg·m)], and
  /// of a moment of 1 N·m [1/(kg·m²)]
  std::vector<std::array<Eigen::MatrixXd, 3>> point_loads;

  int num_modes() const { return static_cast<int>(centrifugal.rows()); }
};

/// A node that a design gave a name.
struct NamedPoint {
  std::string name;
  int node = 0;  ///< 0-based
};

/// Dimensions of the elements' sections that stresses need, parallel members included. 0: not known
struct SectionSizes {
  Eigen::VectorXd area;     ///< A, E [m²]
  Eigen::VectorXd modulus;  ///< W of the extreme fibre, E [m³]
};

/// A check made when the file was written.
struct CheckResult {
  std::string name;
  double value = 0.0;
  double tolerance = 0.0;
  bool passed() const { return value <= tolerance; }
};

/// Where a superelement comes from.
struct Provenance {
  std::string design_text;               ///< the design file as read
  std::string design_hash;               ///< SHA-256 of design_text
  std::vector<std::string> input_names;  ///< mesh files read, as the design names them
  std::vector<std::string> input_hashes;
  std::string program_version;
  std::int64_t algorithm_revision = 0;  ///< increased whenever the same design gives other numbers
};

/// A flexible body reduced to its modes: what stage one writes and stage two loads. SI units; the origin of
/// the body frame is the reference node. n modes, N nodes, E elements. The modes do not move the reference
/// node; they are mass-normalised (those of a free body for its elastic motion, reduce/basis, eq. 3), in
/// ascending frequency, in the canonical basis (reduce, "One basis").
struct Superelement {
  std::string name;

  std::vector<std::int64_t> node_ids;  ///< the mesh's numbers, N
  Eigen::Matrix2Xd node_positions;     ///< 2×N [m]
  std::vector<NamedPoint> points;
  Eigen::Matrix2Xi elements;                  ///< 2×E, 0-based node at each end
  std::vector<std::string> element_sections;  ///< E, name of each element's section

  Eigen::VectorXd frequency_hz;   ///< n
  Eigen::VectorXd damping_ratio;  ///< n, of critical
  Eigen::VectorXi cluster;        ///< n, 1-based; modes of equal frequency share a number
  std::vector<std::string> kind;  ///< n, what each vector is; none in files before version 3: all clamped
  Eigen::MatrixXd
      shapes;  ///< 3N×n, rows (x [m], y [m], rotation [rad]) of each node, per unit modal coordinate
  std::int64_t num_elastic_dofs = 0;  ///< freedoms of the finite element model without the reference node's

  Eigen::MatrixXd stiffness, mass, damping;  ///< n×n
  InertiaInvariants inertia;
  /// 6E×n per unit modal coordinate: N [N], Q [N], M [N·m] at the first, then the second end of each element.
  /// They are most of a large body: in memory they stand as in the file.
  support::RowMatrix resultants;
  std::optional<GeometricStiffness> geometric_stiffness;  ///< none in files of version 1
  std::optional<Certificate> certificate;                 ///< none in files before version 3
  /// Resultants (6E rows) and deflections of the points (3p rows) under unit loads. None in files before
  /// version 4, and of large frames
  std::optional<UnitLoads> section_loads, point_deflections;
  std::optional<SectionSizes> section_sizes;  ///< none in files before version 5, and of large frames

  std::vector<CheckResult> checks;
  Provenance provenance;
  std::string content_hash;  ///< SHA-256 of all of the above; set by write and read

  int num_modes() const { return static_cast<int>(frequency_hz.size()); }
  int num_nodes() const { return static_cast<int>(node_ids.size()); }
  /// What a vector of the basis is, also where the file does not say it. @param mode 0-based
  std::string kind_of(int mode) const;
  /// Whether the vectors are normalised for the elastic motion of the free body, so that a damping ratio is
  /// that of the free body.
  bool has_free_basis() const;
};

/// The file format (reduce/superelement/superelement.md): its name, and its versions, all of which are read.
inline constexpr std::string_view kSuperelementFormat = "sprung-superelement";
inline constexpr std::int64_t kFirstVersion = 1;
inline constexpr std::int64_t kStiffeningVersion = 2;   ///< brought the geometric stiffness
inline constexpr std::int64_t kCertificateVersion = 3;  ///< brought kinds of vectors and the certificate
inline constexpr std::int64_t kSectionLoadVersion =
    4;  ///< brought section loads and deflections under unit loads
inline constexpr std::int64_t kSectionSizeVersion = 5;  ///< brought the sizes of sections
/// brought the soft twin's shapes at the reference node, and may lack what versions 4 and 5 brought
inline constexpr std::int64_t kSoftReferenceVersion = 6;
inline constexpr std::int64_t kSoftShareVersion = 7;  ///< brought the shares of the soft twin at rest
inline constexpr std::int64_t kSuperelementVersion = kSoftShareVersion;  ///< the newest

/// Writes the file whole or not at all. Equal superelements give equal bytes. Without the soft twin's shares
/// at rest it is a file of version 6, without its shapes at the reference node, too, of version 5, without
/// sizes of sections of version 4, without section loads of version 3, without a certificate of version 2,
/// without geometric stiffness of version 1.
/// @return the content hash
/// @throws support::InputError if the file cannot be written; std::invalid_argument if the parts do not fit
/// together
std::string write_superelement(const Superelement& superelement, const std::filesystem::path& path);

/// Reads and verifies a file: format, version, shapes, signs, symmetry, finite values, hash.
/// @throws support::InputError naming file and dataset
Superelement read_superelement(const std::filesystem::path& path);

/// The node at the body frame's origin, where the modes are held. @return 0-based
Eigen::Index find_reference_node(const Superelement& superelement);

/// The node of the point with this name. @return 0-based node, or -1
int find_point(const Superelement& superelement, const std::string& name);

}  // namespace sprung::reduce
