// One failure of a part of a cluster at a random moment, for a random time, and the requirements on the outputs meanwhile and after.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/cluster/cluster_record.h"
#include "tests/bench/cluster/virtual_cluster.h"

namespace tactus::bench {

constexpr double kNotAffected = -1;

// A part that fails, and the times after which its effects must have ended, s.
struct FailingPart {
  const char* name;    // of a program that is stopped, or of a channel whose messages are lost
  bool channel;
  double command_s;    // DEVICE_FORCE is zero after this time
  double exerted_s;    // the force of the driver is zero after this time
  double neutral_s;    // THERMAL_STATE returns to neutral from this time on
  double plate_s;      // the plate returns to neutral from this time on
  bool silences;       // no new sound begins
};

// Design: the promises of docs/safety.md. haptic_node: stale_after 50 ms (touch models), device_stale_after 50 ms, then fade
// 20 ms; a command to a driver is valid for 20 ms, then its guard fades within 20 ms. thermal_node: contacts are stale after
// 50 ms, displays and commands after 0.3 s. A tick of each program on the way is added.
inline constexpr double kStale_s = 0.073, kDeviceLost_s = 0.073, kCommandOver_s = 0.043;
inline constexpr double kContactsStale_s = 0.09, kDisplaySilent_s = 0.36;
// clang-format off
inline constexpr FailingPart kFailingParts[] = {
    // name             channel command         exerted         neutral           plate             silences
    {"sim_node",        false, kStale_s,        kStale_s,       kContactsStale_s, kNotAffected,     true},
    {"haptic_node",     false, kNotAffected,    kCommandOver_s, kNotAffected,     kNotAffected,     false},
    {"arm_driver",      false, kDeviceLost_s,   kNotAffected,   kNotAffected,     kNotAffected,     false},
    {"audio_node",      false, kNotAffected,    kNotAffected,   kNotAffected,     kNotAffected,     false},
    {"thermal_node",    false, kNotAffected,    kNotAffected,   kNotAffected,     kDisplaySilent_s, false},
    {"thermal_device",  false, kNotAffected,    kNotAffected,   kDisplaySilent_s, kNotAffected,     false},
    {"visual_node",     false, kNotAffected,    kNotAffected,   kNotAffected,     kNotAffected,     false},
    {"sync_node",       false, kNotAffected,    kNotAffected,   kNotAffected,     kNotAffected,     false},
    {"TOUCH_MODEL",     true,  kStale_s,        kStale_s,       kNotAffected,     kNotAffected,     false},
    {"CONTACT_EVENTS",  true,  kNotAffected,    kNotAffected,   kNotAffected,     kNotAffected,     false},
    {"CONTACTS",        true,  kNotAffected,    kNotAffected,   kContactsStale_s, kNotAffected,     false},
    {"WORLD_STATE",     true,  kNotAffected,    kNotAffected,   kNotAffected,     kNotAffected,     false},
    {"TOOL_STATE",      true,  kNotAffected,    kNotAffected,   kNotAffected,     kNotAffected,     false},
    {"DEVICE_STATE",    true,  kDeviceLost_s,   kDeviceLost_s,  kNotAffected,     kNotAffected,     false},
    {"DEVICE_FORCE",    true,  kNotAffected,    kCommandOver_s, kNotAffected,     kNotAffected,     false},
    {"THERMAL_STATE",   true,  kNotAffected,    kNotAffected,   kNotAffected,     kDisplaySilent_s, false},
    {"THERMAL_DEVICE",  true,  kNotAffected,    kNotAffected,   kDisplaySilent_s, kNotAffected,     false},
    {"PLAYOUT",         true,  kNotAffected,    kNotAffected,   kNotAffected,     kNotAffected,     false},
    {"NODE_HEALTH",     true,  kNotAffected,    kNotAffected,   kNotAffected,     kNotAffected,     false},
    {"CLOCK_MAP",       true,  kNotAffected,    kNotAffected,   kNotAffected,     kNotAffected,     false},
};
// clang-format on

// When a part failed and when it continued.
struct FailureTime {
  sync::HostTime begin, end;
  std::string gaps;  // outputs of the others that paused, in words
};

// The worst figures of the failures of one part.
struct FailureResult {
  int failures = 0;
  double longest_s = 0;
  double remaining_N = 0;      // largest force that remained after the promised time
  double beyond_fade_N = 0;    // largest force beyond the fade of the return
  double longest_return_s = 0;  // until the hand felt a force again
  double from_neutral_K = 0;   // largest distance from the way to neutral
  double louder = 0;           // largest sample of a silenced part beyond the ones before
  std::vector<std::string> faults;
};

// The outputs during and after one failure, against the promises. Adds to the result.
void judge(const FailingPart& part, const FailureTime& at, const ClusterRecord& record, FailureResult& result);
// That no sound begins while the part does not run.
void judge_sound(const FailureTime& at, const ClusterRecord& record, const Sound& sound, FailureResult& result);

}  // namespace tactus::bench
