#include "tests/bench/cluster/hostile_row.h"

#include <malloc.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tactus/device_force_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <vector>

#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "tests/bench/cluster/virtual_cluster.h"
#include "tests/sync/support/temporary_folder.h"

namespace tactus::bench {
namespace {

using namespace std::chrono_literals;

constexpr double kFelt_N = 0.3;
// After the last hostile message: 0.3 s for a successor, 2.5 s for the scene of another sender, a lift of the hand.
constexpr sync::Nanoseconds kReturn = 4s;
// Bounded memories fill in the first quarter; later growth has no bound. Messages that wait for their time vary by some hundred kB, so
// medians of whole quarters are compared. In 90,000 ticks of a row a leak of 6 bytes a tick passes this limit.
constexpr double kMaxGrowth_kB = 256;
constexpr int kMemorySamples = 1024;  // of each row

const std::map<std::string, unsigned, std::less<>> kOutputOf{
    {channels::kTouchModel, kWorld}, {channels::kContactEvents, kWorld}, {channels::kContacts, kWorld},     {channels::kWorldState, kWorld},
    {channels::kToolState, kTouch},  {channels::kDeviceForce, kTouch},   {channels::kDeviceState, kTouch}, {channels::kThermalState, kWarmth},
    {channels::kThermalDevice, kWarmth}};

// Allocated memory of this process, kB.
double allocated_kB() {
  const auto info = mallinfo2();
  return 1e-3 * static_cast<double>(info.uordblks + info.hblkhd);
}

// Growth of memory from the second quarter of its samples to the last one: the difference of their medians.
double growth(const std::vector<double>& samples) {
  const auto median_of_quarter = [&](std::size_t quarter) {
    const auto at = [&](std::size_t q) { return samples.begin() + static_cast<std::ptrdiff_t>(q * samples.size() / 4); };
    std::vector<double> part(at(quarter), at(quarter + 1));
    const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    std::nth_element(part.begin(), middle, part.end());
    return *middle;
  };
  return median_of_quarter(3) - median_of_quarter(1);
}

std::vector<std::string> channels_except(const std::vector<std::string>& except) {
  std::vector<std::string> names;
  for (const HostileChannel& c : hostile_channels())
    if (std::find(except.begin(), except.end(), c.name) == except.end()) names.push_back(c.name);
  return names;
}

// The genuine outputs of the cluster: their hashes and their limits.
class Outputs {
 public:
  void add(const ArmTick& tick) {
    force.add(tick);
    if (examples::size(tick.exerted.force) > kFelt_N) felt = tick.time;
  }
  void add(sync::HostTime time, std::string_view channel, std::span<const std::uint8_t> data) {
    if (const auto output = kOutputOf.find(channel); output != kOutputOf.end() && hashing) {
      auto& hash = hashes.try_emplace(output->second, static_cast<std::int64_t>(sync::kFnv1aBegin)).first->second;
      hash = static_cast<std::int64_t>(sync::fnv1a_64(static_cast<std::uint64_t>(hash), data.data(), data.size()));
    }
    if (channel == channels::kThermalState)
      if (const auto m = sync::decode<thermal_state_t>(data.data(), data.size())) commanded.add(time, m->commanded_degC);
    if (channel == channels::kThermalDevice)
      if (const auto m = sync::decode<thermal_device_t>(data.data(), data.size())) plate.add(time, m->plate_degC);
    if (channel == channels::kDeviceForce)
      if (const auto m = sync::decode<device_force_t>(data.data(), data.size()))
        commanded_N = std::max(commanded_N, examples::size({m->force_N.x, m->force_N.y, m->force_N.z}));
  }

  ForceAccount force;
  HeatAccount commanded, plate{kPlateOvershoot_K};
  Hashes hashes;
  double commanded_N = 0;
  bool hashing = true;
  sync::HostTime felt{};
};

void add_fault(std::string& faults, const std::string& what, const std::string& fault) {
  if (!fault.empty()) faults += (faults.empty() ? "" : "; ") + what + ": " + fault;
}

// Sends one message on each channel of the row in each millisecond. Alone: loses all others of these channels until the next.
class Attacker {
 public:
  // current: refers to it as long as it exists.
  Attacker(const HostileRow& row, sync::VirtualTime& time, unsigned seed, Attacker*& current)
      : current_(current), time_(time), end_(time.wire().join()), source_(row.kind, VirtualCluster::kRun, sync::VirtualTime::kClock, seed),
        alone_(row.alone) {
    for (const std::string& name : row.channels) channels_.push_back(&hostile_channel(name));
    current_ = this;
  }
  ~Attacker() { current_ = nullptr; }
  Attacker(const Attacker&) = delete;
  Attacker& operator=(const Attacker&) = delete;

  bool sending() const { return sending_; }
  void observe(std::string_view channel, std::span<const std::uint8_t> data) { source_.observe(channel, data); }
  void attack() {
    sending_ = true;
    for (const HostileChannel* channel : channels_) {
      if (alone_) time_.wire().block(channel->name, time_.now());
      const Bytes bytes = source_.next(*channel, sync::to_ns(time_.now()));
      for (std::size_t side : {0u, 1u}) time_.wire().send(*end_, side, channel->name, bytes, time_.now());
      if (alone_) time_.wire().block(channel->name, time_.now() + 1ms);
      ++sent_;
    }
    sending_ = false;
  }
  std::int64_t sent() const { return sent_; }

