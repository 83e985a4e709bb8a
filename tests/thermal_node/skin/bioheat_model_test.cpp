#include "thermal_node/skin/bioheat_model.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/thermal_node/support/steady_contact.h"
#include "thermal_node/skin/contact_model.h"

using namespace tactus::thermal;

namespace {

constexpr double kSkinEffusivity = 1181.0588469674;  // sqrt(0.37 * 1000 * 3770)

struct Material {
  const char* name;
  double conductivity, density, specific_heat;
  ObjectProperties object(double degC, double thickness_m = 1e9) const {
    return {degC, effusivity(conductivity, density, specific_heat), conductivity, density * specific_heat,
            thickness_m};
  }
};
// Incropera and DeWitt, tables A.1 and A.3, as in sim_node/scenes/materials.csv.
const Material kCopper{"copper", 401, 8933, 385}, kSteel{"steel", 60.5, 7850, 434},
    kGlass{"glass", 1.4, 2600, 750}, kOak{"oak", 0.16, 750, 1255}, kFoam{"foam", 0.026, 70, 1045};

// The skin of Ho and Jones, with the given depth, without blood and air unless they are given.
Tissue plain(double depth_m, double perfusion_1_s = 0, double air_W_m2K = 0) {
  return {{{depth_m, 0.37, 1000, 3770, perfusion_1_s > 0}}, 33, 23, perfusion_1_s, air_W_m2K};
}
Tissue living(const char* site) { return {layers_of(site), 33, 23, 0.0025, 8}; }

// nth root of x tan x = biot: between (n - 1) pi and (n - 1/2) pi.
double slab_root(int n, double biot) {
  double low = (n - 1) * M_PI + 1e-12, high = (n - 0.5) * M_PI - 1e-12;
  for (int i = 0; i < 100; ++i) {
    const double x = (low + high) / 2;
    (x * std::sin(x) - biot * std::cos(x)) * std::cos((n - 1) * M_PI) < 0 ? low = x : high = x;
  }
  return (low + high) / 2;
}

// Surface of a slab, insulated at the back, that begins at 1 and meets 0 through a conductance: Carslaw and Jaeger
// 1959, section 3.11. fourier: diffusivity t/depth^2.
double slab_surface(double biot, double fourier) {
  double sum = 0;
  for (int n = 1; n < 400; ++n) {
    const double z = slab_root(n, biot);
    sum += 4 * std::sin(z) / (2 * z + std::sin(2 * z)) * std::exp(-z * z * fourier) * std::cos(z);
  }
  return sum;
}

}  // namespace

TEST_CASE("Deep plain skin on a deep object follows the closed form of two half-spaces from 20 ms to 100 s") {
  // The bound of skin_model_test.cpp: 0.5 % of the change, derived there; heat does not cross 0.5 m in 100 s.
  for (const Material& m : {kCopper, kSteel, kGlass, kOak, kFoam}) {
    const double h = contact_conductance_W_m2K(m.conductivity);
    const test::SteadyContact exact{kSkinEffusivity, m.object(23).effusivity, h, 33, 23};
    BioheatModel skin(plain(0.5));
    skin.set_object(m.object(23));
    for (int tick = 1; tick <= 5000; ++tick) {
      skin.step(0.02, h, 1);
      const double t = 0.02 * tick;
      INFO(m.name << " at " << t << " s");
      REQUIRE(skin.surface_degC() - 33 == Approx(exact.skin_surface_degC(t) - 33).epsilon(0.005));
      if (tick >= 3) REQUIRE(skin.heat_flux_W_m2() == Approx(exact.heat_flux_W_m2(t - 0.0025)).epsilon(0.01));
    }
  }
}

TEST_CASE("Skin of finite depth cools by the series for a slab") {
  // Against an object that skin cannot warm, through 1000 W/(m^2 K). Grid and time as above: 0.5 % of the change.
  const double depth = 0.004, h = 1000, diffusivity = 0.37 / (1000.0 * 3770);
  BioheatModel skin(plain(depth));
  skin.set_object({23, 1e9, 1e6, 1e12, 1e9});
  for (int tick = 1; tick <= 10000; ++tick) {
    skin.step(0.02, h, 1);
    if (tick != 1 && tick != 5 && tick % 500) continue;
    const double t = 0.02 * tick;
    INFO("at " << t << " s");
    const double left = slab_surface(h * depth / 0.37, diffusivity * t / (depth * depth));
    CHECK(skin.surface_degC() == Approx(23 + 10 * left).margin(0.005 * 10 * (1 - left)));
  }
}

