// One scene with one detector and one law of contact: cost of a step, depth and steadiness of contact, change of energy; and its log
// rendered by all modalities. Prints JSON; tests/measure/benchmark_simulation runs all pairings.
//
//    bin/simulation_bench SCENE.sdf [--detector ode] [--solver quick] [--seconds 3] [--log FILE]
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/presentation_t.hpp>

#include "sim_node/model/behaviour_model.h"
#include "sim_node/scene/load_sdf.h"
#include "sync/node/node_options.h"
#include "sync/text/settings.h"
#include "tests/bench/offline/offline_world.h"
#include "tests/bench/offline/log_renderers.h"
#include "tests/bench/offline/steadiness.h"
#include "tests/sim_node/support/penetration_oracle.h"
#include "tests/sync/support/memory_sink.h"

using namespace tactus;
using namespace tactus::bench;
using nlohmann::json;

namespace {

double quantile(std::vector<double> x, double q) {
  if (x.empty()) return 0;
  std::sort(x.begin(), x.end());
  return x[static_cast<std::size_t>(q * static_cast<double>(x.size() - 1))];
}

// Kinetic and potential energy in the middle of the previous step, because the velocities belong to that instant.
double energy_J(const sim::WorldDef& world, std::span<const sim::BodyMotion> bodies, double h) {
  double sum = 0;
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    const sim::BodyMotion& m = bodies[i];
    if (!m.moves()) continue;
    const double mass = 1 / m.inverse_mass_1_kg;
    const Eigen::Matrix3d inertia = m.inverse_inertia.inverse();
    sum += mass / 2 * m.velocity_m_s.squaredNorm() + m.spin_rad_s.dot(inertia * m.spin_rad_s) / 2;
    if (world.bodies[i].gravity) sum -= mass * world.gravity_m_s2.dot(m.centre_m - h / 2 * m.velocity_m_s);
  }
  return sum;
}

// Without hands: cost, depth, energy.
json without_hands(const sim::WorldDef& world, const sim::Settings& settings, double seconds) {
  OfflineWorld run(world, settings, false, nullptr);
  sim::test::PenetrationOracle oracle(world);
  const double h = settings.step_s;
  std::vector<double> us;
  std::vector<contact_t> list, ahead_contacts;
  double contacts = 0, deepest = 0, first = 0, min = 0, max = 0, gained = 0;
  const int steps = static_cast<int>(seconds / h);
  for (int i = 0; i < steps; ++i) {
    run.step();
    us.push_back(run.step_us());
    const auto bodies = run.simulation().bodies();
    run.simulation().body_contacts(list);
    contacts += static_cast<double>(list.size());
    if (const sim::LookAhead* look_ahead = run.simulation().look_ahead()) {
      if (look_ahead->fresh) look_ahead->contacts(ahead_contacts);
      contacts += static_cast<double>(ahead_contacts.size());
    }
    if (list.size() < 60 || i % 10 == 0) deepest = std::max(deepest, oracle.deepest(bodies).depth_m);
    const double energy = energy_J(world, bodies, h);
    if (i == 0) first = min = max = energy;
    min = std::min(min, energy), max = std::max(max, energy);
    gained = std::max(gained, energy - min);
  }
  return {
      {"contacts", contacts / steps},    {"step_us_p50", quantile(us, 0.5)}, {"step_us_p99", quantile(us, 0.99)},
      {"penetration_um", 1e6 * deepest}, {"energy_gained_J", gained},        {"energy_range_J", max - min},
      {"energy_first_J", first}};
}

json steadiness_json(const Steadiness& s) {
  return {{"windows", s.windows}, {"jitter", s.jitter}, {"gone", s.gone}, {"octaves", s.bands}};
}

json sense_json(const ModalityResult& r) {
  std::vector<double> late;
  for (const double e : r.error_s) late.push_back(1e3 * e);
  const double median = quantile(late, 0.5);
  std::vector<double> spread;
  for (const double e : late) spread.push_back(std::abs(e - median));
  return {{"expected", r.expected},
          {"presented", r.presented},
          {"error_ms_p50", median},
          {"error_ms_worst", quantile(late, 1)},
          {"error_ms_spread_p95", quantile(spread, 0.95)}};
}

int body_named(const sim::WorldDef& world, const std::string& model) {
  for (std::size_t i = 0; i < world.bodies.size(); ++i)
    if (world.bodies[i].name.rfind(model + "::", 0) == 0) return static_cast<int>(i);
  return -1;
}

// Includes the contacts of bodies that are published ahead, in the step in which they are published; the second list then holds their new contacts.
void body_contacts(sim::Simulation& simulation, std::vector<contact_t>& out, std::vector<contact_t>& ahead_contacts) {
  simulation.body_contacts(out);
  const sim::LookAhead* look_ahead = simulation.look_ahead();
  if (!look_ahead || !look_ahead->fresh) return;
  look_ahead->contacts(ahead_contacts);
  out.insert(out.end(), ahead_contacts.begin(), ahead_contacts.end());
}

