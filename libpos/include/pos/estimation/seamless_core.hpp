#pragma once
/// The filters of `seamless`: two error-state filters on one inertial unit, one for satellites and one for
/// radio, and what makes one answer of them. A value: copying it is looking ahead.

#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "pos/core/estimate.hpp"
#include "pos/core/verdict.hpp"
#include "pos/estimation/eskf_models.hpp"
#include "pos/estimation/mode_watch.hpp"
#include "pos/estimation/range_offsets.hpp"
#include "pos/estimation/seamless_configs.hpp"

namespace pos::estimation {

/// Filters by their sensor.
inline constexpr std::size_t kGnss = 0;
inline constexpr std::size_t kUwb = 1;
inline constexpr std::size_t kSeamlessModes = 2;

class SeamlessCore {
 public:
  using Beliefs = filters::Modes<EskfState, 2>;

  explicit SeamlessCore(const SeamlessConfig& config);

  void start(Stamp stamp, const Belief<EskfState>& belief);
  Stamp stamp() const { return stamp_; }
  /// The best belief; of an epoch under way, too (see `closed`).
  Belief<EskfState> combined() const;
  std::vector<ModeState> modeStates() const;
  double probability(std::size_t mode) const { return mu_[static_cast<Eigen::Index>(mode)]; }
  double gnssScale() const { return gnss_scale_; }
  double uwbScale() const { return uwb_scale_; }
  /// Of anchors that keep surprising; by the anchors' ids.
  const RangeOffsets& offsets() const { return offsets_; }

  /// All filters by one sample of the inertial unit, to `stamp`. Returns what happened, empty if nothing.
  std::string_view propagate(const ins::ImuIncrement& raw, Stamp stamp);

  /// A fix of the antenna at `lever` (from the unit) at the core's stamp; m, map axes.
  IngestReport take(const Eigen::Vector3d& antenna_map, const Matrix<3, 3>& R, const Eigen::Vector3d& lever);
  /// A range to an anchor known to `anchor_sigma` (m).
  IngestReport take(const RangeLink& link, double anchor_sigma);
  /// Knowledge for all filters in use.
  template <int M, class Model>
  void aid(const Model& model, const Matrix<M, M>& R) {
    for (std::size_t j = 0; j < kSeamlessModes; ++j) {
      if (!inUse(j)) continue;
      const auto innovation = model(beliefs_[j].mean);
      if (j == kUwb) {
        offsets_.correct<M>(beliefs_[j], innovation, R);
      } else {
        correctError<M>(beliefs_[j], innovation, R);
      }
    }
  }

  /// Ends the epoch under way: its evidence goes into the probabilities. Returns what happened.
  std::string_view close();
  /// The core as it is when no further reading of this stamp comes.
  SeamlessCore closed() const;

 private:
  /// The readings of one sensor at one stamp.
  struct Epoch {
    std::size_t mode = 0;
    Stamp stamp = {};
    int applied = 0;
    filters::Evidence evidence = {};
    Matrix<3, 3> information = Matrix<3, 3>::Zero();  ///< 1/m^2, of the place
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();   ///< 1/m, information times the shift
    Matrix<3, 3> prior = Matrix<3, 3>::Zero();        ///< m^2, of the place before
  };

  bool inUse(std::size_t mode) const;
  bool anyUsable() const;
  std::string_view open(std::size_t mode);
  void rejoin(std::size_t mode);
  void mix();
  Matrix<2, 2> transition(double dt) const;
  double logLikelihoodOf(const Epoch& epoch) const;
  void weigh();
  void forceFloor();
  IngestReport counted(IngestReport report);
  Verdict correct(Belief<EskfState>& belief, const PoseRow& row, int anchor, double R);
  /// Variance of a range that lies `nu` off, as the robust weights see it; nothing where it is rejected.
  std::optional<double> weighted(double nu, double state_variance, double variance) const;
  /// Learns from ranges that are too short: only those tell noise from hidden anchors.
  void learnRanges(double nu, double expected_variance);

  std::shared_ptr<const SeamlessConfig> config_;
  std::shared_ptr<const filters::FuzzyController> fuzzy_;
  double gnss_gate_;
  Stamp stamp_ = {};
  Beliefs beliefs_;
  Vector<2> mu_ = {0.98, 0.02};
  std::array<ModeWatch, kSeamlessModes> watch_;
  std::array<std::optional<double>, kSeamlessModes> log_likelihood_ = {};
  std::array<double, kSeamlessModes> sigma_ = {};  // m per axis, of the latest readings
  std::optional<Epoch> epoch_;
  Stamp weighed_ = {};  // when the probabilities were last changed
  Stamp mixed_ = {};
  Stamp believed_ = {};   // when anything was last applied
  RangeOffsets offsets_;  // beside the radio's belief
  AnchorDoubts doubts_;
  double gnss_scale_ = 1.0;  // on the claimed variance
  double uwb_scale_ = 1.0;   // on the variance of ranges
};

}  // namespace pos::estimation
