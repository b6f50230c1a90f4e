#pragma once
/// A replay configuration in which every key stands, all with other values than the defaults.

#include <string>

namespace pos::test {

inline const std::string kFullConfig = R"(schema: 1
name: uwb_demo
log: {file: "mrpt-common:datasets/uwb.rawlog"}
map: ../../maps/uwb_demo/map.yaml
truth: {file: truth.txt, format: mrpt_index, x_m: 2, y_m: 4, yaw_deg: 15}
sequencer: {lag_s: 0.5}
seed: 18446744073709551615
record: {max_rate_hz: 10}
faults: {range_outlier_probability: 0.2, range_outlier_min_m: 4, range_outlier_max_m: 21, seed: 5}
sensors:
  - {sensor: UWB, use: false, latency_s: 0.05}
  - sensor: "laser front"
evaluation: {align: posyaw, skip_start_s: 3, max_gap_s: 2, truth_time_offset_s: -0.1, truth_sigma_m: 0.15}
estimators:
  - name: odometry
    type: dead_reckoning
    variant: odometry
    start: {mode: known, x_m: 2, y_m: 4, yaw_deg: 30, position_sigma_m: 0.2, yaw_sigma_deg: 5}
    odometry_noise:
      distance_m_per_sqrt_m: 0.04
      lateral_m_per_sqrt_m: 0.02
      yaw_deg_per_sqrt_m: 0.5
      yaw_deg_per_sqrt_deg: 0.3
      yaw_deg_per_sqrt_s: 0.03
      position_m_per_sqrt_s: 0.002
  - name: range_odometry
    type: range_odometry
    motion: constant_velocity
    start: {mode: unknown_heading, x_m: 2.5, y_m: 4.5}
    odometry_noise: {yaw_deg_per_sqrt_m: 1}
    acceleration_density_m_per_s_per_sqrt_s: 0.6
    yaw_acceleration_density_deg_per_s_per_sqrt_s: 20
    max_speed_m_per_s: 12
    tags: [{id: 0, x_m: 0.16, y_m: 0.1, z_m: 1.12}, {id: 7, x_m: -1, y_m: 0, z_m: 2}]
    body_height_m: -350.5
    range_sigma_m: 0.17
    range_scale: {value: 1.01, sigma: 0.02, walk_per_sqrt_s: 0.001}
    range_offset: {value_m: 0.1, sigma_m: 0.2, walk_m_per_sqrt_s: 0.01}
    anchor_offset: {value_m: 0.3, sigma_m: 0.4, walk_m_per_sqrt_s: 0.02}
    gyro_bias: {value_deg_per_s: 0.5, sigma_deg_per_s: 0.6, walk_deg_per_s_per_sqrt_s: 0.03}
    wheel_scale: {value: 0.99, sigma: 0.05, walk_per_sqrt_s: 0.002}
    latency: {value_s: 0.05, sigma_s: 0.02, walk_s_per_sqrt_s: 0.001}
    gate: {confidence: 0.99, open_after_s: 4, agreement_fraction: 0.5, inflation: 9}
    heading_hypotheses: 24
  - name: mcl-1
    type: mcl
    start: {mode: unknown}
    odometry_noise: {}
    tags: []
    body_height_m: 0.5
    use_ranges: false
    use_scans: true
    range: {sigma_m: 0.3, outlier_probability: 0.2, range_max_m: 50, bias_sigma_m: 0.1, bias_time_s: 20, correlation_length_m: 3}
    scan: {beams: 90, sigma_m: 0.2, outlier_probability: 0.3, distance_max_m: 2, tempering: 0.5, correlation_length_m: 0.25}
    particles: {min: 100, max: 30000, kld_epsilon: 0.03, kld_z: 3, bin_position_m: 0.5, bin_yaw_deg: 20}
    resample_below: 0.6
    injection_slow: 0.002
    injection_fast: 0.2
    seed: 42
  - name: yardstick
    type: mrpt_mcl
    start: {mode: known}
    odometry_noise: {position_m_per_sqrt_s: 0.003}
    tags: []
    body_height_m: 0.25
    use_ranges: false
    use_scans: true
    range_sigma_m: 0.2
    particles: 3000
    adaptive_size: false
    beams: 30
    seed: 9
)";

}  // namespace pos::test
