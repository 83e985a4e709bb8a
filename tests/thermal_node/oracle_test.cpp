#include <catch2/catch.hpp>
#include <cmath>

#include "tests/thermal_node/support/finite_differences.h"
#include "tests/thermal_node/support/steady_contact.h"
#include "thermal_node/skin/bioheat_model.h"
#include "thermal_node/skin/contact_model.h"
#include "thermal_node/skin/skin_model.h"

using namespace tactus::thermal;
using oracle::FiniteDifferences;
using oracle::Slab;
using oracle::Touch;

namespace {

struct ReferenceMaterial {
  const char* name;
  double conductivity, density, specific_heat;
  double heat_capacity() const { return density * specific_heat; }
};
const ReferenceMaterial kReferenceMaterials[] = {{"copper", 401, 8933, 385},
                               {"steel", 60.5, 7850, 434},
                               {"granite", 2.79, 2630, 775},
                               {"oak", 0.16, 750, 1255},
                               {"foam", 0.026, 70, 1045}};
const double kTimes[] = {0.1, 1, 10};

// Deep enough that heat does not reach the end within 10 s: 20 sqrt(diffusivity t).
Slab deep(double conductivity, double heat_capacity) {
  return {20 * std::sqrt(conductivity / heat_capacity * 10), conductivity, heat_capacity};
}

}  // namespace

TEST_CASE("The oracle itself is within 1 mK of the closed form of two half-spaces") {
  for (const ReferenceMaterial& m : kReferenceMaterials) {
    const double h = contact_conductance_W_m2K(m.conductivity);
    const test::SteadyContact exact{effusivity(0.37, 1000, 3770), effusivity(m.conductivity, m.density, m.specific_heat),
                              h, 33, 23};
    FiniteDifferences truth({{deep(0.37, 3.77e6)}, deep(m.conductivity, m.heat_capacity()), h});
    for (const double t : kTimes) {
      truth.advance(t);
      INFO(m.name << " at " << t << " s");
      CHECK(truth.surface_degC() == Approx(exact.skin_surface_degC(t)).margin(1e-3));
    }
  }
}

TEST_CASE("Half-spaces with blood and air are within 10 mK of the oracle") {
  for (const ReferenceMaterial& m : kReferenceMaterials) {
    const double h = contact_conductance_W_m2K(m.conductivity);
    SkinModel skin(SkinProperties{});
    skin.set_object({23, effusivity(m.conductivity, m.density, m.specific_heat)});
    // In the form of its equations: temperatures relative to rest, blood at rest, no loss to the room from the
    // touched pad.
    Slab tissue = deep(0.37, 3.77e6);
    tissue.blood_W_m3K = 0.0025 * 3.77e6;
    FiniteDifferences truth({{tissue}, deep(m.conductivity, m.heat_capacity()), h});
    double now = 0;
    for (const double t : kTimes) {
      for (; now < t - 1e-9; now += 0.02) skin.step(0.02, h, 1);
      truth.advance(t);
      INFO(m.name << " at " << t << " s");
      CHECK(skin.surface_degC() == Approx(truth.surface_degC()).margin(0.01));
    }
  }
}

TEST_CASE("Tissue layers on objects of any thickness are within 10 mK of the oracle") {
  const char* site = GENERATE("finger", "palm");
  const double thickness = GENERATE(0.0005, 0.01, 1e9);
  const Tissue tissue{layers_of(site), 33, 23, 0.0025, 8};
  for (const ReferenceMaterial& m : kReferenceMaterials) {
    const double h = contact_conductance_W_m2K(m.conductivity);
    BioheatModel skin(tissue);
    skin.set_object({23, 0, m.conductivity, m.heat_capacity(), thickness});
    Touch touch{{}, deep(m.conductivity, m.heat_capacity()), h};
    for (const Layer& l : tissue.layers)
      touch.skin.push_back({l.thickness_m, l.conductivity_W_mK, l.density_kg_m3 * l.specific_heat_J_kgK,
                            l.perfused ? tissue.perfusion_1_s * kBloodHeatCapacity_J_m3K : 0});
    if (thickness < touch.object.thickness_m) touch.object.thickness_m = thickness, touch.object_air_W_m2K = 8;
    touch.blood_degC = skin.blood_degC();
    // Untouched skin loses heat to the room, touched skin does not.
    Touch bare = touch;
    bare.skin_air_W_m2K = 8;
    FiniteDifferences rest(bare), truth(touch);
    rest.begin_at_rest();
    CHECK(rest.surface_degC() == Approx(33).margin(2e-3));
    truth.begin_like(rest);
    double now = 0;
    for (const double t : kTimes) {
      for (; now < t - 1e-9; now += 0.02) skin.step(0.02, h, 1);
      truth.advance(t);
      INFO(site << ", " << thickness << " m of " << m.name << " at " << t << " s");
      CHECK(skin.surface_degC() == Approx(truth.surface_degC()).margin(0.01));
    }
  }
}
