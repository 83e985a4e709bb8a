// A hand that touches in manual ticks, for tests of the thermal renderer.
#pragma once

#include <cstdint>
#include <tactus/material_def_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <utility>
#include <vector>

#include "thermal_node/rendering/renderer.h"

namespace tactus::thermal {

inline constexpr sync::Nanoseconds kTick{20'000'000};
inline constexpr std::int64_t kMs = 1'000'000;

inline material_def_t material(double k, double rho, double c, double degC) {
  material_def_t m{};
  m.conductivity_W_mK = k;
  m.density_kg_m3 = rho;
  m.specific_heat_J_kgK = c;
  m.temperature_degC = degC;
  m.youngs_modulus_Pa = 1e9;
  return m;
}

inline const std::vector<material_def_t> kMaterials{material(401, 8960, 385, 23), material(0.18, 1050, 1400, 23),
                                                    material(401, 8960, 385, 1000)};
enum { kCopper, kPlastic, kFurnace };

inline Settings with_model(const char* model) {
  Settings settings;
  settings.model = model;
  return settings;
}

// The plate at the temperature of the skin itself, so that the effect of lag and limits is visible.
inline Settings bare() {
  Settings settings;
  settings.display = "skin";
  return settings;
}

// Fills a tick with a touch of one body, whose id is that of its material.
inline void touch(Tick& tick, int material, double force_N, double area_m2 = 1e-4,
                  sync::Nanoseconds contact = kTick) {
  const double share = sync::to_seconds(contact) / sync::to_seconds(kTick);
  tick.contact.contact_time = contact;
  tick.contact.force_N = force_N * share;
  tick.contact.area_m2 = area_m2 * share;
  tick.contact.material = tick.contact.body = material;
  tick.contact.parts = {{material, material, contact, tick.contact.force_N, tick.contact.area_m2}};
}

struct Hand {
  explicit Hand(std::vector<material_def_t> materials = kMaterials, const Settings& settings = {})
      : renderer(settings, std::move(materials), 0, 9) {}

  Tick next(sync::Nanoseconds length = kTick) {
    Tick tick;
    tick.begin = now;
    tick.end = now += length;
    tick.sim_begin = sync::sim_time(sync::to_ns(tick.begin));
    tick.sim_end = sync::sim_time(sync::to_ns(tick.end));
    tick.contact_interval = length;
    tick.contact.status = sync::SampleStatus::kExact;
    return tick;
  }
  thermal_state_t rest(int ticks = 1) {
    thermal_state_t state{};
    for (int i = 0; i < ticks; ++i) state = renderer.step(next());
    return state;
  }
  // In coarse ticks of half a second.
  thermal_state_t rest_long(double seconds) {
    thermal_state_t state{};
    for (int i = 0; i < 2 * seconds; ++i)
      state = renderer.step(next(sync::Nanoseconds(500'000'000)), {.longest_substep_s = 0.1});
    return state;
  }
  thermal_state_t press(int material, double force_N, int ticks = 1, sync::Nanoseconds contact = kTick) {
    thermal_state_t state{};
    for (int i = 0; i < ticks; ++i) {
      Tick tick = next();
      touch(tick, material, force_N, 1e-4, contact);
      state = renderer.step(tick);
    }
    return state;
  }

  sync::HostTime now = sync::host_time(1'000'000'000);
  Renderer renderer;
};

}  // namespace tactus::thermal