TEST_CASE("Skin and a finite object without losses reach the mean temperature weighted by heat capacity") {
  Material m = GENERATE(kCopper, kGlass, kFoam);
  const double thickness = 0.003, depth = 0.004;
  BioheatModel skin(plain(depth));
  skin.set_object(m.object(13, thickness));
  skin.step(3 * 3600, 1000, 1, 1);
  const double warm = depth * 1000 * 3770, cold = thickness * m.density * m.specific_heat;
  CHECK(skin.surface_degC() == Approx((33 * warm + 13 * cold) / (warm + cold)).margin(1e-6));
}

TEST_CASE("The profile of resting skin is the steady solution of Pennes' equation") {
  // T_a - T = (T_a - T_s) cosh(m (L - x))/cosh(m L), m^2 = w rho c of blood/k; the heat that leaves the surface is
  // lost to the room. The volumes are of second order: 0.1 % of the difference to the blood at the surface, and
  // 0.5 % in the deepest cells, of at most 1.2 mm.
  const double depth = 0.01, perfusion = GENERATE(0.0005, 0.0025, 0.02), air = 8;
  const BioheatModel skin(plain(depth, perfusion, air));
  const double m = std::sqrt(perfusion * kBloodHeatCapacity_J_m3K / 0.37);
  const double warmer = air * (33 - 23) / (0.37 * m * std::tanh(m * depth));
  CHECK(skin.blood_degC() - 33 == Approx(warmer).epsilon(1e-3));
  const auto expected_degC = [&](double x) {
    return skin.blood_degC() - warmer * std::cosh(m * (depth - x)) / std::cosh(m * depth);
  };
  CHECK(skin.surface_degC() == Approx(expected_degC(0)).margin(5e-3 * warmer));
  std::array<double, 200> widths_m;
  const std::size_t cells =
      growing_widths(depth, Mesh{}.first_cell * std::sqrt(0.37 / 3.77e6), Mesh{}.growth, widths_m);
  REQUIRE(cells == skin.columns().skin_cells());
  double top_m = 0;
  for (std::size_t i = 0; i < cells; ++i) {
    CHECK(skin.columns().skin(i) == Approx(expected_degC(top_m + widths_m[i] / 2)).margin(5e-3 * warmer));
    top_m += widths_m[i];
  }
}

TEST_CASE("Untouched skin stays at rest and returns to it") {
  const char* site = GENERATE("finger", "palm");
  BioheatModel skin(living(site));
  // The hand is cooler than the core, and so is its blood (Pennes 1948 measured arteries of the arm below 37
  // degC).
  CHECK(skin.blood_degC() > 33);
  CHECK(skin.blood_degC() < 37.5);
  for (int i = 0; i < 1000; ++i) skin.step(0.02, 0, 0);
  CHECK(skin.surface_degC() == Approx(33).margin(1e-9));
  skin.set_object(kCopper.object(23));
  skin.step(10, 1870, 1);
  CHECK(skin.surface_degC() < 28);
  skin.step(6 * 3600, 0, 0, 20);
  CHECK(skin.surface_degC() == Approx(33).margin(1e-3));
  skin.step(10, 1870, 1);
  skin.reset();
  CHECK(skin.surface_degC() == Approx(33).margin(1e-9));
}

TEST_CASE("Heat is conserved between skin, object, blood and room") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 20; ++trial) {
    BioheatModel skin(living(trial % 2 ? "finger" : "palm"));
    skin.set_object({-20 + 100 * uniform(random), 0, std::pow(10, -2 + 5 * uniform(random)),
                     std::pow(10, 4 + 3 * uniform(random)), std::pow(10, -5 + 6 * uniform(random))});
    double skin_J = skin.columns().skin_energy(), object_J = skin.columns().objects_energy(), moved = 0;
    const double all = std::abs(skin_J) + std::abs(object_J);
    for (int i = 0; i < 100; ++i) {
      skin.step(std::pow(10, -4 + 5 * uniform(random)), uniform(random) < 0.3 ? 0 : 3000 * uniform(random),
                uniform(random));
      const auto& f = skin.columns().flows();
      skin_J += f.blood_to_skin - f.skin_to_objects - f.skin_to_room;
      object_J += f.skin_to_objects - f.objects_to_room;
      moved += std::abs(f.skin_to_objects);
    }
    REQUIRE(moved > 0);
    // Rounding of sums of about 1e7 J/m^2 over at most 1e5 substeps.
    CHECK(skin.columns().skin_energy() == Approx(skin_J).margin(1e-9 * all));
    CHECK(skin.columns().objects_energy() == Approx(object_J).margin(1e-9 * all));
  }
}

