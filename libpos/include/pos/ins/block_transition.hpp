#pragma once
/// A transition that is the identity but for a few blocks of three, and what it does to a covariance. The
/// zeros cost nothing, which is most of an inertial filter's matrix (bench/sins).
///
/// Phi = I + B    B = sum of 3 x 3 blocks and of single columns of three    P <- Phi P Phi'

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "pos/ins/error_model.hpp"

namespace pos::ins {

/// m += p A' for three columns of `rows` entries each, that lie behind each other, and A by columns.
void addTurned(double* m, const double* p, const double* A, int rows);

/// N states, at most `Capacity` blocks and as many columns. Rows of blocks begin at multiples of three.
template <int N, int Capacity = 24>
class BlockTransition {
 public:
  using Covariance = Eigen::Matrix<double, N, N>;

  /// Adds a block at (row, column); more than one at a place add up.
  void add(int row, int column, const Eigen::Matrix3d& block) {
    blocks_[block_count_++] = {row, column, block};
    active_[static_cast<std::size_t>(row / 3)] = true;
  }
  /// Adds three entries below each other.
  void add(int row, int column, const Eigen::Vector3d& entries) {
    columns_[column_count_++] = {row, column, entries};
    active_[static_cast<std::size_t>(row / 3)] = true;
  }

  Covariance dense() const {
    Covariance Phi = Covariance::Identity();
    for (std::size_t i = 0; i < block_count_; ++i)
      Phi.template block<3, 3>(blocks_[i].row, blocks_[i].column) += blocks_[i].value;
    for (std::size_t i = 0; i < column_count_; ++i)
      Phi.template block<3, 1>(columns_[i].row, columns_[i].column) += columns_[i].value;
    return Phi;
  }

  /// P <- Phi P Phi' for a symmetric P; the result is symmetric to the last bit.
  void carry(Covariance& P) const {
    Covariance M = P;  // becomes P Phi'
    for (std::size_t i = 0; i < block_count_; ++i) addRight(blocks_[i], P, M);
    for (std::size_t i = 0; i < column_count_; ++i) {
      for (int k = 0; k < 3; ++k)
        M.col(columns_[i].row + k) += columns_[i].value[k] * P.col(columns_[i].column);
    }
    // Rows of Phi that are those of the identity leave M as it is, and by symmetry say what the other half
    // is. Between two rows of blocks one side is enough.
    P = M;
    for (std::size_t i = 0; i < block_count_; ++i) addLeft(blocks_[i], M, P);
    for (std::size_t i = 0; i < column_count_; ++i) addLeft(columns_[i], M, P);
    mirror(M, P);
  }

 private:
  struct Block {
    int row;
    int column;
    Eigen::Matrix3d value;
  };
  struct Column {
    int row;
    int column;
    Eigen::Vector3d value;
  };

  /// M.cols(row) += P.cols(column) A'.
  static void addRight(const Block& block, const Covariance& P, Covariance& M) {
    addTurned(M.data() + static_cast<std::ptrdiff_t>(block.row) * N,
              P.data() + static_cast<std::ptrdiff_t>(block.column) * N, block.value.data(), N);
  }

  bool isActive(int third) const { return active_[static_cast<std::size_t>(third)]; }

  /// P.rows(row) += A M.rows(column), for the columns of active rows up to this one.
  void addLeft(const Block& block, const Covariance& M, Covariance& P) const {
    for (int j = 0; j <= block.row; j += 3) {
      if (isActive(j / 3)) {
        P.template block<3, 3>(block.row, j).noalias() +=
            block.value.lazyProduct(M.template block<3, 3>(block.column, j));
      }
    }
  }
  void addLeft(const Column& column, const Covariance& M, Covariance& P) const {
    for (int j = 0; j <= column.row; j += 3) {
      if (isActive(j / 3)) {
        P.template block<3, 3>(column.row, j).noalias() +=
            column.value * M.template block<1, 3>(column.column, j);
      }
    }
  }

  void mirror(const Covariance& M, Covariance& P) const {
    for (int r = 0; r < kThirds; ++r) {
      if (!isActive(r)) continue;
      for (int j = 0; j < N; ++j) {
        const bool computed = j / 3 < kThirds && isActive(j / 3);
        if (!computed) {
          // Row j of Phi is that of the identity: entry (j, r) of P Phi' is final.
          for (int k = 0; k < 3; ++k) P(3 * r + k, j) = M(j, 3 * r + k);
        } else if (j / 3 < r) {
          for (int k = 0; k < 3; ++k) P(j, 3 * r + k) = P(3 * r + k, j);
        }
      }
      // The block on the diagonal is symmetric but for rounding.
      for (int k = 1; k < 3; ++k) {
        for (int l = 0; l < k; ++l) P(3 * r + l, 3 * r + k) = P(3 * r + k, 3 * r + l);
      }
    }
  }

  static constexpr int kThirds = N / 3;
  std::array<Block, Capacity> blocks_;
  std::array<Column, Capacity> columns_;
  std::array<bool, kThirds + 1> active_{};
  std::size_t block_count_ = 0;
  std::size_t column_count_ = 0;
};

/// The first fifteen rows (those of `ErrorRow`) of an inertial error model over dt (s), in the tangent "truth
/// from estimate": phi and the biases as they are, v and p with the other sign. First order throughout,
/// second order where neither factor holds the Earth's rate or curvature; what is left out is below 2e-4 dt
/// of the first order. Blocks of an Earth that does not turn, or is flat, are absent.
template <int N, int Capacity>
void addInertial(BlockTransition<N, Capacity>& Phi, const Earth& earth, const ErrorModel& m, double dt) {
  const double half = 0.5 * dt * dt;
  const Eigen::Matrix3d v_by_phi = -dt * m.v_phi;
  Phi.add(kPhi, kGyroBias, Eigen::Matrix3d(-dt * m.C));
  Phi.add(kVelocity, kPhi, v_by_phi);
  Phi.add(kVelocity, kGyroBias, Eigen::Matrix3d(half * m.v_phi * m.C));
  Phi.add(kVelocity, kAccelerometerBias, Eigen::Matrix3d(-dt * m.C));
  Phi.add(kPosition, kVelocity, Eigen::Matrix3d(dt * Eigen::Matrix3d::Identity()));
  Phi.add(kPosition, kPhi, Eigen::Matrix3d(0.5 * dt * v_by_phi));
  Phi.add(kPosition, kAccelerometerBias, Eigen::Matrix3d(-half * m.C));
  if (!earth.turns()) return;
  Phi.add(kPhi, kPhi, Eigen::Matrix3d(dt * m.phi_phi));
  Phi.add(kVelocity, kVelocity, Eigen::Matrix3d(dt * m.v_v));
  if (earth.isFlat()) return;
  Phi.add(kPhi, kVelocity, Eigen::Matrix3d(-dt * m.phi_v));
  Phi.add(kPhi, kPosition, Eigen::Matrix3d(-dt * m.phi_p));
  Phi.add(kVelocity, kPosition, Eigen::Matrix3d(dt * m.v_p));
  Phi.add(kPosition, kPosition, Eigen::Matrix3d(dt * m.p_p));
}

}  // namespace pos::ins
