/// Option tables of vehicles, inertial units and wheel encoders.
#include "scenario_options.hpp"

namespace pos::io {
namespace {

using namespace pos::sim;

OptionTable<Mount> mountOptions() {
  OptionTable<Mount> table("mounts", "A place on the vehicle where a sensor can sit.");
  table.text("name", &Mount::name, "What sensors call it.").required();
  addPlace(table, &Mount::p_body, "Place,");
  return table;
}

/// Units of the axes of one triad.
struct TriadKeys {
  std::string bias;
  std::string bias_sigma;
  std::string moving_bias;
  std::string noise;
  std::string instability;
  std::string walk;
  std::string quantum;
  std::string limit;
};

OptionTable<TriadErrors> triadOptions(const std::string& title, const std::string& text,
                                      const TriadKeys& keys) {
  return OptionTable<TriadErrors>(title, text)
      .numbers(keys.bias, &TriadErrors::bias, anything(), "Bias of each axis, the same in every run.")
      .number(keys.bias_sigma, &TriadErrors::bias_sigma, atLeast(0),
              "Bias drawn once a run and axis, standard deviation.")
      .numbers(keys.moving_bias, &TriadErrors::moving_bias, anything(),
               "Added while the vehicle moves; standing still does not show it.")
      .number(keys.noise, &TriadErrors::noise_density, atLeast(0), "White noise.")
      .number(keys.instability, &TriadErrors::instability_sigma, atLeast(0),
              "Standard deviation of a bias that wanders about its mean.")
      .number("instability_time_s", &TriadErrors::instability_time, moreThan(0), "How fast it wanders.")
      .number(keys.walk, &TriadErrors::walk_density, atLeast(0), "Bias that wanders without a mean.")
      .numbers("scale_ppm", &TriadErrors::scale, anything(), "Scale error of each axis.")
      .number("scale_sigma_ppm", &TriadErrors::scale_sigma, atLeast(0), "The same, drawn once a run.")
      .number("misalignment_deg", &TriadErrors::misalignment_sigma, atLeast(0),
              "Angles between the axes, drawn once a run, standard deviation.")
      .number(keys.quantum, &TriadErrors::quantum, atLeast(0),
              "Step of the output (times 1 s for increments); 0 none.")
      .number(keys.limit, &TriadErrors::limit, atLeast(0), "Full scale; 0 none.");
}

OptionTable<SlipEvent> slipOptions() {
  OptionTable<SlipEvent> table("slips", "Wheels that do not roll as the ground goes by, for a while.");
  return withSpan(table, &SlipEvent::window)
      .choice("kind", &SlipEvent::kind,
              {{"ratio", SlipEvent::Kind::Ratio},
               {"lock_up", SlipEvent::Kind::LockUp},
               {"free", SlipEvent::Kind::Free}},
              "Rim speed: a share more than the ground's, none, or one of its own.")
      .choice("side", &SlipEvent::side,
              {{"both", SlipEvent::Side::Both},
               {"left", SlipEvent::Side::Left},
               {"right", SlipEvent::Side::Right}},
              "Wheels that slip.")
      .number("ratio", &SlipEvent::ratio, between(-1, 100), "For ratio: > 0 spins, < 0 skids.")
      .number("speed_m_per_s", &SlipEvent::speed, between(-50, 50), "For free: mean rim speed.")
      .number("amplitude_m_per_s", &SlipEvent::amplitude, between(-50, 50), "For free: of a sine on top.")
      .number("frequency_hz", &SlipEvent::frequency, atLeast(0), "For free: of that sine.");
}

}  // namespace

OptionTable<sim::TimeSpan> spanOptions(const std::string& key, const std::string& text) {
  OptionTable<TimeSpan> table(key, text);
  return withSpan(
      table, [](auto& span) -> auto& { return span; });
}

OptionTable<Eigen::Vector2d> outlinePointOptions() {
  return OptionTable<Eigen::Vector2d>("outline", "A corner.")
      .number(
          "x_m", [](auto& p) -> auto& { return p.x(); }, anything(), "East in the map.")
      .required()
      .number(
          "y_m", [](auto& p) -> auto& { return p.y(); }, anything(), "North in the map.")
      .required();
}

OptionTable<Vehicle> vehicleOptions() {
  return OptionTable<Vehicle>("vehicle", "Dimensions of a vehicle and the places on it.")
      .text("name", &Vehicle::name, "Name in reports.")
      .choice("steering", &Vehicle::steering,
              {{"front_ackermann", Steering::FrontAckermann},
               {"four_wheel", Steering::FourWheel},
               {"differential", Steering::Differential},
               {"articulated", Steering::Articulated},
               {"guided", Steering::Guided}},
              "How it is steered; guided runs on a conveyor or rails.")
      .number("length_m", &Vehicle::length, between(0, 100), "Over all.")
      .number("width_m", &Vehicle::width, between(0, 100), "Over all.")
      .number("height_m", &Vehicle::height, between(0, 100), "Over all.")
      .number("clearance_m", &Vehicle::clearance, between(0, 10), "Under the body.")
      .number("centre_x_m", &Vehicle::centre_x, between(-100, 100),
              "From the body origin forward to the middle of the length.")
      .number("wheelbase_m", &Vehicle::wheelbase, between(0, 100), "Front to rear axle.")
      .number("front_track_m", &Vehicle::front_track, between(0, 100), "Between the middles of the tyres.")
      .number("rear_track_m", &Vehicle::rear_track, between(0, 100), "Between the middles of the tyres.")
      .number("wheel_radius_m", &Vehicle::wheel_radius, between(0, 10), "Of a rolling wheel.")
      .number("wheel_width_m", &Vehicle::wheel_width, between(0, 10), "Of a tyre.")
      .number("max_speed_m_per_s", &Vehicle::max_speed, between(0, 100), "Fastest speed.")
      .number("max_steer_deg", &Vehicle::max_steer, between(0, 180), "Of a wheel, or of the joint.")
      .number("encoder_axle_x_m", &Vehicle::encoder_axle_x, between(-100, 100),
              "From the body origin forward to the axle with the encoders.")
      .number("encoder_track_m", &Vehicle::encoder_track, between(0, 100), "Between the encoder wheels.")
      .list("mounts", &Vehicle::mounts, mountOptions(), "Places on the vehicle where sensors can sit.")
      .check([](const Vehicle& vehicle) { (void)validated(vehicle); });
}

OptionTable<ImuModel> imuModelOptions() {
  OptionTable<ImuModel> table("imu", "Gyros and accelerometers.");
  addTiming(table, &ImuModel::timing);
  addPlace(table, &ImuModel::p_body, "Where it sits,");
  return table
      .choice("kind", &ImuModel::kind,
              {{"rates", ImuSample::Kind::Rates}, {"increments", ImuSample::Kind::Increments}},
              "Mean rates over each interval, or the increments themselves.")
      .choice("grade", &ImuModel::errors,
              {{"perfect", perfectImu()},
               {"automotive_mems", automotiveMems()},
               {"laboratory_mems", laboratoryMems()},
               {"navigation", navigationGrade()}},
              "Errors to begin with; single ones are changed under gyro and accelerometer.")
      .table(
          "gyro", [](auto& model) -> auto& { return model.errors.gyro; },
          triadOptions("gyro", "Errors of the gyros.",
                       {.bias = "bias_deg_per_h",
                        .bias_sigma = "bias_sigma_deg_per_h",
                        .moving_bias = "moving_bias_deg_per_h",
                        .noise = "noise_deg_per_sqrt_h",
                        .instability = "instability_deg_per_h",
                        .walk = "walk_deg_per_h_per_sqrt_h",
                        .quantum = "quantum_deg_per_s",
                        .limit = "limit_deg_per_s"}),
          "Errors of the gyros.")
      .table(
          "accelerometer", [](auto& model) -> auto& { return model.errors.accelerometer; },
          triadOptions("accelerometer", "Errors of the accelerometers.",
                       {.bias = "bias_ug",
                        .bias_sigma = "bias_sigma_ug",
                        .moving_bias = "moving_bias_ug",
                        .noise = "noise_ug_per_sqrt_hz",
                        .instability = "instability_ug",
                        .walk = "walk_m_per_s2_per_sqrt_s",
                        .quantum = "quantum_m_per_s2",
                        .limit = "limit_m_per_s2"}),
          "Errors of the accelerometers.")
      .check([](const ImuModel& model) { (void)validated(model); });
}

OptionTable<EncoderModel> encoderModelOptions() {
  OptionTable<EncoderModel> table("wheels", "Wheel encoders.");
  addTiming(table, &EncoderModel::timing);
  return table
      .choice("output", &EncoderModel::output,
              {{"ticks", EncoderModel::Output::Ticks},
               {"speeds", EncoderModel::Output::Speeds},
               {"increments", EncoderModel::Output::Increment}},
              "Counters, wheel speeds, or motion increments.")
      .number("ticks_per_turn", &EncoderModel::ticks_per_turn, atLeast(0),
              "Counts per turn of the wheel; 0 does not round (not for ticks).")
      .integer("counter_bits", &EncoderModel::counter_bits, between(1, 62), "The counter wraps at 2^bits.")
      .number("left_radius_error", &EncoderModel::left_radius_error, between(-0.5, 0.5),
              "The vehicle's figure is this share too large.")
      .number("right_radius_error", &EncoderModel::right_radius_error, between(-0.5, 0.5),
              "The vehicle's figure is this share too large.")
      .number("track_error", &EncoderModel::track_error, between(-0.5, 0.5),
              "The vehicle's figure is this share too large.")
      .number("distance_noise_m_per_sqrt_m", &EncoderModel::distance_noise, between(0, 10),
              "Micro slip of each wheel.")
      .number("speed_sigma_m_per_s", &EncoderModel::speed_sigma, between(0, 10),
              "Noise of each wheel, for speeds.")
      .number("yaw_sigma_deg", &EncoderModel::yaw_sigma, between(0, 90), "Noise of each increment.")
      .flag("claims_covariance", &EncoderModel::claims_covariance,
            "Whether increments say how good they are.")
      .list("slips", &EncoderModel::slips, slipOptions(), "When wheels slip.")
      .check([](const EncoderModel& model) { (void)validated(model); });
}

}  // namespace pos::io