TEST_CASE("The error is of second order in the substep") {
  // After a smooth beginning: from 0.1 s after the touch on.
  const auto after = [](double substep_s) {
    BioheatModel skin(living("finger"));
    skin.set_object(kGlass.object(23, 0.005));
    skin.step(0.1, 1500, 1, 1e-4);
    skin.step(0.4, 1500, 1, substep_s);
    return skin.surface_degC();
  };
  const double exact = after(1e-4);
  const double coarse = std::abs(after(0.1) - exact), fine = std::abs(after(0.05) - exact);
  CHECK(std::log2(coarse / fine) > 1.7);
  CHECK(std::log2(fine / std::abs(after(0.025) - exact)) > 1.7);
}

TEST_CASE("The error is of second order in the grid") {
  const double h = contact_conductance_W_m2K(1.4);
  const test::SteadyContact exact{kSkinEffusivity, kGlass.object(23).effusivity, h, 33, 23};
  const auto error = [&](const Mesh& mesh) {
    BioheatModel skin(plain(0.2), mesh);
    skin.set_object(kGlass.object(23));
    skin.step(1, h, 1, 2e-4);
    return std::abs(skin.surface_degC() - exact.skin_surface_degC(1));
  };
  // Halved everywhere: twice the number of cells of half the width, growing by the root.
  const double coarse = error({0.08, 1.4}), fine = error({0.04, std::sqrt(1.4)});
  CHECK(std::log2(coarse / fine) > 1.7);
}

TEST_CASE("The skin stays within the range of its initial, blood, room and object temperatures") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    BioheatModel skin(living("finger"));
    double low = 23, high = skin.blood_degC();
    for (int i = 0; i < 60; ++i) {
      if (i % 10 == 0) {
        const double object = -100 + 1200 * uniform(random);
        low = std::min(low, object), high = std::max(high, object);
        skin.set_object({object, 0, std::pow(10, -2 + 5 * uniform(random)), std::pow(10, 4 + 3 * uniform(random)),
                         std::pow(10, -5 + 6 * uniform(random))});
      }
      skin.step(std::pow(10, -5 + 6 * uniform(random)),
                uniform(random) < 0.3 ? 0 : std::pow(10, 6 * uniform(random)), uniform(random));
      // An L-stable method of second order may overshoot a jump by a small part of it.
      const double slack = 0.05 * (high - low);
      REQUIRE(skin.surface_degC() >= low - slack);
      REQUIRE(skin.surface_degC() <= high + slack);
    }
  }
}

TEST_CASE("Foil cools less than a sheet and a sheet less than a block of the same metal") {
  const auto after_ten_seconds = [](double thickness_m) {
    BioheatModel skin(living("finger"));
    skin.set_object(kCopper.object(23, thickness_m));
    skin.step(10, contact_conductance_W_m2K(401), 1);
    return skin.surface_degC();
  };
  CHECK(after_ten_seconds(2e-5) > 32.5);
  CHECK(after_ten_seconds(1e-3) < after_ten_seconds(2e-5) - 1);
  CHECK(after_ten_seconds(0.1) < after_ten_seconds(1e-3) - 1);
  CHECK(after_ten_seconds(10) == Approx(after_ten_seconds(0.1)).margin(0.1));
}

TEST_CASE("Materials are ordered by effusivity, as with half-spaces") {
  double before = 0;
  for (const Material& m : {kCopper, kSteel, kGlass, kOak, kFoam}) {
    BioheatModel skin(living("finger"));
    skin.set_object(m.object(23));
    skin.step(2, contact_conductance_W_m2K(m.conductivity), 1);
    CHECK(skin.surface_degC() > before);
    before = skin.surface_degC();
  }
}

TEST_CASE("An object without properties takes no heat, and one without thickness is infinite") {
  BioheatModel skin(living("finger"));
  for (const ObjectProperties& none :
       {ObjectProperties{1000, 0}, ObjectProperties{1000, 1, NAN, 1e6}, ObjectProperties{1000, 1, 1, INFINITY},
        ObjectProperties{1000, 1, -1, -1}}) {
    skin.set_object(none);
    skin.step(1, 1000, 1);
    // The covered pad no longer loses heat to the room: it warms slightly, towards the blood.
    CHECK(skin.surface_degC() >= 33);
    CHECK(skin.surface_degC() < skin.blood_degC());
    skin.reset();
  }
  BioheatModel thin(living("finger")), deep(living("finger"));
  thin.set_object(kGlass.object(23, 0));
  deep.set_object(kGlass.object(23, 1e9));
  thin.step(5, 1000, 1), deep.step(5, 1000, 1);
  CHECK(thin.surface_degC() == deep.surface_degC());
}
