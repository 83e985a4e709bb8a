// Time that nobody waits for: the programs of a cluster in one process, each with a stack of its own, and a clock that jumps
// from one deadline to the next. What they do is what they do live, for they are the same programs; with one seed it is the
// same to the bit.
//
//   sync::VirtualTime time({.seed = 1});
//   time.add("sim_node", [] { return sim::run({"sim_node", "--realtime", "off", "scene.sdf"}); });
//   time.add("haptic_node", ...);
//   time.run_for(sync::from_seconds(10));
//   time.end();
//
// While one exists, the clock, sleeping and the bus of every program that it runs are its own. It takes no time to compute:
// a turn is over at the instant at which it begins. One thread; not two of them in one process.
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
  std::uint64_t seed = 1;  // of identities, of the phases of loops and of what the wire does
  WirePlan wire{};
};

class VirtualTime {
 public:
  // A clock of a machine that has been up for a while: no time is near 0.
  static constexpr HostTime kBegin{std::chrono::seconds(1000)};

  // What its programs call their clock (header_t.clock).
  static constexpr std::int32_t kClock = 0x7ac7;

  // Throws std::logic_error when there is one already.
  explicit VirtualTime(const VirtualPlan& plan = {});
  // What still runs is unwound where it stands.
  ~VirtualTime();
  VirtualTime(const VirtualTime&) = delete;
  VirtualTime& operator=(const VirtualTime&) = delete;

  // The one that this process lives by; null: it lives by the machine's clock.
  static VirtualTime* current() { return current_; }

  // A program begins, within a millisecond of now: where in it is drawn, so that loops of one rate do not tick together. What
  // it throws is thrown by the call that ran it.
  void add(std::string name, std::function<int()> program);
  // Runs all programs for so long.
  void run_for(Nanoseconds span) { run_until(now_ + span); }
  void run_until(HostTime until);
  // Asks that program to leave, as SIGTERM does; or ends it where it is, as SIGKILL does. False: there is none, or it is the one that runs.
  bool ask_to_leave(std::string_view name);
  bool kill(std::string_view name);
  // Asks all to leave and runs them until they have, for so long at the most. Who has not by then is unwound.
  void end(Nanoseconds patience = std::chrono::seconds(5));
  // Of a program that has left: what it returned; -1: it runs.
  int result(std::string_view name) const;
  bool any() const;

  HostTime now() const { return now_; }
  VirtualWire& wire() { return wire_; }

  // For the program that runs.
  bool asked_to_leave() const;
  void sleep_until(HostTime t);
  // Until something arrives at that end, for so long at the most.
  void wait(VirtualEnd& end, Nanoseconds at_most);
  // The next of the numbers that the seed gives: for identities.
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
  std::uint64_t seed_, drawn_ = 0;
  VirtualWire wire_;
  std::vector<std::unique_ptr<Program>> programs_;
  Program* running_ = nullptr;
};

}  // namespace tactus::sync
