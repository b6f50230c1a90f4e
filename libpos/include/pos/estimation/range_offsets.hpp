#pragma once
/// Offsets of anchors' ranges as states beside an inertial one (section A8.5 of the specification: an anchor
/// that keeps surprising gets a bias of its own). Each is a Gauss-Markov process about zero.
///
/// x = inertial state, P its covariance (15 x 15)    b = offsets    C = cov(x, b)    B = cov(b)
/// The joint covariance is [P C; C' B]: P stays with its owner, C and B live here.

#include <map>
#include <optional>
#include <vector>

#include "pos/core/stamp.hpp"
#include "pos/estimation/anchor_bias_config.hpp"
#include "pos/estimation/eskf_models.hpp"

namespace pos::estimation {

class RangeOffsets {
 public:
  struct Offset {
    int anchor = 0;
    double mean = 0.0;   ///< m
    double sigma = 0.0;  ///< m
  };

  bool none() const { return anchors_.empty(); }
  bool has(int anchor) const { return indexOf(anchor) >= 0; }
  std::vector<Offset> list() const;

  /// The anchor's offset becomes a state; nothing when it is one.
  void add(int anchor, const AnchorBiasConfig& config);
  /// It is forgotten, and what it had to do with the rest.
  void drop(int anchor);

  /// The inertial state one sample further, with all that hangs on it.
  void propagate(Belief<EskfState>& belief, const ins::ImuIncrement& raw, const ins::EskfProcess& process);
  /// C <- F C, and the offsets forget themselves.
  void carry(const ins::EskfTransition& F);
  /// The inertial state is now a mixture in which this one has `share` (0 to 1): C <- share C.
  void mix(double share) { cross_ *= share; }

  /// nu and H P H' of a range whose row was made without its offset.
  SequentialCorrection::Expected expected(const Belief<EskfState>& belief, const PoseRow& row,
                                          int anchor) const;
  /// Corrects state and offsets by a range with variance R.
  filters::Correction<1> take(Belief<EskfState>& belief, PoseRow row, int anchor, double R);
  /// Corrects both by a reading of M = 1, 2 or 3 numbers that depends on the state alone.
  template <int M>
  filters::Correction<M> correct(Belief<EskfState>& belief,
                                 const filters::Innovation<EskfState, M>& innovation, const Matrix<M, M>& R,
                                 filters::Gate gate = {});

 private:
  template <int M>
  using Rows = Eigen::Matrix<double, M, Eigen::Dynamic>;
  /// Joint correction, H over both.
  template <int M>
  filters::Correction<M> correctJoint(Belief<EskfState>& belief,
                                      const filters::Innovation<EskfState, M>& innovation,
                                      const Rows<M>& H_offset, const Matrix<M, M>& R, filters::Gate gate);
  int indexOf(int anchor) const;

  std::vector<int> anchors_;
  Eigen::VectorXd mean_;                                                       // m
  Eigen::Matrix<double, 15, Eigen::Dynamic> cross_ = decltype(cross_)(15, 0);  // C
  Eigen::MatrixXd covariance_;                                                 // B
  double sigma_ = 0.0;                                                         // m, steady
  double time_ = 1.0;                                                          // s
};

/// Which anchors keep surprising, and so get an offset, and which no longer do.
class AnchorDoubts {
 public:
  /// One range that lay `doubtful` (beyond the first threshold) or not: adds or drops the anchor's offset.
  void note(const AnchorBiasConfig& config, Stamp stamp, int anchor, bool doubtful, RangeOffsets& offsets);
  void forget() { lately_.clear(); }

 private:
  struct Lately {
    std::optional<Stamp> doubtful_since;
    std::optional<Stamp> good_since;
  };
  std::map<int, Lately> lately_;
};

/// nu, S, NIS and verdict of a correction that has not been made yet.
template <int M>
filters::Correction<M> judged(const Vector<M>& nu, const Matrix<M, M>& S, filters::Gate gate) {
  filters::Correction<M> told;
  told.nu = nu;
  told.S = S;
  const Eigen::LLT<Matrix<M, M>> factor(S);
  if (factor.info() != Eigen::Success || !S.allFinite() || !nu.allFinite()) {
    told.verdict = Verdict::Degenerate;
    return told;
  }
  told.nis = nu.dot(factor.solve(nu));
  if (told.nis > gate.threshold) told.verdict = Verdict::Gated;
  return told;
}

}  // namespace pos::estimation