using Series = std::map<std::pair<int, int>, std::vector<double>>;  // by pair of bodies: force of each step

// Extends a force series to step n: for at most `held` steps with its last value, the rest with zero.
void hold(std::vector<double>& force, std::size_t n, std::size_t held) {
  if (force.empty() || force.size() >= n || n - force.size() > held) return;
  force.resize(n, force.back());
}

// The closed forms of offline/bounce_and_rest.sdf.
constexpr double kG = 9.81, kFall_m = 0.3, kBounce = 0.8, kSlide_m_s = 2.5, kFriction = 0.4,
                 kLeastBounce_m_s = 0.3;

void set_initial_velocities(sim::WorldDef& world) {
  if (world.name != "bounce_and_rest") return;
  world.bodies[static_cast<std::size_t>(body_named(world, "sliding"))].velocity_m_s = {kSlide_m_s, 0, 0};
  world.bodies[static_cast<std::size_t>(body_named(world, "rolling"))].velocity_m_s = {0.4, 0, 0};
}

// Between body and floor, from one time to another: steadiness of its force, contacts that begin again, and hits.
json contact_of(const sim::WorldDef& world, const std::string& model, const Series& series,
                const Rendered& rendered, double h, double from_s, double to_s) {
  const int body = body_named(world, model), floor = body_named(world, "floor");
  const std::pair pair(std::min(body, floor), std::max(body, floor));
  std::vector<std::vector<double>> window(1);
  if (const auto s = series.find(pair); s != series.end())
    for (auto i = static_cast<std::size_t>(from_s / h);
         i < std::min(s->second.size(), static_cast<std::size_t>(to_s / h)); ++i)
      window[0].push_back(s->second[i]);
  json out = steadiness_json(steadiness(window, 1 / h, true));
  int begins = 0, hits = 0;
  for (const contact_event_t& e : rendered.events) {
    const double t = 1e-9 * static_cast<double>(e.time_ns);
    if (std::pair(e.body_a, e.body_b) != pair || t < from_s || t > to_s) continue;
    begins += e.kind == contact_event_t::BEGIN;
    hits += e.kind == contact_event_t::HIT;
  }
  out["begins_anew"] = begins;
  out["false_hits"] = hits;
  return out;
}

// True times of the ball's bounces, against the events and against the samples of their sounds.
json bounce_accuracy(const sim::WorldDef& world, const Rendered& rendered, double seconds) {
  const int body = body_named(world, "bouncing");
  std::vector<double> events, heard;
  std::vector<char> used(rendered.events.size());
  int truly = 0;
  double t = std::sqrt(2 * kFall_m / kG), v = kG * t, worst_event = 0, worst_heard = 0, first_heard = -1;
  for (; v > kLeastBounce_m_s && t < seconds - 0.1; v *= kBounce, t += 2 * v / kG, ++truly) {
    // The nearest hit of the ball within half a hop.
    double best = std::min(0.05, kBounce * v / kG);
    std::size_t found = rendered.events.size();
    for (std::size_t i = 0; i < rendered.events.size(); ++i) {
      const contact_event_t& e = rendered.events[i];
      if (used[i] || e.kind != contact_event_t::HIT || (e.body_a != body && e.body_b != body)) continue;
      const double off = std::abs(1e-9 * static_cast<double>(e.time_ns) - t);
      if (off < best) best = off, found = i;
    }
    if (found == rendered.events.size()) continue;
    used[found] = true;
    events.push_back(best);
    worst_event = std::max(worst_event, best);
    if (const auto at = rendered.onset_s.find(rendered.events[found].event_id); at != rendered.onset_s.end()) {
      heard.push_back(std::abs(at->second - t));
      worst_heard = std::max(worst_heard, heard.back());
      if (truly == 0) first_heard = heard.back();
    }
  }
  return {{"truly", truly},
          {"events", events.size()},
          {"heard", heard.size()},
          {"first_heard_error_ms", 1e3 * first_heard},
          {"event_error_ms_p50", 1e3 * quantile(events, 0.5)},
          {"event_error_ms_worst", 1e3 * worst_event},
          {"heard_error_ms_p50", 1e3 * quantile(heard, 0.5)},
          {"heard_error_ms_worst", 1e3 * worst_heard}};
}

