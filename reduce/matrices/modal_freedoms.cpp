#include "reduce/matrices/modal_freedoms.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace sprung::reduce {

namespace {

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr double kSameFrequency = 1e-6;  // relative, of ω²
constexpr double kPure = 1e-6;           // share of one motion in a freedom of the other

// M T, each column divided by the root of its motion's mass.
Rows calc_coupling(const Eigen::SparseMatrix<double>& mass, const Eigen::SparseMatrix<double>& motions) {
  const Eigen::SparseMatrix<double> rows = mass * motions;
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(motions.cols());
  for (Eigen::Index column = 0; column < motions.cols(); ++column) {
    const double diagonal = motions.col(column).dot(rows.col(column));
    if (diagonal > 0.0) scale(column) = 1.0 / std::sqrt(diagonal);
  }
  return rows * scale.asDiagonal();
}

// Of a row, which may have no columns: of those, Eigen defines no norm.
double calc_squared_norm(const Rows& rows, int row) {
  double sum = 0.0;
  for (Rows::InnerIterator entry(rows, row); entry; ++entry) sum += entry.value() * entry.value();
  return sum;
}

class Divider {
 public:
  Divider(const MatrixSystem& system, const Eigen::SparseMatrix<double>& symmetric,
          const Eigen::SparseMatrix<double>& antisymmetric)
      : stiffness_(system.stiffness.diagonal()),
        mass_(system.mass.diagonal()),
        even_(calc_coupling(system.mass, symmetric)),
        odd_(calc_coupling(system.mass, antisymmetric)) {
    for (int row = 0; row < system.freedoms.size(); ++row) {
      if (system.freedoms[row].is_modal()) waiting_.push_back(row);
    }
  }

  ModalFreedoms divide() {
    while (!waiting_.empty()) {
      const std::vector<int> rows = find_equal(waiting_.front());
      if (rows.size() > 1 && std::any_of(rows.begin(), rows.end(), [&](int row) { return is_mixed(row); })) {
        turn(rows);
        std::erase_if(waiting_, [&](int row) { return std::binary_search(rows.begin(), rows.end(), row); });
      } else {
        const int row = waiting_.front();
        add(calc_squared_norm(odd_, row) > calc_squared_norm(even_, row), {row, {{row, 1.0}}});
        waiting_.erase(waiting_.begin());
      }
    }
    return divided_;
  }

 private:
  // Those that wait and have the same frequency as one of them; ascending.
  std::vector<int> find_equal(int first) const {
    std::vector<int> rows;
    const double omega_squared = stiffness_(first) / mass_(first);
    for (const int row : waiting_) {
      const double difference = std::abs(stiffness_(row) / mass_(row) - omega_squared);
      if (row == first || difference <= kSameFrequency * omega_squared) rows.push_back(row);
    }
    return rows;
  }
  bool is_mixed(int row) const {
    const double even = calc_squared_norm(even_, row), odd = calc_squared_norm(odd_, row);
    return std::min(even, odd) > kPure * kPure * std::max(even, odd);
  }
  void add(bool is_odd, ModalMotion motion) {
    (is_odd ? divided_.antisymmetric : divided_.symmetric).push_back(std::move(motion));
  }
  // Of unit modal masses, along the main directions of how much more they are coupled with T than with U.
  void turn(const std::vector<int>& rows) {
    const auto size = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd even(size, even_.cols()), odd(size, odd_.cols());
    for (Eigen::Index i = 0; i < size; ++i) {
      const int row = rows[static_cast<std::size_t>(i)];
      even.row(i) = even_.row(row) / std::sqrt(mass_(row));
      odd.row(i) = odd_.row(row) / std::sqrt(mass_(row));
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> split(even * even.transpose() -
                                                               odd * odd.transpose());
    for (Eigen::Index j = 0; j < size; ++j) {
      ModalMotion motion{.row = rows[static_cast<std::size_t>(j)], .parts = {}};
      for (Eigen::Index i = 0; i < size; ++i) {
        const int row = rows[static_cast<std::size_t>(i)];
        motion.parts.emplace_back(row, split.eigenvectors()(i, j) / std::sqrt(mass_(row)));
      }
      add(split.eigenvalues()(j) < 0.0, std::move(motion));
    }
  }

  Eigen::VectorXd stiffness_, mass_;
  Rows even_, odd_;
  std::vector<int> waiting_;
  ModalFreedoms divided_;
};

}  // namespace

ModalFreedoms divide_modal_freedoms(const MatrixSystem& system, const Eigen::SparseMatrix<double>& symmetric,
                                    const Eigen::SparseMatrix<double>& antisymmetric) {
  return Divider(system, symmetric, antisymmetric).divide();
}

}  // namespace sprung::reduce
