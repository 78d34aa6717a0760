#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "reduce/superelement/superelement.h"

namespace sprung::test {

/// A body of point masses, for which every integral of a superelement is a simple sum.
struct LumpedBody {
  struct Node {
    std::string name;  ///< empty: not named
    Eigen::Vector2d position;
    double mass = 1.0;  ///< [kg]
  };
  std::string name;
  std::vector<Node> nodes;  ///< the first is the reference node, at the origin and at rest in all modes
  std::vector<double> frequencies;  ///< ascending [Hz]; equal ones make a cluster; at most 2 per further node
  double damping_ratio = 0.01;
};

/// Its superelement: mass-normalised modes with motion and rotation everywhere but at the reference node.
reduce::Superelement make_lumped_superelement(const LumpedBody& body);

/// Writes FOLDER/NAME.h5 of a body, the folder made new.
std::filesystem::path write_lumped_superelement(const LumpedBody& body, const std::filesystem::path& folder);

}  // namespace sprung::test
