#include "sync/node/node.h"

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <utility>
#include <tactus/input_health_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_values_t.hpp>

#include "lcmtypes/utf8.h"
#include "sync/bus/bus_arguments.h"
#include "sync/degradation/measured_effect.h"
#include "sync/degradation/profile_exchange.h"
#include "sync/bus/health_inputs.h"
#include "sync/bus/kernel_drops.h"
#include "sync/bus/receive_buffer.h"
#include "sync/text/error_text.h"
#include "sync/text/printable.h"
#include "sync/virtual_time/virtual_time.h"

namespace tactus::sync {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void request_stop(int) { stop_requested = true; }

void catch_signals() {
  // A signal that the caller ignores stays ignored: Ctrl-C in a background job of a script.
  for (const int number : {SIGTERM, SIGINT}) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = request_stop;
    sigaction(number, &action, nullptr);
  }
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);  // beyond the limit of file sizes a write fails, as on a full disk, and is reported
}

Realtime parse_realtime(const std::string& text) {
  return text == "require" ? Realtime::kRequire : text == "off" ? Realtime::kOff : Realtime::kTry;
}

std::string enter(const NodeDescriptor& d, const NodeOptions& o) {
  if (o.check) std::exit(0);
  if (VirtualTime::current()) return "virtual time";
  catch_signals();
  // Linux rounds the timers of normal threads up by 50 us by default.
  prctl(PR_SET_TIMERSLACK, 1000);
  return set_realtime(parse_realtime(o.realtime), d.fifo_priority);
}

NodeOptions with_profile(NodeOptions o) {
  if (!o.degrade.empty()) o.profile = read_profile_file(o.degrade);
  return o;
}

std::int32_t saturated(std::int64_t n) { return static_cast<std::int32_t>(std::min<std::int64_t>(n, INT32_MAX)); }

constexpr Nanoseconds kReportPeriod{100'000'000};
constexpr Nanoseconds kRateWindow{1'000'000'000};
constexpr std::size_t kMaxTagRequests = 64;
// A note may quote text from the bus; a report with a note of this length still fits a datagram.
constexpr std::size_t kMaxNote = 140;

}  // namespace

void NodeOptions::add_to(Arguments& app, const NodeDescriptor& d) {
  name = d.name;
  app.description(d.about);
  add_bus_options(app, bus);
  app.add_option("--run-id", run_id, "number of the cluster run, the same for all its nodes")
      .environment("TACTUS_RUN_ID")
      .positive()
      .show_default();
  app.add_option("--name", name, "name of this process on the bus").show_default();
  app.add_option("--realtime", realtime, "real-time priority: require, try or off")
      .one_of({"require", "try", "off"})
      .show_default();
  app.add_option("--out", out, "folder for what this node writes").existing_folder().show_default();
  app.add_option("--seed", seed, "seed of all random numbers").show_default();
  app.add_option("--set", set, "name=value of a setting, see docs/settings.md; may be repeated");
  if (!d.modality.empty() || d.name == "sync_node")
    app.add_option("--degrade", degrade, "degradation profile (XML): the intended degradations of each sense, and of each stage of touch");
  // For measurements only, hence not in --help: a renderer that uses up its core.
  app.add_option("--emulate-load", load).environment("TACTUS_LOAD_" + d.name).range(0.0, 100.0).hidden();
  app.add_flag("--check", check, "checks options and files, then exits without joining the bus");
}

void parse_or_exit(Arguments& app, const std::string& node, int argc, char** argv) {
  try {
    const std::optional<std::string> help = app.parse(argc, argv);
    if (!help) return;
    std::cout << *help;
    std::exit(0);
  } catch (const ArgumentError& e) {
    std::cerr << node << ": " << e.what() << "; see " << node << " --help\n";
    std::exit(1);
  }
}

int fail(const std::string& node, const std::exception& e) {
  const std::string message = error_text(e);
  std::cerr << (message.starts_with(node) ? "" : node + ": ") << printable(message) << "\n";
  return 1;
}

void check_folder_of(const std::string& path, const std::string& option) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) != 0)
    throw std::runtime_error("cannot write " + path + " (" + std::strerror(errno) + "); choose another " + option);
}

