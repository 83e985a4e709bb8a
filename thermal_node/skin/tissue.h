// The layers of living tissue under a patch of skin, from the surface to the depth that heat of a touch does not
// reach.
#pragma once

#include <string>
#include <vector>

namespace tactus::thermal {

struct Layer {
  double thickness_m = 0;
  double conductivity_W_mK = 0;
  double density_kg_m3 = 0;
  double specific_heat_J_kgK = 0;
  bool perfused = false;  // by blood; the epidermis has no vessels
};

// Heat capacity of blood per volume, J/(m^3 K): 3600 J/(kg K) (doi 10.3390/cancers11081183, caption of table 1)
// times 1050 kg/m^3 (as muscle there).
inline constexpr double kBloodHeatCapacity_J_m3K = 1050 * 3600.0;

struct Tissue {
  std::vector<Layer> layers;  // surface first; the deepest end counts as insulated
  double rest_degC = 33;      // of the surface, untouched
  double room_degC = 23;
  double perfusion_1_s = 0.0025;  // blood flow per volume of the perfused layers
  double air_conductance_W_m2K = 8;
};

// "finger": the pad over the bone of the last phalanx, to the middle of the bone; "palm": the ball of the thumb,
// over muscle. Any other site gives no layer.
std::vector<Layer> layers_of(const std::string& site);

}  // namespace tactus::thermal
