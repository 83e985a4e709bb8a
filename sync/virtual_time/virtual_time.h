// Virtual time: runs the programs of a cluster in one process, each on its own stack, with a clock that jumps from one
// deadline to the next. The programs are the live ones, unchanged; the same seed gives the same result, to the bit.
//
//   sync::VirtualTime time({.seed = 1});
//   time.add("sim_node", [] { return sim::run({"sim_node", "--realtime", "off", "scene.sdf"}); });
//   time.add("haptic_node", ...);
//   time.run_for(sync::from_seconds(10));
//   time.end();
//
// While an instance exists, it replaces the clock, sleeping and the bus of every program that it runs. Computation takes no
// virtual time: a tick ends at the instant at which it begins. Single-threaded; at most one instance in a process.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sync/time/time.h"
#include "sync/virtual_time/virtual_wire.h"

namespace tactus::sync {

struct VirtualPlan {
  std::uint64_t seed = 1;  // of identities, of the phases of loops and of the wire
  WirePlan wire{};
};

class VirtualTime {
 public:
  // The clock of a machine that has been up for a while: no time is near 0.
  static constexpr HostTime kBegin{std::chrono::seconds(1000)};

  // header_t.clock of its programs.
  static constexpr std::int32_t kClock = 0x7ac7;

  // Throws std::logic_error when an instance exists already.
  explicit VirtualTime(const VirtualPlan& plan = {});
  // Programs that still run are unwound.
  ~VirtualTime();
  VirtualTime(const VirtualTime&) = delete;
  VirtualTime& operator=(const VirtualTime&) = delete;

  // The instance of this process; null: the process uses the machine's clock.
  static VirtualTime* current() { return current_; }

  // Starts a program within a millisecond of now. The start within it is random, so that loops of one rate do not tick
  // together. An exception of the program is rethrown by the call that ran it.
  void add(std::string name, std::function<int()> program);
  // Runs all programs for this time.
  void run_for(Nanoseconds span) { run_until(now_ + span); }
  void run_until(HostTime until);
  // Asks that program to end, as SIGTERM does. False: there is none.
  bool request_stop(std::string_view name);
  // Stops that program until then, as SIGSTOP and SIGCONT do: no deadline and no message wakes it. False: there is none.
  bool freeze(std::string_view name, HostTime until);
  // Asks all programs to end and runs them until they have, at most for this time. Programs still running at the timeout are
  // unwound.
  void end(Nanoseconds timeout = std::chrono::seconds(5));
  // The return value of a program that has ended; -1: it runs.
  int result(std::string_view name) const;
  bool any() const;

  HostTime now() const { return now_; }
  VirtualWire& wire() { return wire_; }

  // For the running program.
  bool stop_requested() const;
  void sleep_until(HostTime t);
  // Waits until a message arrives at that end, at most this time.
  void wait(VirtualEnd& end, Nanoseconds max_wait);
  // The next random number of the seed, for identities.
  std::uint64_t random();

 private:
  struct Program;
  HostTime wakes(const Program& program) const;
  void resume(Program& program);
  void yield();
  void unwind(Program& program);
  Program* find(std::string_view name) const;

  static VirtualTime* current_;
  HostTime now_ = kBegin;
  std::uint64_t seed_, draw_count_ = 0;
  VirtualWire wire_;
  std::vector<std::unique_ptr<Program>> programs_;
  Program* running_ = nullptr;
};

}  // namespace tactus::sync
