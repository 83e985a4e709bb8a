// What crosses into the audio callback of two surfaces that slide or roll over each other: where on each, how fast
// and how hard.
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
  std::int64_t voice = -1;  // the same for the same body, as of a strike; -1: none
  Resonators resonators;
  PerMode gains{};  // of each mode at the place of the contact, Pa at 1 m per N s
  // Its modes above `beyond_Hz` are too many to render. Together they follow a force at once: pressure at 1 m, Pa
  // per N s a sample.
  float beyond = 0;
  double beyond_Hz = 0;
  // Nobody knows where on it the contact is: its surface adds nothing.
  bool known = false;
  // These two live while a scrape of this number is held; null: it has none.
  const ReliefLevels* relief = nullptr;
  const FrictionMap* friction = nullptr;
  BumpAxes axes;
  Eigen::Vector3d outward = Eigen::Vector3d::UnitZ();  // unit normal
  Roughness roughness;
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero(), velocity_m_s = Eigen::Vector3d::Zero();
  // Way of the contact over this surface per way of the sliding, and of the rolling: 0 .. 1 in size.
  Eigen::Vector3f slides = Eigen::Vector3f::Zero(), rolls = Eigen::Vector3f::Zero();
};

// At one instant. Given anew every tick; in between the places go on with their velocities.
struct Scrape {
  std::int64_t id = 0;      // of the contact
  std::int64_t number = 0;  // of all that crossed, from 0
  sync::HostTime at{};      // when that is to be heard
  bool ends = false;        // the contact slides and rolls no more: nothing but id and at counts
  // Force per unit of slope, N s a sample, scaled to full scale per Pa; of sliding where friction maps have the
  // factor 1.
  float slide = 0, roll = 0;
  double cutoff_Hz = 0;   // of what rolls, by the patch
  double over_s = 0.001;  // until it is told anew
  SourcePosition place;            // where it is heard from
  std::array<ScrapeSide, 2> sides;
};

}  // namespace tactus::audio
