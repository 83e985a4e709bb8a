// A finger on a thermal display, tick by tick, compared with the same finger on the material itself.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/thermal_node/support/hand.h"
#include "thermal_node/skin/bioheat_model.h"
#include "thermal_node/skin/contact_model.h"
#include "thermal_node/display/plate_controller.h"
#include "thermal_node/skin/skin_model.h"

namespace tactus::thermal::bench {

struct Material {
  std::string name;
  double conductivity_W_mK, density_kg_m3, specific_heat_J_kgK, degC = 23;
  double heat_capacity() const { return density_kg_m3 * specific_heat_J_kgK; }
  double effusivity_() const { return effusivity(conductivity_W_mK, density_kg_m3, specific_heat_J_kgK); }
  ObjectProperties object() const { return {degC, effusivity_(), conductivity_W_mK, heat_capacity()}; }
};

inline std::unique_ptr<Skin> skin_of(const std::string& model) {
  if (model == "bioheat") return std::make_unique<BioheatModel>(Tissue{layers_of("finger"), 33, 23, 0.0025, 8});
  return std::make_unique<SkinModel>(SkinProperties{});
}

// Skin temperature at each tick of 20 ms, degC.
using Trace = std::vector<double>;

// On the material itself.
inline Trace touching(const Material& m, const std::string& person, double seconds) {
  const auto skin = skin_of(person);
  skin->set_object(m.object());
  Trace trace{skin->surface_degC()};
  for (double t = 0.02; t < seconds + 1e-9; t += 0.02) {
    skin->step(0.02, contact_conductance_W_m2K(m.conductivity_W_mK), 1);
    trace.push_back(skin->surface_degC());
  }
  return trace;
}

enum class Drive { kPassive, kSkin, kFlux };

// On the display that renders the material with `model`. The plate, the person and the controller run at 1 kHz. The controller uses the
// thermal load that thermal_node estimates; the plate carries the load of the person.
inline Trace display(const Material& m, const std::string& model, const std::string& person, Drive drive,
                     double seconds) {
  Settings settings = with_model(model.c_str());
  settings.display = drive == Drive::kSkin ? "skin" : "flux";
  Hand hand({material(m.conductivity_W_mK, m.density_kg_m3, m.specific_heat_J_kgK, m.degC)}, settings);
  PlateController controller(PeltierPlant{}, PlateLimits{});
  const PeltierPlant plant;
  PeltierState plate{33, 23};
  const auto finger = skin_of(person);
  const double conductance = contact_conductance_W_m2K(settings.plate_conductivity_W_mK);
  double command = 33;
  Trace trace;
  // Two seconds to come to rest on the plate, then the touch.
  for (int tick = -100; tick <= static_cast<int>(seconds / 0.02 + 0.5); ++tick) {
    double sum = 0, current = 0;
    for (int ms = 0; ms < 20; ++ms) {
      current =
          drive == Drive::kPassive ? 0 : controller.step(plate, command, hand.renderer.load_W(), 0.001).current_A;
      plate = step(plant, plate, current, finger->heat_flux_W_m2() * settings.reference_area_m2, 0.001);
      if (drive == Drive::kPassive) plate = {33, 33};  // a plate held at neutral temperature, without a drive
      finger->set_object({plate.plate_degC, 1e9, 1e6, 1e12});
      finger->step(0.001, conductance, 0, 0.001);
      sum += plate.plate_degC / 20;
    }
    if (tick >= 0) trace.push_back(finger->surface_degC());
    Tick next = hand.next();
    if (tick >= 0) {
      touch(next, 0, settings.reference_force_N, settings.reference_area_m2);
    }
    command = hand.renderer.step(next, {.plate = PlateReading{sum, plate.sink_degC, current}}).commanded_degC;
  }
  return trace;
}

}  // namespace tactus::thermal::bench
