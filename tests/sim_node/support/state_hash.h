// Hash of the result of a scene after a number of steps without a hand: every event, the contacts at the end, and
// pose and velocity of each body, bit-exact.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <vector>

#include "sim_node/world/engine.h"
#include "sim_node/world/simulation.h"
#include "sim_node/scene/load_sdf.h"
#include "sync/bus/identity.h"

namespace tactus::sim::test {

inline constexpr int kGoldenSteps = 500;

// overrides: "setting=value", as on a command line. Throws std::runtime_error with one sentence when the scene cannot
// be simulated with them.
inline std::uint64_t state_hash(const std::filesystem::path& scene, const std::vector<std::string>& overrides = {},
                                int steps = kGoldenSteps) {
  std::vector<std::string> warnings;
  const WorldDef world = load_sdf(scene.string(), warnings);
  Settings settings;
  settings.visual_thread = "none";  // in a thread of its own, a step may be late
  const auto errors = sync::apply_settings(settings, setting_fields(), "sim_node", world.settings, overrides);
  if (!errors.empty()) throw std::runtime_error(errors.front());
  if (const std::string error = apply_engine(settings); !error.empty()) throw std::runtime_error(error);
  std::uint64_t hash = sync::kFnv1aBegin;
  const auto add = [&](const void* data, std::size_t size) { hash = sync::fnv1a_64(hash, data, size); };
  const auto message = [&](const auto& m) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(m.getEncodedSize()));
    m.encode(bytes.data(), 0, m.getEncodedSize());
    add(bytes.data(), bytes.size());
  };
  Simulation simulation(world, settings);
  simulation.start(1);
  for (int i = 0; i < steps; ++i) {
    simulation.step({});
    for (const contact_event_t& e : simulation.events()) message(e);
  }
  std::vector<contact_t> contacts;
  simulation.body_contacts(contacts);
  for (const contact_t& c : contacts) message(c);
  for (const contact_t& c : simulation.tool_contacts()) message(c);
  for (const BodyMotion& m : simulation.bodies()) {
    add(m.position_m.data(), 3 * sizeof(double));
    add(m.orientation.coeffs().data(), 4 * sizeof(double));
    add(m.velocity_m_s.data(), 3 * sizeof(double));
    add(m.spin_rad_s.data(), 3 * sizeof(double));
  }
  return hash;
}

inline std::vector<std::filesystem::path> scenes_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".sdf") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace tactus::sim::test