// With hands: forces, events, and the log rendered by all modalities.
json rendered_by_all(const sim::WorldDef& world, const sim::Settings& settings, double seconds,
                     const std::string& file) {
  const auto bytes = std::make_shared<sync::MemorySink::State>();
  OfflineWorld run(world, settings, true, std::make_unique<sync::MemorySink>(bytes));
  const double h = settings.step_s;
  const int steps = static_cast<int>(seconds / h);
  // Two groups publish contacts with each visual step; in between their forces hold.
  const auto held =
      static_cast<std::size_t>(settings.groups == "dual" ? std::ceil(1 / (settings.visual_rate_Hz * h)) : 0);
  Series series;
  std::vector<std::vector<double>> hands(run.hand_forces_N().size());
  std::vector<contact_t> list, ahead_contacts;
  for (int i = 0; i < steps; ++i) {
    run.step();
    body_contacts(run.simulation(), list, ahead_contacts);
    for (const contact_t& c : list) {
      auto& s = series[{c.body_a, c.body_b}];
      hold(s, static_cast<std::size_t>(i), held);
      s.resize(static_cast<std::size_t>(i) + 1, 0.0);
      s.back() += static_cast<double>(c.normal_force_N);
    }
    for (std::size_t k = 0; k < hands.size(); ++k) hands[k].push_back(run.hand_forces_N()[k].norm());
  }
  for (auto& [pair, s] : series) {
    hold(s, static_cast<std::size_t>(steps), held);
    s.resize(static_cast<std::size_t>(steps), 0.0);
  }
  run.finish();
  if (!file.empty()) sync::FileSink(file).append(bytes->bytes);
  const Rendered rendered = render_log(run.scene(), bytes->bytes);

  std::vector<std::vector<double>> all;
  for (const auto& [pair, s] : series) all.push_back(s);
  // A contact that begins again within 20 ms of its end counts as interrupted.
  int begins = 0, restarted = 0;
  std::map<std::pair<int, int>, std::int64_t> ended;
  for (const contact_event_t& e : rendered.events) {
    const std::pair pair(e.body_a, e.body_b);
    if (e.kind == contact_event_t::END) ended[pair] = e.time_ns;
    if (e.kind != contact_event_t::BEGIN) continue;
    ++begins;
    restarted += ended.count(pair) && e.time_ns - ended[pair] < 20'000'000;
  }
  ModalityResult touch;
  std::map<std::int64_t, double> when;
  for (const contact_event_t& e : rendered.events) {
    when[e.event_id] = 1e-9 * static_cast<double>(e.time_ns);
    touch.expected += e.tool >= 0 && e.kind == contact_event_t::BEGIN;
  }
  for (const presentation_t& r : run.felt()) {
    if (r.part != presentation_t::CONSTRAINT || r.presented_ns < 0 || !when.count(r.event_id)) continue;
    ++touch.presented;
    touch.error_s.push_back(1e-9 * static_cast<double>(r.presented_ns - kWorldBegins_ns) - when[r.event_id]);
  }
  json out = {{"force_between_bodies", steadiness_json(steadiness(all, 1 / h))},
              {"force_on_hand", steadiness_json(steadiness(hands, 1 / h))},
              {"events", rendered.events.size()},
              {"begins", begins},
              {"begins_anew", restarted},
              {"haptic", sense_json(touch)},
              {"audio", sense_json(rendered.audio)},
              {"visual", sense_json(rendered.visual)},
              {"thermal", sense_json(rendered.thermal)}};
  if (world.name == "bounce_and_rest") {
    const double stops_s = kSlide_m_s / (kFriction * kG);
    const auto& block = run.simulation().bodies()[static_cast<std::size_t>(body_named(world, "sliding"))];
    const double slid = block.position_m.x() + 0.8, truly = kSlide_m_s * kSlide_m_s / (2 * kFriction * kG);
    out["bounce"] = bounce_accuracy(world, rendered, seconds);
    out["rest"] = contact_of(world, "resting", series, rendered, h, 0.5, seconds);
    out["slide"] = contact_of(world, "sliding", series, rendered, h, 0.1, stops_s - 0.03);
    out["slide"]["distance_error_percent"] = 100 * (slid / truly - 1);
    out["roll"] = contact_of(world, "rolling", series, rendered, h, 0.2, seconds);
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  tactus::sync::Arguments app("One scene, one detector, one law of contact, rendered by all senses; prints JSON");
  std::string scene, detector = "ode", solver = "quick", log;
  double seconds = 3;
  std::vector<std::string> set;
  app.add_option("SCENE", scene, "SDF file").required().existing_file();
  app.add_option("--detector", detector).show_default();
  app.add_option("--solver", solver).show_default();
  app.add_option("--seconds", seconds, "of the world, with hands and without").range(1.0, 600.0);
  app.add_option("--set", set, "name=value, settings of sim_node");
  app.add_option("--log", log, "writes the log of the run with hands here");
  tactus::sync::parse_or_exit(app, "simulation_bench", argc, argv);

  json out = {{"scene", scene}, {"detector", detector}, {"solver", solver}, {"seconds", seconds}};
  try {
    std::vector<std::string> warnings;
    sim::WorldDef world = sim::load_sdf(scene, warnings);
    set_initial_velocities(world);
    set.push_back("detector=" + detector);
    set.push_back("solver=" + solver);
    sim::Settings settings;
    const auto refused = sync::apply_settings(settings, sim::setting_fields(), "sim_node", world.settings, set);
    if (!refused.empty()) throw std::runtime_error(refused.front());
    out.update(without_hands(world, settings, seconds));
    out.update(rendered_by_all(world, settings, seconds, log));
  } catch (const std::exception& e) {
    out["refused"] = e.what();
  }
  std::cout << out.dump() << std::endl;
}