void check_node_files(const NodeOptions& options) { with_profile(options); }

Node::Node(NodeDescriptor descriptor, NodeOptions options)
    : descriptor_(std::move(descriptor)),
      options_(with_profile(std::move(options))),
      scheduling_(enter(descriptor_, options_)),
      bus_(Identity::fresh(options_.name, options_.run_id), options_.bus),
      loop_(descriptor_.rate_Hz),
      tags_(options_.name, options_.run_id),
      tag_requests_(channels::kTagRequest, kMaxTagRequests) {
  if (!descriptor_.opens_sockets && !options_.bus.memory && !VirtualTime::current()) drop_receive_buffer_right();
  bus_.track_clocks();
  bus_.attach(tag_requests_);
  tag_work();
  health_.tool = -1;
  health_.nominal_rate_Hz = descriptor_.rate_Hz;
  rate_since_ = tick_begin_ = next_report_ = host_now();
  std::cerr << options_.name << ": " << descriptor_.rate_Hz << " Hz, " << scheduling_ << ", "
            << (VirtualTime::current() ? "a bus of this process" : lcm_url(options_.bus, options_.bus.port)) << std::endl;
}

Node::~Node() = default;

bool Node::running() const {
  const VirtualTime* const time = VirtualTime::current();
  return !stop_requested && !(time && time->stop_requested());
}

void Node::set_rate(double rate_Hz) {
  loop_.set_rate(rate_Hz);
  health_.nominal_rate_Hz = rate_Hz;
}

void Node::set_state(std::int8_t state, std::string status_text) {
  health_.state = state;
  status_text_ = std::move(status_text);
}

void Node::begin_incarnation() {
  bus_.begin_incarnation();
  ticks_before_ = event_ticks_ > 0 ? event_ticks_ : loop_.deadlines().ticks();
  missed_before_ = loop_.deadlines().missed();
  tick_ = wake_ = Histogram();
  health_.stale_ticks = health_.contacts_rendered = 0;
  rate_since_ = host_now();
  ticks_at_rate_since_ = 0;
}

void Node::override_ticks(std::int64_t ticks, std::int64_t missed, double rate_Hz) {
  overridden_ = true;
  health_.ticks = ticks;
  health_.missed_ticks = missed;
  health_.nominal_rate_Hz = rate_Hz;
}

void Node::tag_work() {
  tags_.add("work", "us", &work_us_);
  std::vector<Phase> phases = descriptor_.phases;
  phases.insert(phases.end(), {Phase::kDecode, Phase::kOther});
  for (const Phase phase : phases) tags_.add(std::string("work.") + name(phase), "us", phases_.us_pointer(phase));
}

void Node::serve_tags(HostTime now) {
  while (const auto m = tag_requests_.pop()) tags_.push(m->message, now);
  tags_.step(now);
  while (tag_list_t* m = tags_.next_list()) bus_.publish(channels::kTagList, *m);
  while (tag_values_t* m = tags_.next_values()) bus_.publish(channels::kTagValues, *m);
}

void Node::begin_tick(HostTime now) {
  tick_begin_ = now;
  phases_.begin(tags_.requested());
  const ScopedPhaseTimer decoding(Phase::kDecode);
  bus_.drain(now);
}

void Node::end_tick(HostTime now) {
  phases_.end();
  work_us_ = static_cast<double>((now - tick_begin_).count()) / 1000;
  serve_tags(now);
  tick_.add(now - tick_begin_);
  if (health_.state == node_health_t::STALE || health_.state == node_health_t::INPUT_LOST) ++health_.stale_ticks;
  if (VirtualTime::current() || (!priority_.demoted() && !is_realtime())) return;
  const PriorityKeeper::Change change = priority_.tick(tick_begin_, now);
  if (change == PriorityKeeper::Change::kLeave) {
    leave_realtime();
    scheduling_ = "demoted to normal scheduling: used more than 80 % of its time for 100 ms";
    std::cerr << options_.name << ": " << scheduling_ << std::endl;
  } else if (change == PriorityKeeper::Change::kReturn) {
    scheduling_ = set_realtime(Realtime::kTry, descriptor_.fifo_priority) + " again, after a demotion";
    std::cerr << options_.name << ": " << scheduling_ << std::endl;
  }
}

