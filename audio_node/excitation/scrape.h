// Message to the audio callback about two surfaces that slide or roll over each other: place on each, speed and
// force.
#pragma once

#include <array>
#include <cstdint>

#include "audio_node/spatial/source_position.h"
#include "audio_node/excitation/relief_levels.h"
#include "audio_node/excitation/roughness.h"
#include "audio_node/excitation/strike.h"
#include "lcmtypes/friction_map.h"
#include "sync/time/time.h"

namespace tactus::audio {

inline constexpr int kMaxScrapes = 16;  // that sound at a time; others are silent

// One of the two bodies. Vectors are in its frame.
struct ScrapeSide {
  std::int64_t voice = -1;  // the same for the same body, as for strikes; -1: none
  Resonators resonators;
  PerMode gains{};  // of each mode at the place of the contact, Pa at 1 m per N s
  // The modes above `residual_Hz` are too numerous to render one by one. Together they follow a force immediately:
  // pressure at 1 m, Pa per N s a sample.
  float residual_gain = 0;
  double residual_Hz = 0;
  // False: the place of the contact on it is not known, and its surface adds nothing.
  bool known = false;
  // Both remain valid while a scrape of this number is held; null: none.
  const ReliefLevels* relief = nullptr;
  const FrictionMap* friction = nullptr;
  BumpAxes axes;
  Eigen::Vector3d outward = Eigen::Vector3d::UnitZ();  // unit normal
  Roughness roughness;
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero(), velocity_m_s = Eigen::Vector3d::Zero();
  // Motion of the contact over this surface per unit of sliding, and of rolling: 0 .. 1 in size.
  Eigen::Vector3f slide_vector = Eigen::Vector3f::Zero(), roll_vector = Eigen::Vector3f::Zero();
};

// State at one instant, sent every tick; between ticks the places continue with their velocities.
struct Scrape {
  std::int64_t id = 0;      // of the contact
  std::int64_t number = 0;  // sequence number of all sent scrapes, from 0
  sync::HostTime at{};      // presentation time
  bool ends = false;        // the contact no longer slides or rolls: only id and at are valid
  // Force per unit of slope, N s a sample, scaled to full scale per Pa; for sliding, where friction maps have the
  // factor 1.
  float slide = 0, roll = 0;
  double cutoff_Hz = 0;   // of rolling, by the patch
  double update_interval_s = 0.001;  // time until the next update
  SourcePosition place;            // position of the source
  std::array<ScrapeSide, 2> sides;
};

}  // namespace tactus::audio
