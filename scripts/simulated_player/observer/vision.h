// Measurements of the eyes: place, depth, speed and visibility. Pure.
#pragma once

#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::observer {

// Standard deviation of a seen place across the line of sight, m, at this distance of the eye, when the gaze is
// `off_gaze_m` beside it: sd (1 + E/E2). Unverified: the typical 0.12 degrees.
double seen_sd_m(const PlayerParameters& player, double viewing_m, double off_gaze_m);

// Standard deviation of the seen distance of a thing from a target at the gaze, m. It is finer than a direction:
// one sixth of its noise at the gaze (0.02 degrees, between vernier acuity and direction; design), and it doubles
// 0.7 degrees beside it (Levi, Klein and Aitsebaomo 1985, Vision Research 25:963; the number is unverified).
double seen_gap_sd_m(const PlayerParameters& player, double viewing_m, double gap_m);

// Standard deviation of the seen depth of a thing in reach, m: 7.5 mm with two eyes, 30 mm with one (unverified).
double seen_depth_sd_m(bool two_eyes);

// A speed as seen, m/s, with its Weber fraction.
double seen_speed_m_s(const PlayerParameters& player, double speed_m_s, NoiseStream& noise);

// Probability that a thing in a picture is noticed: logistic in the logarithms of its visible area and of its
// contrast, one half at 4 pixels with full contrast and at a contrast of 0.03 with a large area (design). Give the
// area that the picture shows, not that of the scene: an occluded thing has area 0 and is never noticed.
double detection_probability(double visible_px, double contrast);

// Standard deviation of one estimate whose difference at 75 % correct between two intervals is this share of the
// value: w / (0.6745 sqrt 2).
double weber_sd(double weber);

}  // namespace tactus::observer
