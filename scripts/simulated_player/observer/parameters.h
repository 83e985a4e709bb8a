// The properties of one simulated player. Every value is a property of a person; none is a property of a display
// or a network.
#pragma once

namespace tactus::observer {

// The fields, their published ranges and sources are the rows of population.cpp. Times in s, lengths in m, angles
// in degrees. A Weber fraction is the difference at 75 % correct in a two-interval comparison, as a share of the
// value.
struct PlayerParameters {
  // Natural latencies: from the presentation of a stimulus to its use by the hand.
  double visual_latency_s = 0.120;
  double touch_latency_s = 0.065;
  double auditory_latency_s = 0.110;
  double cold_latency_s = 0.4;
  double warm_latency_s = 0.7;
  // Time constant of each of the two poles of a muscle.
  double muscle_s = 0.040;
  // Error of the believed delay before any experience: believed minus true.
  double initial_delay_error_s = 0;
  // Adaptation: rate for each event, and the share of an added delay that is learnt for action and for perception.
  double adaptation_rate = 0.063;
  double motor_adaptation = 0.55;
  double perceptual_adaptation = 0.2;
  // Vision: standard deviation of a direction in the fovea, eccentricity that doubles it, Weber fraction of speed.
  double visual_sd_deg = 0.12;
  double visual_e2_deg = 3;
  double visual_speed_weber = 0.08;
  // Proprioception: standard deviation and constant bias of the hand's place.
  double proprioceptive_sd_m = 0.010;
  double proprioceptive_bias_m = 0.015;
  // Touch.
  double force_weber = 0.09;
  double force_floor_N = 0.1;
  double force_direction_sd_deg = 22;
  double stiffness_weber = 0.15;
  // Hearing.
  double azimuth_sd_deg = 4;
  double elevation_factor = 2;
  double distance_weber = 0.3;
  double front_back_confusion = 0.05;
  // Warmth: heat flow into the finger.
  double thermal_weber = 0.43;
  // Prior probability that two cues have one cause.
  double common_cause = 0.5;
  // Diffusion that the player assumes for a place that moves at 1 m/s, m^2/s.
  double process_noise_m2_s = 1e-3;
  // Motor noise: a share of the command, and a constant part in N, both as the standard deviation of the mean over
  // 10 ms.
  double motor_noise_share = 0.10;
  double motor_noise_N = 0.06;
  // Arm: stiffness at rest, its rise with the load (N/m for each N), damping ratio, effective mass.
  double stiffness_N_m = 300;
  double stiffness_rise_1_m = 2;
  double damping_ratio = 0.4;
  double mass_kg = 1.2;
  // Preferred pace of an aimed movement, s for each bit of difficulty.
  double pace_s_bit = 0.200;
  // Cost of an error against the cost of time; 1 is the typical player.
  double caution = 1;
  // Believed delay above which the player moves, then waits for the picture.
  double wait_threshold_s = 0.55;
  // Probability that a percept is not attended.
  double lapse = 0.02;
  // Factor on the spread of a task's search.
  double search_spread = 1;
};

}  // namespace tactus::observer
