// Measurements of the ears: direction, distance and time of a sound. Pure.
#pragma once

#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::observer {

// A place relative to the head: azimuth in degrees, 0 in front, positive to the left, -180 to 180; elevation in
// degrees, -90 to 90; distance in m.
struct SourcePlace {
  double azimuth_deg = 0, elevation_deg = 0, distance_m = 1;
};

// Standard deviation of the azimuth, degrees: it grows to 2.6 times the frontal value at the side (Blauert 1997,
// Spatial Hearing: 3.6 degrees in front, 9-10 at 90; unverified).
double azimuth_sd_deg(const PlayerParameters& player, double azimuth_deg);

// A source as heard. The elevation has a larger noise. A front-back confusion mirrors the azimuth. The distance
// follows k r^0.54 with k = 1.32 (Zahorik 2002, Journal of the Acoustical Society of America 111:1832;
// unverified): near sources seem farther, far ones nearer.
SourcePlace heard_place(const PlayerParameters& player, const SourcePlace& source, NoiseStream& noise);

// Posterior probability that a sound and a seen or felt impact are one event, from the difference of their times
// as perceived: the causal inference of cue_combination.h on the time axis. Standard deviations of the times: s.
// The times of unrelated events spread over 1 s (design).
double same_event_probability(const PlayerParameters& player, double difference_s, double sound_sd_s,
                              double other_sd_s);

}  // namespace tactus::observer
