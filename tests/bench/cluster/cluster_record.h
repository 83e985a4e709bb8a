// Outputs of a VirtualCluster over time, as messages on its bus and as the force that the driver of the device exerts. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/cluster/arm_driver.h"
#include "tests/bench/cluster/output_limits.h"

namespace tactus::bench {

struct TimedValue {
  sync::HostTime time;
  double value = 0;
};
using Series = std::vector<TimedValue>;
// The values with from < time <= to.
std::span<const TimedValue> between(const Series& series, sync::HostTime from, sync::HostTime to);
// Their largest value; 0: none.
double largest(const Series& series, sync::HostTime from, sync::HostTime to);

class ClusterRecord {
 public:
  void add(const ArmTick& tick);
  // Every message of the cluster when it is sent.
  void add(sync::HostTime time, std::string_view channel, std::span<const std::uint8_t> data);

  // Starts a new measurement of the gaps between messages.
  void reset_gaps(sync::HostTime now);
  // The outputs whose messages were further apart than two of their periods since reset_gaps(), in words; empty: none.
  // except: a program whose outputs do not count.
  std::string long_gaps(sync::HostTime now, std::string_view except) const;

  const Series& exerted_N() const { return exerted_N_; }        // by the driver, after its guard
  const Series& commanded_N() const { return commanded_N_; }    // DEVICE_FORCE
  const Series& command_degC() const { return command_degC_; }  // THERMAL_STATE
  const Series& plate_degC() const { return plate_degC_; }      // THERMAL_DEVICE
  const ForceAccount& force() const { return force_; }
  const HeatAccount& commanded_heat() const { return commanded_heat_; }
  const HeatAccount& plate_heat() const { return plate_heat_; }
  // Time of the first sample of the sound file; 0: not known yet.
  sync::HostTime sound_start() const { return sound_start_; }

 private:
  struct Gap {
    sync::HostTime last{};
    sync::Nanoseconds longest{0};
  };
  void record_gap(const std::string& name, sync::HostTime time);

  Series exerted_N_, commanded_N_, command_degC_, plate_degC_;
  ForceAccount force_;
  HeatAccount commanded_heat_, plate_heat_{kPlateOvershoot_K};
  sync::HostTime sound_start_{};
  std::map<std::string, Gap> gaps_;  // by output, see kOutputs
};

}  // namespace tactus::bench
