#include "audio_node/modal/finish.h"

#include <cmath>
#include <limits>

namespace tactus::audio {
namespace {

struct Finish {
  double youngs_modulus_Pa, density_kg_m3;  // from sim_node/scenes/materials.csv
  double height_m;
};

// Ra of the usual process by ISO 1302 grades. Normally distributed heights have an rms of 1.25 times that, which
// is within the range of these processes (a factor of four each).
constexpr Finish kFinishes[] = {
    {2.0e11, 7850, 1.6e-6},  // steel: N7, milled or drawn
    {7.0e10, 2700, 1.6e-6},  // aluminium: N7; also used for ceramic, which lies next to it: fired without glaze
    {1.2e11, 8933, 0.8e-6},  // copper: N6, rolled
    {6.2e10, 2600, 0.2e-6},  // glass: N4; float glass itself is smoother, dust and fingers are not
    {6.0e10, 2630, 6.3e-6},  // granite: N9, sawn
    {3.0e10, 2300, 25e-6},   // concrete: N11, off the form
    {1.1e10, 750, 6.3e-6},   // oak: planed wood has 3 to 10 um (design)
    {1.4e9, 1070, 0.8e-6},   // abs: N6, moulded
    {5.0e6, 1100, 3.2e-6},   // rubber: N8, moulded
    {2.0e7, 70, 50e-6},      // foam: open cells (design)
    {1.0e6, 180, 25e-6},     // felt: its fibres (design)
    {1.5e5, 1000, 20e-6},    // skin: 10 to 30 um (design)
};

}  // namespace

double finish_m(const Elastic& material) {
  double nearest = std::numeric_limits<double>::max(), height = kFinishes[0].height_m;
  for (const Finish& f : kFinishes) {
    const double away = std::hypot(std::log(material.youngs_modulus_Pa / f.youngs_modulus_Pa),
                                   std::log(material.density_kg_m3 / f.density_kg_m3));
    if (away < nearest) nearest = away, height = f.height_m;
  }
  return height;
}

}  // namespace tactus::audio