HostTime Node::wait() {
  const HostTime end = host_now();
  end_tick(end);
  if (end >= next_report_) report(end);
  const HostTime now = loop_.wait();
  wake_.add(loop_.wake_lateness());
  begin_tick(now);
  if (options_.load > 0)
    for (const auto wasted = from_seconds(options_.load / loop_.deadlines().rate_Hz()); host_now() - now < wasted;) continue;
  return now;
}

HostTime Node::poll() {
  const HostTime now = host_now();
  const ScopedPhaseTimer decoding(Phase::kDecode);
  bus_.drain(now);
  return now;
}

HostTime Node::wait_for_event() {
  const HostTime end = host_now();
  end_tick(end);
  if (end >= next_report_) report(end);
  bus_.wait(from_seconds(1 / loop_.deadlines().rate_Hz()));
  ++event_ticks_;
  begin_tick(host_now());
  return tick_begin_;
}

node_health_t Node::health_message(HostTime now) {
  node_health_t m = health_;
  m.header.sim_time_ns = -1;
  m.node = options_.name;
  m.modality = descriptor_.modality;
  m.expected_events = descriptor_.expected_events | (descriptor_.late_rule == LateRule::kAlwaysApply ? node_health_t::OTHERS_DO_NOT_WAIT : 0);
  m.status_text = status_text_.empty() ? scheduling_ : status_text_ + "; " + scheduling_;
  if (m.status_text.size() > kMaxNote) m.status_text = std::string(first_bytes(m.status_text, kMaxNote - 3)) + "...";
  if (!profile_effect_.empty()) m.status_text += std::string(kEffectPrefix) + profile_effect_;
  m.tick = tick_.to_message();
  m.wake = wake_.to_message();
  std::int64_t forgotten = 0;
  const auto list = [&](const InputCount& c) {
    input_health_t in{};
    in.channel = c.channel;
    const InputAge age = age_of(c, bus_.clocks(), now);
    in.age_ns = age.age.count();
    in.uncertainty_ns = static_cast<std::int32_t>(age.uncertainty.count());  // at most ClockMaps::kMaxUncertainty
    in.messages = c.sequence.messages();
    in.gaps = saturated(c.sequence.gaps() + c.dropped);
    in.bad = saturated(c.bad);
    add_input(m, in);
    forgotten += c.sequence.forgotten();
  };
  // Required inputs come first: they are listed even where room is short.
  const auto needed = [&](const InputCount& c) {
    return std::find(descriptor_.inputs.begin(), descriptor_.inputs.end(), c.channel) != descriptor_.inputs.end();
  };
  for (const bool first : {true, false})
    for (const auto& inbox : bus_.inboxes())
      if (needed(inbox->count()) == first) list(inbox->count());
  m.foreign_control = bus_.clocks().maps->foreign();
  if (forgotten > 0) m.status_text += "; " + std::to_string(forgotten) + " senders too many";
  fit(m, channels::kMaxMessageBytes);
  return m;
}

void Node::report(HostTime now) {
  next_report_ += kReportPeriod;
  if (next_report_ <= now) next_report_ = now + kReportPeriod;  // after a stall one report, not two in a row
  if (!overridden_) {
    health_.ticks = (event_ticks_ > 0 ? event_ticks_ : loop_.deadlines().ticks()) - ticks_before_;
    health_.missed_ticks = loop_.deadlines().missed() - missed_before_;
  }
  if (now - rate_since_ >= kRateWindow) {
    health_.rate_Hz = static_cast<double>(health_.ticks - ticks_at_rate_since_) / to_seconds(now - rate_since_);
    rate_since_ = now;
    ticks_at_rate_since_ = health_.ticks;
  }
  if (reports_++ % 10 == 0) health_.kernel_drops = VirtualTime::current() ? 0 : kernel_drops();
  node_health_t m = health_message(now);
  bus_.publish(channels::kNodeHealth, m);
}

}  // namespace tactus::sync