 private:
  Attacker*& current_;
  sync::VirtualTime& time_;
  std::unique_ptr<sync::VirtualEnd> end_;
  HostileSource source_;
  bool alone_;
  std::vector<const HostileChannel*> channels_;
  bool sending_ = false;
  std::int64_t sent_ = 0;
};

}  // namespace

std::vector<HostileRow> hostile_rows() {
  const std::vector<std::string> simulation{channels::kTouchModel, channels::kContactEvents, channels::kContacts, channels::kWorldState,
                                            channels::kGameState, channels::kSceneManifest, channels::kAssetChunk};
  const std::vector<std::string> display{channels::kThermalState, channels::kThermalDevice};
  const std::vector<std::string> device{channels::kDeviceState, channels::kDeviceForce};
  // Channels that command something; every process of the run may use them.
  const std::vector<std::string> control{channels::kDegradation, channels::kPlayout, channels::kPlayoutRequest, channels::kSetting,
                                         channels::kSimCommand, channels::kNodeHealth, channels::kClockMap};
  std::vector<std::string> outputs = simulation;
  outputs.insert(outputs.end(), display.begin(), display.end());
  outputs.insert(outputs.end(), device.begin(), device.end());
  outputs.push_back(channels::kToolState);
  std::vector<std::string> commanding = outputs;
  commanding.insert(commanding.end(), control.begin(), control.end());
  std::vector<std::string> simulation_and_tool = simulation;
  simulation_and_tool.push_back(channels::kToolState);
  const std::vector<std::string> all = channels_except({});
  return {
      {"malformed, all channels", all, Hostility::kMalformed, kAllOutputs},
      {"another run, all but the device", channels_except({channels::kDeviceState}), Hostility::kOtherRun, kAllOutputs},
      {"second simulation, second hand", simulation_and_tool, Hostility::kSecondSender, kAllOutputs},
      {"second display", display, Hostility::kSecondSender, kWorld | kTouch | kSound},
      {"second driver", device, Hostility::kSecondSender},
      {"reports and questions", channels_except(commanding), Hostility::kSecondSender, kAllOutputs},
      {"forged display", display, Hostility::kForged, kWorld | kTouch | kSound},
      {"forged, all outputs", outputs, Hostility::kForged},
      {"commands of the run", control, Hostility::kSecondSender, 0, false},
      {"alone: another sender, all channels", all, Hostility::kSecondSender, 0, false, true},
      {"alone: forged, all outputs", outputs, Hostility::kForged, 0, true, true},
  };
}

HostileResult run_row(const HostileRow& row, int milliseconds, unsigned seed, bool hostile) {
  const sync::TemporaryFolder folder;
  Outputs outputs;
  HostileResult result;
  Attacker* attacker = nullptr;
  {
    VirtualCluster cluster(
        folder.path, seed, [&](const ArmTick& tick) { outputs.add(tick); },
        [&](sync::HostTime t, std::string_view channel, std::span<const std::uint8_t> data) {
          if (attacker && attacker->sending()) return;
          outputs.add(t, channel, data);
          if (attacker) attacker->observe(channel, data);
        });
    sync::VirtualTime& time = cluster.time();
    std::optional<Attacker> owned;
    if (hostile) owned.emplace(row, time, seed, attacker);
    std::vector<double> memory_kB;
    memory_kB.reserve(2 * kMemorySamples);
    const int between = std::max(1, milliseconds / kMemorySamples);
    for (int ms = 0; ms < milliseconds; ++ms) {
      if (ms % between == 0) memory_kB.push_back(allocated_kB());
      if (attacker) attacker->attack();
      time.run_for(1ms);
    }
    result.growth_kB = growth(memory_kB);
    outputs.hashing = false;
    time.run_for(kReturn);
    if (hostile && row.returns && outputs.felt < time.now() - 1s) add_fault(result.faults, "touch", "the force does not return");
    for (const char* program : VirtualCluster::kPrograms)
      if (time.result(program) != -1) add_fault(result.faults, program, "has ended");
    result.messages = attacker ? attacker->sent() : 0;
  }
  const Sound sound = read_sound(folder.path / "audio.wav");
  result.ticks = milliseconds;
  result.hashes = outputs.hashes;
  result.hashes[kSound] = sync::fnv1a_64(sound.samples.data(), sound.samples.size() * sizeof(float));
  result.peak_N = std::max(outputs.force.peak_N(), outputs.commanded_N);
  result.dose_s = outputs.plate.dose_s(), result.cold_s = outputs.plate.cold_s();
  const SafeLimits limits;
  if (outputs.commanded_N > limits.force_N + 1e-5) add_fault(result.faults, "DEVICE_FORCE", std::to_string(outputs.commanded_N) + " N");
  add_fault(result.faults, "hand", outputs.force.faults());
  add_fault(result.faults, "commanded temperature", outputs.commanded.faults());
  add_fault(result.faults, "plate", outputs.plate.faults());
  add_fault(result.faults, "sound", faults_of(sound));
  if (hostile && result.growth_kB > kMaxGrowth_kB) add_fault(result.faults, "memory", "grows by " + std::to_string(result.growth_kB) + " kB");
  return result;
}

}  // namespace tactus::bench
