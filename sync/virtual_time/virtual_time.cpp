#include "sync/virtual_time/virtual_time.h"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "sync/random/keyed_random.h"
#include "sync/virtual_time/stack_switch.h"

namespace tactus::sync {
namespace {

// The mains hold tables of a few hundred kB on the stack; untouched pages cost nothing.
constexpr std::size_t kStack = 8 << 20;
constexpr Nanoseconds kPhases{1'000'000};
// Random streams of one seed.
constexpr std::uint64_t kOfWire = 1, kOfPrograms = 2;

}  // namespace

struct VirtualTime::Program {
  std::string name;
  std::unique_ptr<StackSwitch> stack;
  HostTime wakes{}, frozen_until{};
  VirtualEnd* waits_for = nullptr;
  bool stop_requested = false, killed = false, begun = false, over = false;
  int result = -1;
  std::exception_ptr error;
};

namespace {

// Thrown at a waiting point of a program that must end. Not a std::exception, so that no program catches it as one of its
// own.
struct Killed {};

}  // namespace

VirtualTime* VirtualTime::current_ = nullptr;

VirtualTime::VirtualTime(const VirtualPlan& plan)
    : seed_(mixed(plan.seed, kOfPrograms)), wire_(plan.wire, mixed(plan.seed, kOfWire)) {
  if (current_) throw std::logic_error("this process already runs in another virtual time");
  current_ = this;
}

VirtualTime::~VirtualTime() {
  for (const auto& program : programs_) unwind(*program);
  programs_.clear();
  current_ = nullptr;
}

std::uint64_t VirtualTime::random() { return mixed(seed_, ++draw_count_); }

void VirtualTime::add(std::string name, std::function<int()> body) {
  auto program = std::make_unique<Program>();
  program->name = std::move(name);
  program->wakes = now_ + Nanoseconds(static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(kPhases.count())));
  program->stack = std::make_unique<StackSwitch>(kStack, [p = program.get(), body = std::move(body)] {
    try {
      p->result = body();
    } catch (const Killed&) {
    } catch (...) {
      p->error = std::current_exception();
    }
    p->over = true;
  });
  programs_.push_back(std::move(program));
}

HostTime VirtualTime::wakes(const Program& program) const {
  if (program.over) return HostTime::max();
  const HostTime due =
      program.waits_for ? std::min(program.wakes, std::max(now_, program.waits_for->next_arrival())) : program.wakes;
  return std::max(due, program.frozen_until);
}

void VirtualTime::run_until(HostTime until) {
  while (!programs_.empty()) {
    Program* next = nullptr;
    for (const auto& program : programs_)  // of those that wake together, the one that was added first
      if (!next || wakes(*program) < wakes(*next)) next = program.get();
    if (wakes(*next) > until) break;
    now_ = std::max(now_, wakes(*next));
    resume(*next);
  }
  now_ = std::max(now_, until);
}

void VirtualTime::resume(Program& program) {
  Program* const before = std::exchange(running_, &program);
  program.waits_for = nullptr;
  program.begun = true;
  program.stack->resume();
  running_ = before;
  if (program.error) std::rethrow_exception(std::exchange(program.error, nullptr));
}

void VirtualTime::yield() {
  Program& program = *running_;
  program.stack->yield();
  if (program.killed) throw Killed{};
}

void VirtualTime::sleep_until(HostTime t) {
  if (!running_) throw std::logic_error("only a program of the virtual time may sleep in it");
  running_->wakes = std::max(t, now_);
  yield();
}

void VirtualTime::wait(VirtualEnd& end, Nanoseconds max_wait) {
  if (!running_) throw std::logic_error("only a program of the virtual time may wait in it");
  running_->wakes = now_ + max_wait;
  running_->waits_for = &end;
  yield();
}

// A main that catches all exceptions waits again, and gets the exception again.
void VirtualTime::unwind(Program& program) {
  program.killed = true;
  while (program.begun && !program.over) resume(program);
}

VirtualTime::Program* VirtualTime::find(std::string_view name) const {
  const auto at = std::find_if(programs_.begin(), programs_.end(), [&](const auto& p) { return p->name == name; });
  return at == programs_.end() ? nullptr : at->get();
}

bool VirtualTime::stop_requested() const { return running_ && running_->stop_requested; }

bool VirtualTime::request_stop(std::string_view name) {
  Program* program = find(name);
  if (program) program->stop_requested = true;
  return program != nullptr;
}

bool VirtualTime::freeze(std::string_view name, HostTime until) {
  Program* program = find(name);
  if (program) program->frozen_until = until;
  return program != nullptr;
}

int VirtualTime::result(std::string_view name) const {
  const Program* program = find(name);
  return program && program->over ? program->result : -1;
}

bool VirtualTime::any() const {
  return std::any_of(programs_.begin(), programs_.end(), [](const auto& p) { return !p->over; });
}

void VirtualTime::end(Nanoseconds timeout) {
  for (const auto& program : programs_) program->stop_requested = true;
  const HostTime until = now_ + timeout;
  while (any() && now_ < until) run_for(std::min<Nanoseconds>(until - now_, std::chrono::milliseconds(100)));
  for (const auto& program : programs_) unwind(*program);
}

}  // namespace tactus::sync
